#include "mechanics/stiffness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "mechanics/assembly.h"
#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

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

HexMatrix hex_stiffness_N_per_m(Element element, const Hex& corners_m, const Material& material) {
    switch (element) {
        case Element::hex8:
            return hex8_stiffness_N_per_m(corners_m, material);
        case Element::hex8i:
            return hex8i_stiffness_N_per_m(corners_m, material);
        case Element::hex8_bbar:
        case Element::tet4:
            break;
    }
    return hex8_bbar_stiffness_N_per_m(corners_m, material);
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
            add_cell<8>(near, mesh.cells.col(cell), hex_stiffness_N_per_m(element, corners, materials[i]), K);
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

double max_rotation_rad(const Mesh& mesh, const Eigen::Matrix3Xd& u_m) {
    double largest = 0.0;
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        Eigen::Matrix3d gradient;
        if (is_hex(mesh)) {
            gradient =
                hex_of(mesh, u_m, cell) * hex_middle(hex_of(mesh, mesh.nodes_m, cell)).gradient_per_m.transpose();
        } else {
            Tet gradient_per_m;
            tet_gradients_per_m(tet_of(mesh, mesh.nodes_m, cell), gradient_per_m);
            gradient = tet_of(mesh, u_m, cell) * gradient_per_m.transpose();
        }
        largest = std::max(largest, (gradient - gradient.transpose()).norm() / std::sqrt(8.0));
    }
    return largest;
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
