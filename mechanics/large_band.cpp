#include "mechanics/large_band.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "mechanics/banded.h"
#include "mechanics/index.h"

namespace palpa::mechanics {
namespace {

template <int N>
double sum_into_band(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Wanted wanted, Tangent kind,
                     Eigen::Matrix3Xd& gradient_N, BandMatrix* K) {
    LargeCell<N> cell;
    double energy = 0.0;
    const auto free_nodes = K != nullptr ? static_cast<int>(K->size() / 3) : 0;
    for (Eigen::Index i = 0; i < body.mesh.cells.cols(); ++i) {
        cell_of(body, i, u_m, wanted, cell);
        energy += cell.energy_J;
        if (!std::isfinite(energy)) return std::numeric_limits<double>::infinity();
        for (int k = 0; k < N; ++k) gradient_N.col(body.mesh.cells(k, i)) += cell.gradient_N.col(k);
        if (K == nullptr) continue;
        if (kind == Tangent::positive) make_positive<N>(cell.tangent_N_per_m);
        for (int b = 0; b < N; ++b) {
            const int column = body.mesh.cells(b, i);
            if (column >= free_nodes) continue;
            for (int a = b; a < N; ++a) {
                const int row = body.mesh.cells(a, i);
                if (row < free_nodes)
                    add_block(row, column, cell.tangent_N_per_m.template block<3, 3>(3 * a, 3 * b), *K);
            }
        }
    }
    return energy;
}

double sum_into_band_of(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Wanted wanted, Tangent kind,
                        Eigen::Matrix3Xd& gradient_N, BandMatrix* K) {
    if (!u_m.allFinite()) return std::numeric_limits<double>::infinity();
    return body.element == Element::tet4 ? sum_into_band<4>(body, u_m, wanted, kind, gradient_N, K)
                                         : sum_into_band<8>(body, u_m, wanted, kind, gradient_N, K);
}

}  // namespace

double add_energy_gradient_N(const LargeBody& body, const Eigen::Matrix3Xd& u_m,
                             Eigen::Matrix3Xd& gradient_N) noexcept {
    return sum_into_band_of(body, u_m, Wanted::gradient, Tangent::exact, gradient_N, nullptr);
}

double add_energy_tangent_N_per_m(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Tangent kind,
                                  Eigen::Matrix3Xd& gradient_N, BandMatrix& K_N_per_m) noexcept {
    return sum_into_band_of(body, u_m, Wanted::tangent, kind, gradient_N, &K_N_per_m);
}

NodeOrder node_order(const Mesh& mesh, const std::vector<bool>& held, const std::vector<std::vector<int>>& cliques) {
    // a matrix with one equation per free node, whose entries are the couplings
    const Eigen::Index n = mesh.nodes_m.cols();
    std::vector<int> equation(at(n), -1);
    NodeOrder out;
    for (Eigen::Index i = 0; i < n; ++i) {
        if (!held[at(i)]) equation[at(i)] = out.free_nodes++;
    }
    std::vector<Eigen::Triplet<double>> pairs;
    const auto couple = [&](int a, int b) {
        const int row = std::max(equation[at(a)], equation[at(b)]);
        const int column = std::min(equation[at(a)], equation[at(b)]);
        if (column >= 0) pairs.emplace_back(row, column, 1.0);
    };
    for (Eigen::Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        for (Eigen::Index b = 0; b < mesh.cells.rows(); ++b) {
            for (Eigen::Index a = 0; a <= b; ++a) couple(mesh.cells(a, cell), mesh.cells(b, cell));
        }
    }
    for (const std::vector<int>& clique : cliques) {
        for (const int a : clique) {
            for (const int b : clique) couple(a, b);
        }
    }
    LowerMatrix graph(out.free_nodes, out.free_nodes);
    graph.setFromTriplets(pairs.begin(), pairs.end());
    const BandOrder order = band_order(graph);
    out.band = 3 * order.band + 2;
    out.node_at.resize(at(n));
    int last = out.free_nodes;
    for (Eigen::Index i = 0; i < n; ++i) {
        const int e = equation[at(i)];
        out.node_at[at(e >= 0 ? order.position[at(e)] : last++)] = static_cast<int>(i);
    }
    return out;
}

Mesh renumbered(const Mesh& mesh, const NodeOrder& order) {
    Mesh out = mesh;
    std::vector<int> place(order.node_at.size());
    for (std::size_t i = 0; i < order.node_at.size(); ++i) {
        const int node = order.node_at[i];
        place[at(node)] = static_cast<int>(i);
        out.nodes_m.col(static_cast<Eigen::Index>(i)) = mesh.nodes_m.col(node);
        if (!mesh.node_number.empty()) out.node_number[i] = mesh.node_number[at(node)];
    }
    for (Eigen::Index i = 0; i < out.cells.size(); ++i) out.cells.data()[i] = place[at(out.cells.data()[i])];
    return out;
}

}  // namespace palpa::mechanics
