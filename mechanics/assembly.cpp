#include "mechanics/assembly.h"

#include <cstddef>

namespace palpa::mechanics {

namespace {

using Eigen::Index;

}  // namespace

Neighbours neighbours_of(const Mesh& mesh) {
    const auto n_nodes = static_cast<std::size_t>(mesh.nodes_m.cols());
    std::vector<int> cell_start(n_nodes + 1, 0);
    for (Index i = 0; i < mesh.cells.size(); ++i) ++cell_start[static_cast<std::size_t>(mesh.cells.data()[i]) + 1];
    for (std::size_t i = 0; i < n_nodes; ++i) cell_start[i + 1] += cell_start[i];
    std::vector<int> cell_of(static_cast<std::size_t>(mesh.cells.size()));
    std::vector<int> fill(cell_start.begin(), cell_start.end() - 1);
    for (int cell = 0; cell < mesh.cells.cols(); ++cell) {
        for (Index k = 0; k < mesh.cells.rows(); ++k) {
            cell_of[static_cast<std::size_t>(fill[static_cast<std::size_t>(mesh.cells(k, cell))]++)] = cell;
        }
    }
    Neighbours out;
    out.start.assign(1, 0);
    std::vector<int> near;
    for (std::size_t node = 0; node < n_nodes; ++node) {
        near.assign(1, static_cast<int>(node));  // a node of no cell has a diagonal too, which stays 0
        for (int i = cell_start[node]; i < cell_start[node + 1]; ++i) {
            const int cell = cell_of[static_cast<std::size_t>(i)];
            for (Index k = 0; k < mesh.cells.rows(); ++k) {
                if (mesh.cells(k, cell) > static_cast<int>(node)) near.push_back(mesh.cells(k, cell));
            }
        }
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        out.node.insert(out.node.end(), near.begin(), near.end());
        out.start.push_back(static_cast<int>(out.node.size()));
    }
    return out;
}

LowerMatrix pattern_of(const Neighbours& near) {
    const auto n_nodes = static_cast<Index>(near.start.size()) - 1;
    LowerMatrix K(3 * n_nodes, 3 * n_nodes);
    K.resizeNonZeros(9 * static_cast<Index>(near.node.size()) - 3 * n_nodes);
    int* outer = K.outerIndexPtr();
    int* inner = K.innerIndexPtr();
    int at = 0;
    for (int j = 0; j < n_nodes; ++j) {
        for (int c = 0; c < 3; ++c) {
            outer[3 * j + c] = at;
            for (int r = c; r < 3; ++r) inner[at++] = 3 * j + r;
            for (int i = near.start[static_cast<std::size_t>(j)] + 1; i < near.start[static_cast<std::size_t>(j) + 1];
                 ++i) {
                for (int r = 0; r < 3; ++r) inner[at++] = 3 * near.node[static_cast<std::size_t>(i)] + r;
            }
        }
    }
    outer[3 * n_nodes] = at;
    std::fill_n(K.valuePtr(), at, 0.0);
    return K;
}

}  // namespace palpa::mechanics
