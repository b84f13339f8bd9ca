#include "parts/runs_file.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "files/input_error.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

using RunRow = std::array<int, 5>;  // z, y, x0, x1, material

std::string text_of(const RunRow& row) {
    std::string out;
    for (const int value : row) out += (out.empty() ? "" : " ") + std::to_string(value);
    return out;
}

void check_row(const RunRow& row, std::size_t number, const std::string& file, const Voxels& voxels, int n_materials) {
    const auto& [z, y, x0, x1, material] = row;
    const std::string where = "row " + std::to_string(number);
    if (z < 0 || z >= voxels.size[2] || y < 0 || y >= voxels.size[1] || x0 < 0 || x1 <= x0 || x1 > voxels.size[0]) {
        throw files::bad_input(file, where, text_of(row),
                               "z y x0 x1 with x0 < x1, within " + std::to_string(voxels.size[2]) + " x " +
                                   std::to_string(voxels.size[1]) + " x " + std::to_string(voxels.size[0]) +
                                   " voxels (z y x)");
    }
    if (material < 0 || material >= n_materials) {
        throw files::bad_input(file, where, "material " + std::to_string(material),
                               "a material's place in the part file, 0 to " + std::to_string(n_materials - 1));
    }
}

}  // namespace

std::vector<PlacedRun> runs_of(const files::NpyIntegers& rows, const std::string& file, const Voxels& voxels,
                               int n_materials) {
    if (rows.shape.size() != 2 || rows.shape[1] != 5 || rows.shape[0] == 0) {
        throw files::bad_input(file, "shape", files::shape_text(rows.shape),
                               "(n, 5): a row z y x0 x1 material for each run");
    }
    std::vector<RunRow> all(rows.shape[0]);
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::copy_n(rows.values.begin() + static_cast<std::ptrdiff_t>(5 * i), 5, all[i].begin());
        check_row(all[i], i, file, voxels, n_materials);
    }
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return all[a] < all[b]; });
    std::vector<PlacedRun> out;
    out.reserve(all.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const RunRow& row = all[order[i]];
        if (i > 0) {
            const RunRow& before = all[order[i - 1]];
            if (before[0] == row[0] && before[1] == row[1] && before[3] > row[2]) {
                throw files::bad_input(
                    file, "row " + std::to_string(order[i]), text_of(row),
                    "runs that do not overlap (row " + std::to_string(order[i - 1]) + " is " + text_of(before) + ")");
            }
        }
        out.push_back({row[0], row[1], {row[2], row[3], row[4]}});
    }
    return out;
}

std::vector<PlacedRun> read_runs(const std::filesystem::path& path, const Voxels& voxels, int n_materials) {
    return runs_of(files::read_npy_integers(path), path.string(), voxels, n_materials);
}

void write_runs(const Voxels& voxels, const std::filesystem::path& path) {
    const std::vector<PlacedRun> runs = placed_runs(voxels);
    std::vector<std::int32_t> values;
    values.reserve(5 * runs.size());
    for (const PlacedRun& placed : runs)
        values.insert(values.end(), {placed.z, placed.y, placed.run.x0, placed.run.x1, placed.run.material});
    files::write_npy_integers(path, {runs.size(), 5}, values);
}

}  // namespace palpa::parts
