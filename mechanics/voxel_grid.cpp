#include "mechanics/voxel_grid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "mechanics/index.h"

namespace palpa::mechanics {
namespace {

// Corners of a cell in VTK order.
constexpr std::array<std::array<int, 3>, 8> kCellCorner{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

// Pairs of corners along x, y and z, the lower one first.
constexpr std::array<std::array<std::array<int, 2>, 4>, 3> kPairs{
    {{{{0, 1}, {3, 2}, {4, 5}, {7, 6}}}, {{{0, 3}, {1, 2}, {4, 7}, {5, 6}}}, {{{0, 4}, {1, 5}, {2, 6}, {3, 7}}}}};

// Orders cells by their matrix, so that first[p] ... hold those of matrix p. Within one they keep their order.
void order_cells(const std::vector<int>& matrix, std::vector<std::array<int, 3>> place, GridLevel& level) {
    level.first.assign(level.stiffness_N_per_m.size() + 1, 0);
    for (const int p : matrix) ++level.first[at(p) + 1];
    std::partial_sum(level.first.begin(), level.first.end(), level.first.begin());
    std::vector<int> next(level.first.begin(), level.first.end() - 1);
    level.cell_place.resize(place.size());
    for (std::size_t i = 0; i < place.size(); ++i) level.cell_place[at(next[at(matrix[i])]++)] = place[i];
}

void number_nodes(GridLevel& level) {
    std::vector<std::array<int, 3>>& nodes = level.node_place;
    const auto nx = static_cast<std::size_t>(level.n[0]) + 1, ny = static_cast<std::size_t>(level.n[1]) + 1;
    std::vector<bool> used(nx * ny * (static_cast<std::size_t>(level.n[2]) + 1), false);
    for (const auto& cell : level.cell_place) {
        for (const auto& c : kCellCorner)
            used[at(cell[0] + c[0]) + nx * (at(cell[1] + c[1]) + ny * at(cell[2] + c[2]))] = true;
    }
    nodes.clear();
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i])
            nodes.push_back({static_cast<int>(i % nx), static_cast<int>(i / nx % ny), static_cast<int>(i / nx / ny)});
    }
    const NodeNumbers number(level);
    level.corners.resize(level.cell_place.size());
    for (std::size_t i = 0; i < level.corners.size(); ++i) {
        const auto& cell = level.cell_place[i];
        for (std::size_t a = 0; a < 8; ++a) {
            const auto& c = kCellCorner[a];
            level.corners[i][a] = number(cell[0] + c[0], cell[1] + c[1], cell[2] + c[2]);
        }
    }
}

// Calls visit(cell, matrix) for every cell.
template <class Visit>
void for_each_cell(const GridLevel& level, const Visit& visit) {
    for (std::size_t p = 0; p + 1 < level.first.size(); ++p) {
        for (int cell = level.first[p]; cell < level.first[p + 1]; ++cell) visit(at(cell), p);
    }
}

void invert_diagonal(GridLevel& level) {
    level.inverse_m_per_N.assign(level.node_place.size(), Eigen::Matrix3d::Zero());
    for_each_cell(level, [&](std::size_t cell, std::size_t p) {
        for (int a = 0; a < 8; ++a)
            level.inverse_m_per_N[at(level.corners[cell][at(a)])] +=
                level.stiffness_N_per_m[p].block<3, 3>(3 * a, 3 * a);
    });
    for (Eigen::Matrix3d& block : level.inverse_m_per_N) {
        for (int c = 0; c < 3; ++c) {
            if (!(block(c, c) > 0.0)) block(c, c) = 1.0;
        }
        block = block.inverse().eval();
    }
}

// K <- T^T K T for one axis of one child: T interpolates from the corners of the coarse cell to those of the child,
// which is its lower (side 0) or upper half.
void interpolate_along(int axis, int side, HexMatrix& K) {
    for (const auto& [low, high] : kPairs[at(axis)]) {
        const int a = 3 * (side == 0 ? low : high), b = 3 * (side == 0 ? high : low);  // a stands on a coarse corner
        K.middleCols<3>(b) *= 0.5;
        K.middleCols<3>(a) += K.middleCols<3>(b);
    }
    for (const auto& [low, high] : kPairs[at(axis)]) {
        const int a = 3 * (side == 0 ? low : high), b = 3 * (side == 0 ? high : low);
        K.middleRows<3>(b) *= 0.5;
        K.middleRows<3>(a) += K.middleRows<3>(b);
    }
}

