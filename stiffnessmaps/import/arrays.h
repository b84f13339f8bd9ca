#pragma once
// Numbers on a grid from the files that people have: .npy, text, MATLAB (version 5, and 7.3 as HDF5), HDF5,
// PNG, TIFF. Every reader holds what a header promises against the file's size before it allocates, and takes
// at most 20 million numbers. All throw InputError.

#include <filesystem>
#include <optional>
#include <string>

#include "files/npy.h"

namespace palpa::stiffnessmaps {

enum class ArrayKind { npy, text, matlab, hdf5, png, tiff };

// Told from the first bytes; text is an array if its first line holds nothing but numbers. Empty: none of
// these.
std::optional<ArrayKind> array_kind(const std::filesystem::path& path);
inline bool is_array_file(const std::filesystem::path& path) { return array_kind(path).has_value(); }
inline bool is_image(ArrayKind kind) { return kind == ArrayKind::png || kind == ArrayKind::tiff; }

inline constexpr std::size_t kMostNumbers = 20'000'000;  // in an array, and in a map made of several

// Two or three dimensions. MATLAB and HDF5 files may hold several arrays: `dataset` names one, and may be
// empty if there is only one. The index order is the file's own (MATLAB's, too: A(i, j, k) is [i][j][k]).
files::NpyArray read_array(const std::filesystem::path& path, const std::string& dataset);

files::NpyArray parse_number_matrix(std::string_view text,
                                    const std::string& file);  // rows of numbers, NaN for n/a or nothing
// The libraries behind these are not safe against every file (HDF5 1.10 reads and writes beyond its memory on
// some): read_array runs them in a process of their own, and nothing else should call them on strangers' files.
files::NpyArray read_matlab(const std::filesystem::path& path, const std::string& dataset);
files::NpyArray read_hdf5(const std::filesystem::path& path, const std::string& dataset);
files::NpyArray read_png(const std::filesystem::path& path);  // grey, 8 or 16 bits
files::NpyArray read_tiff(
    const std::filesystem::path& path);  // grey, 8, 16 or 32 bits or float; pages become the first dimension

// Refuses a shape that is no grid, is too large, or cannot come out of `stored_bytes` with `value_bytes` a
// number
// (`packed`: compressed, at most 1032 times, which is the most that deflate can). Returns how many numbers
// there are.
std::size_t check_shape(const std::vector<std::size_t>& shape, std::size_t value_bytes, std::size_t stored_bytes,
                        bool packed, const std::string& file);

}  // namespace palpa::stiffnessmaps
