#pragma once
// Reads numbers on a grid from the usual files: .npy, text, MATLAB (version 5, and 7.3 as HDF5), HDF5, PNG, TIFF. Every
// reader compares the size that a header claims with the size of the file before it allocates, and accepts at most 20
// million numbers. All throw InputError.

#include <filesystem>
#include <optional>
#include <string>

#include "files/npy.h"

namespace palpa::stiffnessmaps {

enum class ArrayKind { npy, text, matlab, hdf5, png, tiff };

// Determines the kind from the first bytes; text is an array if its first line holds nothing but numbers. Empty: none
// of these.
std::optional<ArrayKind> array_kind(const std::filesystem::path& path);
inline bool is_array_file(const std::filesystem::path& path) { return array_kind(path).has_value(); }
inline bool is_image(ArrayKind kind) { return kind == ArrayKind::png || kind == ArrayKind::tiff; }

inline constexpr std::size_t kMostNumbers = 20'000'000;  // in an array, and in a map made of several

// Returns an array of two or three dimensions. MATLAB and HDF5 files may hold several arrays: `dataset` names one, and
// may be empty if there is only one. The order of the indices is the file's own (also MATLAB's: A(i, j, k) is
// [i][j][k]).
files::NpyArray read_array(const std::filesystem::path& path, const std::string& dataset);

// Reads rows of numbers; n/a and empty fields become NaN.
files::NpyArray parse_number_matrix(std::string_view text, const std::string& file);

// The libraries behind these readers are not safe against every file (HDF5 1.10 reads and writes beyond its memory on
// some): read_array runs them in a process of their own, and nothing else should call them on files from strangers.
files::NpyArray read_matlab(const std::filesystem::path& path, const std::string& dataset);
files::NpyArray read_hdf5(const std::filesystem::path& path, const std::string& dataset);
files::NpyArray read_png(const std::filesystem::path& path);  // grey, 8 or 16 bits
// Grey, 8, 16 or 32 bits or float; pages become the first dimension.
files::NpyArray read_tiff(const std::filesystem::path& path);

// Refuses a shape that is no grid, is too large, or cannot come out of `stored_bytes` with `value_bytes` per number
// (`packed`: compressed at most 1032 times, the most that deflate achieves). Returns the number of values.
std::size_t check_shape(const std::vector<std::size_t>& shape, std::size_t value_bytes, std::size_t stored_bytes,
                        bool packed, const std::string& file);

}  // namespace palpa::stiffnessmaps
