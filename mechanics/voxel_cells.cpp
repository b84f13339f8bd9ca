#include "mechanics/voxel_cells.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "mechanics/element_products.h"
#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Vector24d = Eigen::Matrix<double, 24, 1>;

// Part of a run in one cell, in voxels from the cell's corner.
struct CellRun {
    int x0, x1, y, z, material;
};

// int x^i y^j z^k over a part of the unit cube, i, j, k = 0, 1, 2: entry i + 3 j + 9 k.
using Moments = std::array<double, 27>;

std::array<double, 3> moments_along(double low, double high) {
    return {high - low, 0.5 * (high * high - low * low), (high * high * high - low * low * low) / 3.0};
}

void add_moments(const CellRun& run, int k, Moments& out) {
    const double h = 1.0 / k;
    const auto x = moments_along(run.x0 * h, run.x1 * h);
    const auto y = moments_along(run.y * h, (run.y + 1) * h);
    const auto z = moments_along(run.z * h, (run.z + 1) * h);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t a = 0; a < 3; ++a) out[a + 3 * b + 9 * c] += x[a] * y[b] * z[c];
}

// p[0] + p[1] x
using Linear = std::array<double, 2>;

// Corner a of the unit cube in VTK order, along an axis: 0 or 1.
int corner_side(int a, int axis) {
    if (axis == 2) return a / 4;
    const int b = a % 4;
    return axis == 0 ? (b == 1 || b == 2 ? 1 : 0) : b / 2;
}

// Factor along `axis` of dN_a/dx_i.
Linear factor(int a, int i, int axis) {
    const bool high = corner_side(a, axis) == 1;
    if (axis == i) return {high ? 1.0 : -1.0, 0.0};
    return high ? Linear{0.0, 1.0} : Linear{1.0, -1.0};
}

// The coefficients with which moments enter int g and int g g^T over a part of the unit cube.
struct Coefficients {
    std::array<Vector24d, 27> mean;
    std::array<HexMatrix, 27> products;
};

void set_coefficients(int p, int q, Coefficients& out) {
    std::array<std::array<double, 3>, 3> product{};
    std::array<Linear, 3> single{};
    for (int axis = 0; axis < 3; ++axis) {
        const Linear f = factor(p / 3, p % 3, axis), g = factor(q / 3, q % 3, axis);
        product[at(axis)] = {f[0] * g[0], f[0] * g[1] + f[1] * g[0], f[1] * g[1]};
        single[at(axis)] = f;
    }
    for (std::size_t m = 0; m < 27; ++m) {
        const std::size_t i = m % 3, j = m / 3 % 3, k = m / 9;
        out.products[m](p, q) = product[0][i] * product[1][j] * product[2][k];
        if (q == 0) out.mean[m](p) = i < 2 && j < 2 && k < 2 ? single[0][i] * single[1][j] * single[2][k] : 0.0;
    }
}

const Coefficients& coefficients() {
    static const Coefficients made = [] {
        Coefficients out;
        for (int p = 0; p < 24; ++p)
            for (int q = 0; q < 24; ++q) set_coefficients(p, q, out);
        return out;
    }();
    return made;
}

// Adds what one material gives to the shear part, and to the sums of the mean dilatation.
struct CellSums {
    HexMatrix K = HexMatrix::Zero();
    Vector24d gradient = Vector24d::Zero();  // int g over all that is filled
    double volume = 0.0;                     // of the unit cube
    double kappa_volume = 0.0;
};
void add_material(const Moments& moments, const Material& material, CellSums& sums) {
    HexMatrix products = HexMatrix::Zero(), K;
    for (std::size_t m = 0; m < 27; ++m) {
        products += moments[m] * coefficients().products[m];
        sums.gradient += moments[m] * coefficients().mean[m];
    }
    const double mu = mu_Pa(material);
    stiffness_from_products(products, mu, -2.0 * mu / 3.0, K);
    sums.K += K;
    sums.volume += moments[0];
    sums.kappa_volume += kappa_Pa(material) * moments[0];
}

Vector24d mean_dilatation(const CellSums& sums) { return sums.gradient / sums.volume; }

// Of the unit cube.
HexMatrix stiffness_of(const CellSums& sums) {
    const Vector24d mean = mean_dilatation(sums);
    return sums.K + (sums.kappa_volume * mean) * mean.transpose();
}

HexMatrix full_cell(const Material& material, double cell_m) {
    Moments moments{};
    add_moments({0, 1, 0, 0, 0}, 1, moments);
    CellSums sums;
    add_material(moments, material, sums);
    return cell_m * stiffness_of(sums);
}

// What one material fills of one layer of voxels across an axis of a cell.
struct LayerPart {
    double volume = 0.0;                     // of the unit cube
    Vector24d gradient = Vector24d::Zero();  // int g
};
using Layers = std::vector<std::vector<LayerPart>>;  // [layer][material]

