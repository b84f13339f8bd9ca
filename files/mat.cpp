#include "files/mat.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <matio.h>
#include <memory>
#include <stdexcept>
#include <unistd.h>

#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::files {
namespace {

// Calls visit(c, in_file) for each value: its index in C order, and that in the file, where the first index runs
// fastest.
template <class Visit>
void visit_order(const std::vector<std::size_t>& shape, Visit&& visit) {
    std::size_t total = 1;
    for (const std::size_t n : shape) total *= n;
    for (std::size_t c = 0; c < total; ++c) {
        std::size_t rest = c;
        std::size_t in_file = 0;
        std::size_t stride = total;
        for (std::size_t k = shape.size(); k-- > 0;) {
            stride /= shape[k];
            in_file += rest % shape[k] * stride;
            rest /= shape[k];
        }
        visit(c, in_file);
    }
}

struct CloseFile {
    void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, CloseFile>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

// True if the file gives back every value. The library does not say so if the disk is full.
bool holds(const std::vector<MatArray>& arrays, const std::filesystem::path& path) {
    try {
        return std::all_of(arrays.begin(), arrays.end(), [&](const MatArray& array) {
            const std::vector<float> read = read_mat(array.name, path).values;
            return read.size() == array.values.size() &&
                   std::memcmp(read.data(), array.values.data(), read.size() * sizeof(float)) == 0;
        });
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace

void write_mat(const std::vector<MatArray>& arrays, const std::filesystem::path& name) {
    const std::filesystem::path path = output_target(name);
    const std::string aside = path.string() + ".part-" + std::to_string(::getpid());
    const auto fail_with = [&](const std::string& reason) {
        ::unlink(aside.c_str());
        throw std::runtime_error(path.string() + ": cannot be written: " + reason);
    };
    const auto fail = [&] { fail_with(std::strerror(errno)); };
    MatFile file(Mat_CreateVer(aside.c_str(), nullptr, MAT_FT_MAT5));
    if (!file) fail();
    for (const MatArray& array : arrays) {
        std::vector<float> values(array.values.size());
        visit_order(array.shape, [&](std::size_t c, std::size_t in_file) { values[in_file] = array.values[c]; });
        std::vector<std::size_t> shape = array.shape;
        const Variable variable(Mat_VarCreate(array.name.c_str(), MAT_C_SINGLE, MAT_T_SINGLE,
                                              static_cast<int>(shape.size()), shape.data(), values.data(), 0));
        if (!variable || Mat_VarWrite(file.get(), variable.get(), MAT_COMPRESSION_NONE) != 0) fail();
    }
    file.reset();
    if (!holds(arrays, aside)) fail_with("what is on the disk is not whole (is it full?)");
    sync_file(aside);
    if (::rename(aside.c_str(), path.c_str()) != 0) fail();
}

MatArray read_mat(const std::string& name, const std::filesystem::path& path) {
    check_input(path);
    const MatFile file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
    if (!file) throw bad_input(path.string(), "", "no MATLAB file", "one of version 5");
    const Variable variable(Mat_VarRead(file.get(), name.c_str()));
    if (!variable || variable->data_type != MAT_T_SINGLE || variable->data == nullptr) {
        throw bad_input(path.string(), name, "no array of single numbers", "one");
    }
    MatArray out{name, {variable->dims, variable->dims + variable->rank}, {}};
    std::size_t total = 1;
    for (const std::size_t n : out.shape) total *= n;
    out.values.resize(total);
    const auto* values = static_cast<const float*>(variable->data);
    visit_order(out.shape, [&](std::size_t c, std::size_t in_file) { out.values[c] = values[in_file]; });
    return out;
}

}  // namespace palpa::files
