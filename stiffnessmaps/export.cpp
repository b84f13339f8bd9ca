#include "stiffnessmaps/export.h"

#include <charconv>
#include <cmath>
#include <unistd.h>

#include "files/input_error.h"
#include "files/mat.h"
#include "files/npy.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::stiffnessmaps {
namespace {

namespace fs = std::filesystem;

std::vector<float> places_mm(const Map& map, int axis) {
    std::vector<float> out;
    for (std::size_t i = 0; i < (axis == 0 ? map.n_x : map.n_y); ++i) {
        out.push_back(static_cast<float>(1e3 * (axis == 0 ? map.x_of(i) : map.y_of(i))));
    }
    return out;
}

std::vector<float> depths_mm(const Map& map) {
    std::vector<float> out;
    for (const double depth_m : map.depths_m) out.push_back(static_cast<float>(1e3 * depth_m));
    return out;
}

// Returns all arrays of the map with their names.
std::vector<files::MatArray> arrays_of(const Map& map) {
    const std::vector<std::size_t> shape{map.n_depths(), map.n_y, map.n_x};
    std::vector<files::MatArray> out{{"normal_N", shape, map.normal_N}};
    if (!map.tangential_x_N.empty()) out.push_back({"tangential_x_N", shape, map.tangential_x_N});
    if (!map.tangential_y_N.empty()) out.push_back({"tangential_y_N", shape, map.tangential_y_N});
    out.push_back({"x_mm", {1, map.n_x}, places_mm(map, 0)});
    out.push_back({"y_mm", {1, map.n_y}, places_mm(map, 1)});
    out.push_back({"depths_mm", {1, map.n_depths()}, depths_mm(map)});
    return out;
}

// Appends the shortest text that reads back as the same float.
void append_force(const std::vector<float>& forces, std::size_t at, std::string& out) {
    out += ',';
    if (forces.empty() || std::isnan(forces[at])) {
        out += "n/a";
        return;
    }
    char text[32];
    out.append(text, std::to_chars(text, text + sizeof text, forces[at]).ptr);
}

std::string csv_of(const Map& map) {
    std::string out = "x_mm,y_mm,depth_mm,normal_N,tangential_x_N,tangential_y_N\n";
    const auto mm = [](double m) { return files::number_text(std::round(1e9 * m) / 1e6); };  // to the nanometre
    for (std::size_t at = 0; at < map.normal_N.size(); ++at) {
        const std::size_t cell = at % map.n_cells();
        out += mm(map.x_of(cell % map.n_x)) + "," + mm(map.y_of(cell / map.n_x)) + "," +
               mm(map.depths_m[at / map.n_cells()]);
        append_force(map.normal_N, at, out);
        append_force(map.tangential_x_N, at, out);
        append_force(map.tangential_y_N, at, out);
        out += '\n';
    }
    return out;
}

void write_folder(const Map& map, fs::path folder) {
    if (!folder.has_filename()) folder = folder.parent_path();
    files::check_new(folder);
    fs::path aside = folder;
    aside += ".part-" + std::to_string(::getpid());
    try {
        fs::create_directory(aside);
        for (files::MatArray& array : arrays_of(map)) {
            std::vector<std::size_t> shape = array.shape;
            if (shape.size() == 2) shape.erase(shape.begin());  // MATLAB gets a row, NumPy a vector
            files::write_npy(aside / (array.name + ".npy"), shape, array.values);
        }
        fs::rename(aside, folder);
    } catch (const fs::filesystem_error& error) {
        std::error_code ignored;
        fs::remove_all(aside, ignored);
        throw std::runtime_error(folder.string() + ": cannot be written: " + error.code().message());
    } catch (const std::exception&) {
        std::error_code ignored;
        fs::remove_all(aside, ignored);
        throw;
    }
}

void write_array(const Map& map, const std::string& name, const fs::path& file) {
    std::string there;
    for (files::MatArray& array : arrays_of(map)) {
        if (array.shape.size() != 3) continue;
        if (array.name == name) return files::write_npy(file, array.shape, array.values);
        there += (there.empty() ? "" : ", ") + array.name;
    }
    throw files::bad_input(map.name, "", "no array " + files::shown(name), "one of " + there);
}

}  // namespace

void export_map(const Map& map, const std::string& array, const fs::path& file) {
    const std::string kind = file.extension().string();
    if (kind == ".npy") return write_array(map, array, file);
    if (kind == ".csv") return files::write_text_atomically(file, csv_of(map));
    if (kind == ".mat") return files::write_mat(arrays_of(map), file);
    const std::string name = file.filename().string();  // an ending alone is no ending to the library
    const bool only_ending = name == ".npy" || name == ".csv" || name == ".mat";
    if (only_ending) throw files::bad_input(file.string(), "", "an ending alone", "a name before it");
    if (kind.empty() && !file.empty()) return write_folder(map, file);
    throw files::bad_input(file.string(), "", "a name that ends in " + files::shown(kind),
                           ".npy, .csv, .mat, or no ending for a folder of arrays");
}

}  // namespace palpa::stiffnessmaps