Layers layers_of(const std::vector<CellRun>& runs, int k, int axis, std::size_t n_materials) {
    std::vector<std::vector<Moments>> moments(at(k), std::vector<Moments>(n_materials, Moments{}));
    for (const CellRun& run : runs) {
        if (axis != 0) {
            add_moments(run, k, moments[at(axis == 1 ? run.y : run.z)][at(run.material)]);
            continue;
        }
        for (int x = run.x0; x < run.x1; ++x)
            add_moments({x, x + 1, run.y, run.z, run.material}, k, moments[at(x)][at(run.material)]);
    }
    Layers out(at(k), std::vector<LayerPart>(n_materials));
    for (std::size_t layer = 0; layer < out.size(); ++layer) {
        for (std::size_t m = 0; m < n_materials; ++m) {
            out[layer][m].volume = moments[layer][m][0];
            for (std::size_t i = 0; i < 27; ++i)
                out[layer][m].gradient += moments[layer][m][i] * coefficients().mean[i];
        }
    }
    return out;
}

// How much more than the cell's mean each layer across an axis gives way in shear, relative to that mean; empty if a layer
// holds nothing.
std::vector<double> surplus_of(const std::vector<CellRun>& runs, int k, int axis, std::span<const Material> materials) {
    std::vector<double> voxels(at(k), 0.0), sum_Pa(at(k), 0.0), out;
    for (const CellRun& run : runs) {
        const double mu = mu_Pa(materials[at(run.material)]);
        const int n = axis == 0 ? 1 : run.x1 - run.x0;
        for (int x = run.x0; x < (axis == 0 ? run.x1 : run.x0 + 1); ++x) {
            const std::size_t layer = at(axis == 0 ? x : axis == 1 ? run.y : run.z);
            voxels[layer] += n;
            sum_Pa[layer] += n * mu;
        }
    }
    double mean = 0.0;
    for (std::size_t layer = 0; layer < voxels.size(); ++layer) {
        if (voxels[layer] == 0.0) return {};
        out.push_back(voxels[layer] / sum_Pa[layer]);
        mean += out.back() / k;
    }
    for (double& one : out) one = one / mean - 1.0;
    return out;
}

// Lets the layers of a cell stretch and shear each by its own material: three displacements e_j psi(x_a), where psi is 0 on
// both faces across the axis a and its slope the layers' surplus, are added to the cell's trilinear ones and condensed out of
// its stiffness (of the unit cube, which this softens). Without them a force has to stretch soft and hard layers alike, one
// behind the other (Voigt instead of Reuss): bands across a brush that the cells did not fit were 3.5 % too stiff.
// Source: incompatible modes after Wilson et al. (Numerical and Computer Methods in Structural Mechanics, 1973); the shape of
//         psi is ours.
void let_layers_slide(const Layers& layers, const std::vector<double>& surplus, int axis, const Vector24d& mean,
                      std::span<const Material> materials, HexMatrix& K) {
    for (int j = 0; j < 3; ++j) {
        Vector24d force = Vector24d::Zero();  // of the nodes' displacements on the mode
        double own = 0.0;
        for (std::size_t layer = 0; layer < layers.size(); ++layer) {
            for (std::size_t m = 0; m < layers[layer].size(); ++m) {
                const LayerPart& part = layers[layer][m];
                if (!(part.volume > 0.0)) continue;
                const double mu = mu_Pa(materials[m]), kappa = kappa_Pa(materials[m]), slope = surplus[layer];
                own += part.volume * slope * slope * (j == axis ? kappa + 4.0 / 3.0 * mu : mu);
                if (j == axis) force += (kappa * part.volume * slope) * mean;
                for (int p = 0; p < 24; p += 3) {
                    // slope mu (u_j,a + u_a,j), without the dilatation's part
                    force(p + j) += slope * mu * part.gradient(p + axis);
                    force(p + axis) += slope * mu * part.gradient(p + j);
                    for (int i = 0; j == axis && i < 3; ++i)
                        force(p + i) -= 2.0 / 3.0 * slope * mu * part.gradient(p + i);
                }
            }
        }
        if (own > 0.0) K -= (force / own) * force.transpose();
    }
}

// Along the axis across which the cell's layers differ most, if they do.
void let_layers_slide(const std::vector<CellRun>& runs, int k, const Vector24d& mean,
                      std::span<const Material> materials, HexMatrix& K) {
    constexpr double kLeast = 1e-3;
    int across = -1;
    double most = kLeast;
    std::vector<double> chosen;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> surplus = surplus_of(runs, k, axis, materials);
        double sum = 0.0;
        for (const double one : surplus) sum += one * one;
        if (!(std::sqrt(sum / k) > most)) continue;
        most = std::sqrt(sum / k);
        across = axis;
        chosen = std::move(surplus);
    }
    if (across >= 0) let_layers_slide(layers_of(runs, k, across, materials.size()), chosen, across, mean, materials, K);
}

