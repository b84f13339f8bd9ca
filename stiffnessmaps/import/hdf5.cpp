// Reads HDF5 files, and MATLAB 7.3 files, which are HDF5.

#include <algorithm>
#include <array>
#include <hdf5.h>

#include "files/input_error.h"
#include "files/regular_file.h"
#include "stiffnessmaps/import/arrays.h"

namespace palpa::stiffnessmaps {
namespace {

// An identifier of the library, closed by the destructor.
class Handle {
  public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    hid_t id() const { return id_; }
    bool there() const { return id_ >= 0; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

struct Found {
    std::vector<std::string> names;
};

herr_t note_dataset(hid_t, const char* name, const H5O_info_t* info, void* out) {
    constexpr std::size_t kMost = 1000;
    auto& names = static_cast<Found*>(out)->names;
    const std::string_view text(name);
    if (info->type == H5O_TYPE_DATASET && text.substr(0, 6) != "#refs#") names.emplace_back(text);
    return names.size() < kMost ? 0 : 1;
}

// Returns the dimensions of a dataset of plain numbers; empty for anything else.
std::vector<std::size_t> grid_shape(hid_t dataset) {
    const Handle type(H5Dget_type(dataset), H5Tclose);
    const Handle space(H5Dget_space(dataset), H5Sclose);
    if (!type.there() || !space.there()) return {};
    const H5T_class_t kind = H5Tget_class(type.id());
    const int rank = H5Sget_simple_extent_ndims(space.id());
    if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || rank < 2 || rank > 3) return {};
    std::array<hsize_t, 3> dims{};
    if (H5Sget_simple_extent_dims(space.id(), dims.data(), nullptr) != rank) return {};
    std::vector<std::size_t> shape(dims.begin(), dims.begin() + rank);
    if (std::count(shape.begin(), shape.end(), std::size_t{1}) + 1 >= rank) return {};
    return shape;
}

std::string choose(hid_t root, const std::string& dataset, const std::string& file) {
    if (!dataset.empty()) return dataset;
    Found found;
    H5Ovisit2(root, H5_INDEX_NAME, H5_ITER_NATIVE, note_dataset, &found, H5O_INFO_BASIC);
    std::vector<std::string> grids;
    std::string shapes;
    for (const std::string& name : found.names) {
        const Handle candidate(H5Dopen2(root, name.c_str(), H5P_DEFAULT), H5Dclose);
        if (!candidate.there()) continue;
        const auto shape = grid_shape(candidate.id());
        if (shape.empty()) continue;
        grids.push_back(name);
        shapes += " " + files::shown(name) + " " + files::shape_text(shape);
    }
    if (grids.empty()) throw files::bad_input(file, "", "no array of numbers with two or three dimensions", "one");
    if (grids.size() > 1) throw files::bad_input(file, "", "the arrays" + shapes, "one of them named by --dataset");
    return grids.front();
}

bool starts_as_matlab(const std::filesystem::path& path) {
    std::array<char, 10> bytes{};
    files::InputFile(path).read_at(0, bytes.data(), bytes.size());
    return std::string_view(bytes.data(), bytes.size()) == "MATLAB 7.3";
}

// Returns the array in MATLAB's order of indices: MATLAB stores the axes reversed.
files::NpyArray with_axes_reversed(const files::NpyArray& from) {
    files::NpyArray out;
    out.shape.assign(from.shape.rbegin(), from.shape.rend());
    out.values.resize(from.values.size());
    const std::size_t n_0 = out.shape[0];
    const std::size_t n_1 = out.shape[1];
    const std::size_t n_2 = out.shape.size() == 3 ? out.shape[2] : 1;
    for (std::size_t i = 0; i < n_0; ++i) {
        for (std::size_t j = 0; j < n_1; ++j) {
            for (std::size_t k = 0; k < n_2; ++k)
                out.values[(i * n_1 + j) * n_2 + k] = from.values[i + n_0 * (j + n_1 * k)];
        }
    }
    return out;
}

}  // namespace

files::NpyArray read_hdf5(const std::filesystem::path& path, const std::string& dataset) {
    const std::string file = path.string();
    files::check_input(path);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Handle root(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!root.there()) throw files::bad_input(file, "", "no HDF5 file that can be opened", "a whole one");
    const std::string name = choose(root.id(), dataset, file);
    const Handle data(H5Dopen2(root.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!data.there()) throw files::bad_input(file, "", "nothing of that name", "an array " + files::shown(name));
    files::NpyArray array;
    array.shape = grid_shape(data.id());
    if (array.shape.empty())
        throw files::bad_input(file, name, "something else", "an array of numbers with two or three dimensions");
    const Handle type(H5Dget_type(data.id()), H5Tclose);
    const Handle how(H5Dget_create_plist(data.id()), H5Pclose);
    if (H5Pget_external_count(how.id()) > 0 || H5Pget_layout(how.id()) == H5D_VIRTUAL) {
        throw files::bad_input(file, name, "numbers that stand in other files", "numbers in this one");
    }
    const auto stored = std::min<std::size_t>(H5Dget_storage_size(data.id()), std::filesystem::file_size(path));
    const std::size_t n = check_shape(array.shape, H5Tget_size(type.id()), stored, H5Pget_nfilters(how.id()) > 0, file);
    array.values.resize(n);
    if (H5Dread(data.id(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()) < 0) {
        throw files::bad_input(file, name, "an array that cannot be read to its end", "a whole file");
    }
    return starts_as_matlab(path) ? with_axes_reversed(array) : array;
}

}  // namespace palpa::stiffnessmaps
