// Reads MATLAB version 5 files by matio.

#include <algorithm>
#include <cstdint>
#include <matio.h>
#include <memory>

#include "files/input_error.h"
#include "files/regular_file.h"
#include "stiffnessmaps/import/arrays.h"

namespace palpa::stiffnessmaps {
namespace {

std::size_t bytes_of(matio_classes type) {
    switch (type) {
        case MAT_C_DOUBLE:
        case MAT_C_INT64:
        case MAT_C_UINT64:
            return 8;
        case MAT_C_SINGLE:
        case MAT_C_INT32:
        case MAT_C_UINT32:
            return 4;
        case MAT_C_INT16:
        case MAT_C_UINT16:
            return 2;
        case MAT_C_INT8:
        case MAT_C_UINT8:
            return 1;
        default:
            return 0;  // no plain numbers
    }
}

template <class Value>
float value_at(const void* data, std::size_t i) {
    return static_cast<float>(static_cast<const Value*>(data)[i]);
}

float number_at(const matvar_t& variable, std::size_t i) {
    switch (variable.class_type) {
        case MAT_C_DOUBLE:
            return value_at<double>(variable.data, i);
        case MAT_C_SINGLE:
            return value_at<float>(variable.data, i);
        case MAT_C_INT64:
            return value_at<std::int64_t>(variable.data, i);
        case MAT_C_UINT64:
            return value_at<std::uint64_t>(variable.data, i);
        case MAT_C_INT32:
            return value_at<std::int32_t>(variable.data, i);
        case MAT_C_UINT32:
            return value_at<std::uint32_t>(variable.data, i);
        case MAT_C_INT16:
            return value_at<std::int16_t>(variable.data, i);
        case MAT_C_UINT16:
            return value_at<std::uint16_t>(variable.data, i);
        case MAT_C_INT8:
            return value_at<std::int8_t>(variable.data, i);
        default:
            return value_at<std::uint8_t>(variable.data, i);
    }
}

std::vector<std::size_t> shape_of(const matvar_t& variable) {
    return {variable.dims, variable.dims + std::max(variable.rank, 0)};
}

bool is_grid(const matvar_t& variable) {
    if (bytes_of(variable.class_type) == 0 || variable.isComplex != 0 || variable.dims == nullptr) return false;
    if (variable.rank < 2 || variable.rank > 3) return false;
    const auto shape = shape_of(variable);
    return std::count(shape.begin(), shape.end(), 1u) + 1 < variable.rank;  // at least two axes are longer than one
}

struct CloseMat {
    void operator()(mat_t* mat) const { Mat_Close(mat); }
};
struct FreeVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Mat = std::unique_ptr<mat_t, CloseMat>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

// Returns the name of the array to read.
std::string choose(mat_t* mat, const std::string& dataset, const std::string& file) {
    std::string grids;
    std::size_t n = 0;
    std::string found;
    constexpr std::size_t kMost = 1000;
    while (Variable variable{Mat_VarReadNextInfo(mat)}) {
        if (++n > kMost) break;
        const std::string name = variable->name != nullptr ? variable->name : "";
        if (name == dataset) return name;
        if (!is_grid(*variable)) continue;
        grids += " " + files::shown(name) + " " + files::shape_text(shape_of(*variable));
        if (!found.empty() && dataset.empty()) found = "*";
        if (found.empty()) found = name;
    }
    if (!dataset.empty())
        throw files::bad_input(file, "", grids.empty() ? "no arrays" : "the arrays" + grids,
                               "an array " + files::shown(dataset));
    if (found.empty()) throw files::bad_input(file, "", "no array of real numbers with two or three dimensions", "one");
    if (found == "*") throw files::bad_input(file, "", "the arrays" + grids, "one of them named by --dataset");
    return found;
}

// Throws InputError for a cut file, which matio reads without an error. Each element of the file holds its length, and
// the last one must end where the file does. Source: MATLAB MAT-File Format, level 5: 128 bytes of header with the byte
// order at its end, then elements of type (4 bytes), length (4 bytes), data.
void refuse_cut(const std::filesystem::path& path) {
    constexpr std::uint64_t kHeader = 128;
    const files::InputFile in(path);
    const std::uint64_t size = in.bytes();
    const auto bytes_at = [&](std::uint64_t at, std::size_t n) {
        std::string bytes(n, '\0');
        in.read_at(at, bytes.data(), n);
        return bytes;
    };
    const auto cut = [&] {
        return files::bad_input(path.string(), "", "an end within an array: a cut file", "a whole file");
    };
    if (size < kHeader) throw cut();
    const bool little_endian = bytes_at(kHeader - 2, 2) == "IM";
    for (std::uint64_t at = kHeader; size - at >= 8;) {
        const std::string tag = bytes_at(at, 8);
        std::uint64_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            length |= std::uint64_t{static_cast<unsigned char>(tag[4 + i])} << (little_endian ? 8 * i : 24 - 8 * i);
        }
        if (length > size - at - 8) throw cut();
        at += 8 + length;
    }
}

void keep_quiet(int, char*) {}

}  // namespace

files::NpyArray read_matlab(const std::filesystem::path& path, const std::string& dataset) {
    const std::string file = path.string();
    refuse_cut(path);
    Mat_LogInitFunc("palpa", keep_quiet);
    Mat mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
    if (!mat) throw files::bad_input(file, "", "no MATLAB file that can be opened", "MATLAB version 5");
    const std::string name = choose(mat.get(), dataset, file);
    Mat_Rewind(mat.get());
    Variable variable(Mat_VarReadInfo(mat.get(), name.c_str()));
    if (!variable || !is_grid(*variable))
        throw files::bad_input(file, name, "something else", "an array of real numbers with two or three dimensions");
    files::NpyArray array;
    array.shape = shape_of(*variable);
    const bool packed = variable->compression != MAT_COMPRESSION_NONE;
    // a file may store doubles as bytes where their values allow it
    const std::size_t n = check_shape(array.shape, 1, std::filesystem::file_size(path), packed, file);
    if (Mat_VarReadDataAll(mat.get(), variable.get()) != 0 || variable->data == nullptr ||
        variable->nbytes < n * bytes_of(variable->class_type)) {
        throw files::bad_input(file, name, "an array that cannot be read to its end", "a whole file");
    }
    array.values.resize(n);
    const std::size_t n_0 = array.shape[0];
    const std::size_t n_1 = array.shape[1];
    const std::size_t n_2 = array.shape.size() == 3 ? array.shape[2] : 1;
    for (std::size_t i = 0; i < n_0; ++i) {  // MATLAB's first index runs fastest
        for (std::size_t j = 0; j < n_1; ++j) {
            for (std::size_t k = 0; k < n_2; ++k)
                array.values[(i * n_1 + j) * n_2 + k] = number_at(*variable, i + n_0 * (j + n_1 * k));
        }
    }
    return array;
}

}  // namespace palpa::stiffnessmaps