// Matrices of the eight children, -1 where there is none.
using Children = std::array<int, 8>;

HexMatrix coarse_stiffness(const GridLevel& level, const Children& children) {
    HexMatrix out = HexMatrix::Zero();
    for (std::size_t i = 0; i < 8; ++i) {
        if (children[i] < 0) continue;
        HexMatrix K = level.stiffness_N_per_m[at(children[i])];
        for (int axis = 0; axis < 3; ++axis) interpolate_along(axis, (static_cast<int>(i) >> axis) & 1, K);
        out += K;
    }
    return out;
}

constexpr int kAtOnce = 8;  // cells of one matrix

// Products of eight cells at once, with one number of all cells side by side.
void multiply_eight(const HexMatrix& K, const std::array<int, 8>* corners, const double* x, double* y) {
    Eigen::Matrix<double, kAtOnce, 24> in;
    for (int cell = 0; cell < kAtOnce; ++cell) {
        for (int a = 0; a < 8; ++a) {
            const double* from = x + 3 * corners[cell][at(a)];
            for (int c = 0; c < 3; ++c) in(cell, 3 * a + c) = from[c];
        }
    }
    for (int row = 0; row < 24; ++row) {
        Eigen::Matrix<double, kAtOnce, 1> sum = in.col(0) * K(0, row);  // K is symmetric
        for (int i = 1; i < 24; ++i) sum += in.col(i) * K(i, row);
        for (int cell = 0; cell < kAtOnce; ++cell) y[3 * corners[cell][at(row / 3)] + row % 3] += sum(cell);
    }
}

void multiply_one(const HexMatrix& K, const std::array<int, 8>& corners, const double* x, double* y) {
    Eigen::Matrix<double, 24, 1> in;
    for (int a = 0; a < 8; ++a)
        for (int c = 0; c < 3; ++c) in(3 * a + c) = x[3 * corners[at(a)] + c];
    const Eigen::Matrix<double, 24, 1> out = K * in;
    for (int a = 0; a < 8; ++a)
        for (int c = 0; c < 3; ++c) y[3 * corners[at(a)] + c] += out(3 * a + c);
}

}  // namespace

std::size_t NodeNumbers::place(int x, int y, int z) const {
    return at(x) + (at(n_[0]) + 1) * (at(y) + (at(n_[1]) + 1) * at(z));
}

NodeNumbers::NodeNumbers(const GridLevel& level)
    : n_(level.n), number_((at(n_[0]) + 1) * (at(n_[1]) + 1) * (at(n_[2]) + 1), -1) {
    for (std::size_t i = 0; i < level.node_place.size(); ++i) {
        const auto& p = level.node_place[i];
        number_[place(p[0], p[1], p[2])] = static_cast<int>(i);
    }
}

GridLevel finest_level(const VoxelCells& cells) {
    GridLevel level;
    level.n = cells.n;
    level.stiffness_N_per_m = cells.stiffness_N_per_m;
    order_cells(cells.pattern, cells.place, level);
    number_nodes(level);
    invert_diagonal(level);
    level.free.setOnes(3, n_nodes(level));
    return level;
}

void fix_nodes(const std::vector<std::uint8_t>& fixed, GridLevel& level) {
    for (int i = 0; i < n_nodes(level); ++i) {
        for (int c = 0; c < 3; ++c) level.free(c, i) = (fixed[at(i)] >> c & 1) != 0 ? 0.0 : 1.0;
    }
    // cells with fixed corners get matrices of their own, shared by those with the same corners fixed
    std::map<std::array<int, 2>, int> known;  // matrix before, fixed dofs -> matrix
    std::vector<int> matrix(level.corners.size());
    std::vector<HexMatrix> made;
    for_each_cell(level, [&](std::size_t cell, std::size_t p) {
        int bits = 0;
        for (std::size_t a = 0; a < 8; ++a) bits |= (fixed[at(level.corners[cell][a])] & 7) << (3 * a);
        const auto [entry, is_new] = known.try_emplace({static_cast<int>(p), bits}, static_cast<int>(made.size()));
        matrix[cell] = entry->second;
        if (!is_new) return;
        made.push_back(level.stiffness_N_per_m[p]);
        for (int dof = 0; dof < 24; ++dof) {
            if ((bits >> dof & 1) == 0) continue;
            made.back().row(dof).setZero();
            made.back().col(dof).setZero();
        }
    });
    level.stiffness_N_per_m = std::move(made);
    order_cells(matrix, std::vector(level.cell_place), level);
    number_nodes(level);
    invert_diagonal(level);
}

