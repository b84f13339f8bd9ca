#pragma once
// NumPy's array file, format versions 1 and 2: little-endian float32, float64 or int32, C order.
// Source: numpy.lib.format documentation, "NPY format".

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpa::files {

struct NpyArray {
    std::vector<std::size_t> shape;
    std::vector<float> values;  // C order: the last index runs fastest
};

// Read an array. Values of float64 files are narrowed to float. Throw InputError for other types and for Fortran order,
// and for a header whose shape does not match the file's size, which is checked before memory is allocated.
NpyArray read_npy(const std::filesystem::path& path);
NpyArray parse_npy(std::string_view bytes, const std::string& file_name);

// Returns the header that precedes the values of a float32 file: '<f4', version 1.0.
std::string npy_header(const std::vector<std::size_t>& shape);
std::string npy_bytes(const NpyArray& array);  // header and values

// Writes the file whole or not at all. `values` are written without a copy. Throws std::runtime_error if it cannot be
// written.
void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
               const std::vector<float>& values);

// The same for whole numbers, '<i4' in the file.
struct NpyIntegers {
    std::vector<std::size_t> shape;
    std::vector<std::int32_t> values;
};
NpyIntegers read_npy_integers(const std::filesystem::path& path);
NpyIntegers parse_npy_integers(std::string_view bytes, const std::string& file_name);
void write_npy_integers(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
                        const std::vector<std::int32_t>& values);

std::string shape_text(const std::vector<std::size_t>& shape);  // "(6, 59, 159)"

}  // namespace palpa::files
