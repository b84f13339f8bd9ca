#pragma once
// MATLAB's array file, version 5, by libmatio. MATLAB, Octave and scipy.io.loadmat read it.

#include <filesystem>
#include <string>
#include <vector>

namespace palpa::files {

struct MatArray {
    std::string name;                // a name of MATLAB: letters, digits, underscores
    std::vector<std::size_t> shape;  // at least two axes
    std::vector<float> values;       // C order: the last index runs fastest (the file has the first fastest)
};

// Writes the file whole or not at all. Throws std::runtime_error if it cannot be written.
void write_mat(const std::vector<MatArray>& arrays, const std::filesystem::path& path);

// Reads one array. Throws InputError if the file is not a MATLAB file, or has no array of single-precision numbers of
// that name.
MatArray read_mat(const std::string& name, const std::filesystem::path& path);

}  // namespace palpa::files