GridLevel coarser_level(GridLevel& level) {
    GridLevel out;
    for (std::size_t c = 0; c < 3; ++c) out.n[c] = (level.n[c] + 1) / 2;
    const auto nx = at(out.n[0]), ny = at(out.n[1]);
    std::map<std::size_t, Children> groups;  // by place, x fastest
    for_each_cell(level, [&](std::size_t cell, std::size_t p) {
        const auto& at_cell = level.cell_place[cell];
        const std::size_t place = at(at_cell[0] / 2) + nx * (at(at_cell[1] / 2) + ny * at(at_cell[2] / 2));
        Children& children = groups.try_emplace(place, Children{-1, -1, -1, -1, -1, -1, -1, -1}).first->second;
        children[at(at_cell[0] % 2 + 2 * (at_cell[1] % 2) + 4 * (at_cell[2] % 2))] = static_cast<int>(p);
    });
    std::map<Children, int> known;
    std::vector<int> matrix;
    std::vector<std::array<int, 3>> place;
    for (const auto& [index, children] : groups) {
        const auto [entry, is_new] = known.try_emplace(children, static_cast<int>(out.stiffness_N_per_m.size()));
        if (is_new) out.stiffness_N_per_m.push_back(coarse_stiffness(level, children));
        matrix.push_back(entry->second);
        place.push_back(
            {static_cast<int>(index % nx), static_cast<int>(index / nx % ny), static_cast<int>(index / nx / ny)});
    }
    order_cells(matrix, std::move(place), out);
    number_nodes(out);
    invert_diagonal(out);
    const NodeNumbers number(out);
    level.coarse.resize(level.node_place.size());
    for (std::size_t i = 0; i < level.coarse.size(); ++i) {
        const auto& p = level.node_place[i];
        for (int b = 0; b < 8; ++b)
            level.coarse[i][at(b)] = number((p[0] + (b & 1)) / 2, (p[1] + (b >> 1 & 1)) / 2, (p[2] + (b >> 2)) / 2);
    }
    return out;
}

void multiply(const GridLevel& level, const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& y) {
    y.setZero(3, x.cols());
    for (std::size_t p = 0; p + 1 < level.first.size(); ++p) {
        const HexMatrix& K = level.stiffness_N_per_m[p];
        int cell = level.first[p];
        const int end = level.first[p + 1];
        for (; cell + kAtOnce <= end; cell += kAtOnce) multiply_eight(K, &level.corners[at(cell)], x.data(), y.data());
        for (; cell < end; ++cell) multiply_one(K, level.corners[at(cell)], x.data(), y.data());
    }
}

LowerMatrix assembled(const GridLevel& level, double relative_shift) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(level.corners.size() * 300);
    for_each_cell(level, [&](std::size_t cell, std::size_t p) {
        const HexMatrix& K = level.stiffness_N_per_m[p];
        for (int j = 0; j < 24; ++j) {
            const int column = 3 * level.corners[cell][at(j / 3)] + j % 3;
            for (int i = 0; i < 24; ++i) {
                const int row = 3 * level.corners[cell][at(i / 3)] + i % 3;
                if (row >= column) entries.emplace_back(row, column, K(i, j));
            }
        }
    });
    LowerMatrix out(3 * n_nodes(level), 3 * n_nodes(level));
    out.setFromTriplets(entries.begin(), entries.end());
    for (int dof = 0; dof < out.cols(); ++dof) {
        double& diagonal = out.coeffRef(dof, dof);
        diagonal = diagonal > 0.0 ? diagonal * (1.0 + relative_shift) : 1.0;
    }
    return out;
}

}  // namespace palpa::mechanics
