#include "mechanics/large_body.h"

#include <cmath>
#include <limits>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

template <int N>
Eigen::Matrix<double, 3, N> corners_now_m(const LargeBody& body, Eigen::Index cell, const Eigen::Matrix3Xd& u_m) {
    Eigen::Matrix<double, 3, N> x;
    for (int k = 0; k < N; ++k) {
        const int node = body.mesh.cells(k, cell);
        x.col(k) = body.mesh.nodes_m.col(node) + u_m.col(node);
    }
    return x;
}

template <int N>
const std::vector<CellRest<N>>& rests(const LargeBody& body) {
    if constexpr (N == 8)
        return body.hexes;
    else
        return body.tets;
}

bool has_mean_volume(const LargeBody& body) { return body.element == Element::hex8_bbar; }

}  // namespace

template <int N>
void cell_of(const LargeBody& body, Eigen::Index cell, const Eigen::Matrix3Xd& u_m, Wanted wanted, LargeCell<N>& out) {
    const auto at = static_cast<std::size_t>(cell);
    if constexpr (N == 8) {
        if (body.element == Element::hex8i)
            return incompatible_cell(body.walls[at], corners_now_m<N>(body, cell, u_m), wanted, out);
    }
    large_cell<N>(rests<N>(body)[at], body.materials[at], has_mean_volume(body), corners_now_m<N>(body, cell, u_m),
                  wanted, out);
}
template void cell_of<8>(const LargeBody&, Eigen::Index, const Eigen::Matrix3Xd&, Wanted, LargeCell<8>&);
template void cell_of<4>(const LargeBody&, Eigen::Index, const Eigen::Matrix3Xd&, Wanted, LargeCell<4>&);

namespace {

// Sums the energy, and what else is wanted. gradient_N and K_N_per_m may be null if they are not.
template <int N>
double sum_cells(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Wanted wanted, Tangent kind,
                 Eigen::Matrix3Xd* gradient_N, LowerMatrix* K_N_per_m) {
    LargeCell<N> cell;
    double energy = 0.0;
    for (Eigen::Index i = 0; i < body.mesh.cells.cols(); ++i) {
        cell_of(body, i, u_m, wanted, cell);
        energy += cell.energy_J;
        if (!std::isfinite(energy)) return std::numeric_limits<double>::infinity();
        if (wanted == Wanted::energy) continue;
        for (int k = 0; k < N; ++k) gradient_N->col(body.mesh.cells(k, i)) += cell.gradient_N.col(k);
        if (wanted == Wanted::gradient) continue;
        if (kind == Tangent::positive) make_positive<N>(cell.tangent_N_per_m);
        add_cell<N>(body.near, body.mesh.cells.col(i), cell.tangent_N_per_m, *K_N_per_m);
    }
    return energy;
}

double sum_all(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Wanted wanted, Tangent kind,
               Eigen::Matrix3Xd* gradient_N, LowerMatrix* K_N_per_m) {
    if (gradient_N != nullptr) gradient_N->setZero(3, u_m.cols());
    if (K_N_per_m != nullptr) K_N_per_m->coeffs().setZero();
    if (!u_m.allFinite()) return std::numeric_limits<double>::infinity();
    return body.element == Element::tet4 ? sum_cells<4>(body, u_m, wanted, kind, gradient_N, K_N_per_m)
                                         : sum_cells<8>(body, u_m, wanted, kind, gradient_N, K_N_per_m);
}

template <int N>
Eigen::Matrix<double, 3, N> corners_at_rest_m(const Mesh& mesh, Eigen::Index cell) {
    Eigen::Matrix<double, 3, N> x;
    for (int k = 0; k < N; ++k) x.col(k) = mesh.nodes_m.col(mesh.cells(k, cell));
    return x;
}

}  // namespace

LargeBody make_large_body(const Mesh& mesh, Element element, std::vector<LargeMaterial> materials) {
    if (is_hex(mesh) == (element == Element::tet4)) {
        throw MeshError(text("element tet4 needs cells of 4 corners, the others 8; the mesh has ", mesh.cells.rows()),
                        {});
    }
    if (static_cast<Eigen::Index>(materials.size()) != mesh.cells.cols()) {
        throw MaterialError(text(materials.size(), " materials for ", mesh.cells.cols(), " cells; wanted one per cell"),
                            {});
    }
    check_large_materials(materials);
    std::vector<int> not_turned;
    for (std::size_t i = 0; element == Element::hex8i && i < materials.size(); ++i) {
        if (materials[i].law != Law::corotational) not_turned.push_back(static_cast<int>(i));
    }
    if (!not_turned.empty())
        throw MaterialError(
            text("element hex8i with law ", name_of(materials[static_cast<std::size_t>(not_turned[0])].law),
                 "; wanted corotational"),
            not_turned);
    LargeBody body{mesh, element, std::move(materials), {}, {}, {}, neighbours_of(mesh)};
    for (Eigen::Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        if (element == Element::tet4)
            body.tets.push_back(rest_of(corners_at_rest_m<4>(mesh, cell)));
        else
            body.hexes.push_back(rest_of(corners_at_rest_m<8>(mesh, cell)));
        if (element == Element::hex8i)
            body.walls.push_back(incompatible_rest_of(corners_at_rest_m<8>(mesh, cell),
                                                      at_rest(body.materials[static_cast<std::size_t>(cell)])));
    }
    return body;
}

double energy_J(const LargeBody& body, const Eigen::Matrix3Xd& u_m) {
    return sum_all(body, u_m, Wanted::energy, Tangent::exact, nullptr, nullptr);
}

double energy_gradient_N(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Eigen::Matrix3Xd& gradient_N) {
    return sum_all(body, u_m, Wanted::gradient, Tangent::exact, &gradient_N, nullptr);
}

double energy_tangent_N_per_m(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Tangent kind,
                              Eigen::Matrix3Xd& gradient_N, LowerMatrix& K_N_per_m) {
    return sum_all(body, u_m, Wanted::tangent, kind, &gradient_N, &K_N_per_m);
}

CellFields large_cell_fields(const LargeBody& body, const Eigen::Matrix3Xd& u_m) {
    CellFields fields;
    fields.strain.resize(6, body.mesh.cells.cols());
    fields.stress_Pa.resize(6, body.mesh.cells.cols());
    for (Eigen::Index i = 0; i < body.mesh.cells.cols(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        const LargeFields cell =
            body.element == Element::tet4
                ? large_fields<4>(body.tets[at], body.materials[at], false, corners_now_m<4>(body, i, u_m))
                : large_fields<8>(body.hexes[at], body.materials[at], has_mean_volume(body),
                                  corners_now_m<8>(body, i, u_m));
        fields.strain.col(i) = cell.strain;
        fields.stress_Pa.col(i) = cell.stress_Pa;
    }
    return fields;
}

}  // namespace palpa::mechanics