struct Pattern {
    HexMatrix stiffness_N_per_m;
    double share = 0.0;
};
Pattern pattern_of(const std::vector<CellRun>& runs, int k, double cell_m, std::span<const Material> materials) {
    std::vector<Moments> moments(materials.size(), Moments{});
    std::int64_t filled = 0;
    for (const CellRun& run : runs) {
        add_moments(run, k, moments[at(run.material)]);
        filled += run.x1 - run.x0;
    }
    CellSums sums;
    std::size_t commonest = 0;
    for (std::size_t m = 0; m < materials.size(); ++m) {
        if (moments[m][0] > 0.0) add_material(moments[m], materials[m], sums);
        if (moments[m][0] > moments[commonest][0]) commonest = m;
    }
    const std::int64_t all = std::int64_t{k} * k * k;
    HexMatrix K = stiffness_of(sums);
    const auto of_some = [](const Moments& m) { return m[0] > 0.0; };
    if (std::count_if(moments.begin(), moments.end(), of_some) > 1)
        let_layers_slide(runs, k, mean_dilatation(sums), materials, K);
    Pattern out{cell_m * K, static_cast<double>(filled) / static_cast<double>(all)};
    if (filled < all) out.stiffness_N_per_m += kSoftFill * full_cell(materials[commonest], cell_m);
    return out;
}

// Cuts the runs of the lines of one row of cells to the cells; runs[x]: those in cell x.
void cut_row(const Voxels& voxels, const VoxelCells& cells, int cy, int cz, int n_materials,
             std::vector<std::vector<CellRun>>& runs) {
    const int k = cells.voxels_per_cell;
    for (std::vector<CellRun>& in_cell : runs) in_cell.clear();
    for (int z = cz * k; z < std::min((cz + 1) * k, voxels.size[2]); ++z) {
        for (int y = cy * k; y < std::min((cy + 1) * k, voxels.size[1]); ++y) {
            for (const Run& run : voxels.lines[line_of(voxels, y, z)]) {
                if (run.material >= n_materials)
                    throw MaterialError(text("line y ", y, ", z ", z, " has material ", run.material,
                                             ", but there are ", n_materials, " materials"),
                                        {run.material});
                for (int cell = run.x0 / k; cell * k < run.x1; ++cell) {
                    runs[at(cell)].push_back({std::max(run.x0 - cell * k, 0), std::min(run.x1 - cell * k, k),
                                              y - cy * k, z - cz * k, run.material});
                }
            }
        }
    }
}

std::string key_of(const std::vector<CellRun>& runs) {
    static_assert(sizeof(CellRun) == 5 * sizeof(int));
    return {reinterpret_cast<const char*>(runs.data()), runs.size() * sizeof(CellRun)};
}

}  // namespace

VoxelCells cells_of(const Voxels& voxels, int voxels_per_cell, std::span<const Material> materials) {
    check_materials(materials);
    if (voxels_per_cell < 1) throw MeshError(text(voxels_per_cell, " voxels per cell, must be at least 1"), {});
    VoxelCells out;
    out.voxels_per_cell = voxels_per_cell;
    out.cell_m = voxels_per_cell * voxels.frame.pitch_m;
    out.origin_m = voxels.frame.origin_m;
    for (std::size_t c = 0; c < 3; ++c) out.n[c] = (voxels.size[c] + voxels_per_cell - 1) / voxels_per_cell;
    std::unordered_map<std::string, int> known;
    std::vector<std::vector<CellRun>> runs(at(out.n[0]));
    for (int z = 0; z < out.n[2]; ++z) {
        for (int y = 0; y < out.n[1]; ++y) {
            cut_row(voxels, out, y, z, static_cast<int>(materials.size()), runs);
            for (int x = 0; x < out.n[0]; ++x) {
                if (runs[at(x)].empty()) continue;
                const auto [entry, is_new] =
                    known.emplace(key_of(runs[at(x)]), static_cast<int>(out.stiffness_N_per_m.size()));
                if (is_new) {
                    const Pattern made = pattern_of(runs[at(x)], voxels_per_cell, out.cell_m, materials);
                    out.stiffness_N_per_m.push_back(made.stiffness_N_per_m);
                    out.share.push_back(made.share);
                }
                out.place.push_back({x, y, z});
                out.pattern.push_back(entry->second);
            }
            if (static_cast<std::int64_t>(out.place.size()) > kMostCells)
                throw MeshError(text("more than ", kMostCells, " cells; larger cells are needed"), {});
        }
    }
    if (out.place.empty()) throw MeshError("the part has no voxels", {});
    return out;
}

}  // namespace palpa::mechanics
