#include "mechanics/stiffness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

// For each node i the nodes >= i that share a cell with it, ascending: node[start[i]] to node[start[i + 1] - 1].
struct Neighbours {
    std::vector<int> start;
    std::vector<int> node;
};

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

// Returns the matrix with all values 0. Column 3 j + c holds rows c..2 of the diagonal block, and then three rows for
// each later neighbour.
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

// Adds the stiffness Ke of a cell to the stored triangle of K.
template <int Corners>
void add_cell(const Neighbours& near, const Eigen::Matrix<int, Corners, 1>& nodes,
              const Eigen::Matrix<double, 3 * Corners, 3 * Corners>& Ke, LowerMatrix& K) {
    double* value = K.valuePtr();
    for (int b = 0; b < Corners; ++b) {
        const int j = nodes(b);
        const auto first = near.node.begin() + near.start[static_cast<std::size_t>(j)];
        const auto last = near.node.begin() + near.start[static_cast<std::size_t>(j) + 1];
        for (int a = 0; a < Corners; ++a) {
            if (nodes(a) < j) continue;
            const auto place = static_cast<int>(std::lower_bound(first, last, nodes(a)) - first);
            for (int c = 0; c < 3; ++c) {
                double* column = value + K.outerIndexPtr()[3 * j + c];
                if (place == 0) {
                    for (int r = c; r < 3; ++r) column[r - c] += Ke(3 * a + r, 3 * b + c);
                } else {
                    for (int r = 0; r < 3; ++r) column[3 * place - c + r] += Ke(3 * a + r, 3 * b + c);
                }
            }
        }
    }
}

Hex hex_of(const Mesh& mesh, const Eigen::Matrix3Xd& values, Index cell) {
    Hex out;
    for (int k = 0; k < 8; ++k) out.col(k) = values.col(mesh.cells(k, cell));
    return out;
}

Tet tet_of(const Mesh& mesh, const Eigen::Matrix3Xd& values, Index cell) {
    Tet out;
    for (int k = 0; k < 4; ++k) out.col(k) = values.col(mesh.cells(k, cell));
    return out;
}

}  // namespace

LowerMatrix stiffness_N_per_m(const Mesh& mesh, Element element, std::span<const Material> materials,
                              const std::vector<bool>& skip) {
    if (is_hex(mesh) == (element == Element::tet4)) {
        throw MeshError(text("element tet4 needs cells of 4 corners, the others 8; the mesh has ", mesh.cells.rows()),
                        {});
    }
    if (static_cast<Index>(materials.size()) != mesh.cells.cols()) {
        throw MaterialError(text(materials.size(), " materials for ", mesh.cells.cols(), " cells; wanted one per cell"),
                            {});
    }
    const Neighbours near = neighbours_of(mesh);
    LowerMatrix K = pattern_of(near);
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        const auto i = static_cast<std::size_t>(cell);
        if (!skip.empty() && skip[i]) continue;
        if (element == Element::tet4) {
            add_cell<4>(near, mesh.cells.col(cell),
                        tet4_stiffness_N_per_m(tet_of(mesh, mesh.nodes_m, cell), materials[i]), K);
        } else {
            const Hex corners = hex_of(mesh, mesh.nodes_m, cell);
            const HexMatrix Ke = element == Element::hex8 ? hex8_stiffness_N_per_m(corners, materials[i])
                                                          : hex8_bbar_stiffness_N_per_m(corners, materials[i]);
            add_cell<8>(near, mesh.cells.col(cell), Ke, K);
        }
    }
    return K;
}

CellFields cell_fields(const Mesh& mesh, std::span<const Material> materials, const Eigen::Matrix3Xd& u_m) {
    CellFields fields;
    fields.strain.resize(6, mesh.cells.cols());
    fields.stress_Pa.resize(6, mesh.cells.cols());
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        const Voigt strain = is_hex(mesh) ? mean_strain(hex_of(mesh, mesh.nodes_m, cell), hex_of(mesh, u_m, cell))
                                          : mean_strain(tet_of(mesh, mesh.nodes_m, cell), tet_of(mesh, u_m, cell));
        fields.strain.col(cell) = strain;
        fields.stress_Pa.col(cell) = stress_Pa(materials[static_cast<std::size_t>(cell)], strain);
    }
    return fields;
}

double max_principal_strain(const CellFields& fields) {
    double largest = 0.0;
    for (Index cell = 0; cell < fields.strain.cols(); ++cell) {
        const Voigt e = fields.strain.col(cell);
        Eigen::Matrix3d strain;
        strain << e(0), 0.5 * e(3), 0.5 * e(5), 0.5 * e(3), e(1), 0.5 * e(4), 0.5 * e(5), 0.5 * e(4), e(2);
        largest = std::max(largest, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(strain, Eigen::EigenvaluesOnly)
                                        .eigenvalues()
                                        .cwiseAbs()
                                        .maxCoeff());
    }
    return largest;
}

}  // namespace palpa::mechanics
