#include "mechanics/button_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/solver.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kOnCircle = 1e-6;  // of a spacing: nodes this near to a circle stand on it

void check_cover(const ButtonCover& c) {
    for (const auto& [name, value] : {std::pair{"radius", c.radius_m},
                                      {"cap radius", c.cap_radius_m},
                                      {"thickness", c.thickness_m},
                                      {"Young's modulus", c.young_Pa},
                                      {"density", c.density_kg_per_m3}}) {
        if (!(value > 0.0 && std::isfinite(value))) throw MeshError(text("a cover's ", name, " of ", value), {});
    }
    if (!(c.cap_radius_m < c.radius_m)) {
        throw MeshError(text("a cap of radius ", 1e3 * c.cap_radius_m, " mm in a cover of ", 1e3 * c.radius_m,
                             " mm: the cap must be smaller"),
                        {});
    }
    const double between = (1.0 - c.cap_radius_m / c.radius_m) * c.spacings;
    if (!(c.spacings <= 200 && between >= 2.0))
        throw MeshError(text(c.spacings, " spacings over the radius, ", between, " of them between cap and rim"), {});
}

enum class Where { cap, ring, outside };

// The nodes of the lattice, and where its edges cross the circles.
struct NetBuilder {
    CoverNet net;
    double spacing_m = 0.0;
    std::vector<Vector2d> free_m, rim_m, cap_m;
    std::map<std::array<int, 2>, int> number;  // of the free nodes

    Vector2d place_m(int i, int j) const { return spacing_m * Vector2d(i + 0.5 * j, 0.5 * std::sqrt(3.0) * j); }
    Where where(const Vector2d& p) const {
        const double r = p.norm(), tolerance = kOnCircle * spacing_m;
        if (r <= net.cover.cap_radius_m + tolerance) return Where::cap;
        return r >= net.cover.radius_m - tolerance ? Where::outside : Where::ring;
    }
};

// Where the line from p, in the ring, to q leaves it: share of the way, 0..1.
double crossing(const Vector2d& p, const Vector2d& q, double radius_m, bool inwards) {
    const Vector2d d = q - p;
    const double a = d.squaredNorm(), b = p.dot(d), c = p.squaredNorm() - radius_m * radius_m;
    const double root = std::sqrt(std::max(0.0, b * b - a * c));
    return std::clamp((inwards ? -b - root : -b + root) / a, 0.0, 1.0);
}

// Adds the spring from a free node to a neighbour. Nodes on rim and cap are numbered -1 - i and by `kCapBase` for now.
constexpr int kCapBase = 1 << 28;

void add_spring(int from, const Vector2d& p, const std::array<int, 2>& to, NetBuilder& builder) {
    const Vector2d q = builder.place_m(to[0], to[1]);
    const Where where = builder.where(q);
    const double s = builder.spacing_m;
    const double k = 0.5 * std::sqrt(3.0) * builder.net.cover.young_Pa * builder.net.cover.thickness_m;
    if (where == Where::ring) {
        const int other = builder.number.at(to);
        if (from < other) builder.net.springs.push_back({from, other, s, k});
        return;
    }
    const bool cap = where == Where::cap;
    const ButtonCover& cover = builder.net.cover;
    const double share = crossing(p, q, cap ? cover.cap_radius_m : cover.radius_m, cap);
    std::vector<Vector2d>& ends = cap ? builder.cap_m : builder.rim_m;
    const int end = static_cast<int>(ends.size());
    ends.push_back(p + share * (q - p));
    builder.net.springs.push_back({from, cap ? kCapBase + end : -1 - end, share * s, k / share});
}

void finish_net(NetBuilder& builder) {
    CoverNet& net = builder.net;
    net.n_free = static_cast<int>(builder.free_m.size());
    net.n_cap = static_cast<int>(builder.cap_m.size());
    const int n_rim = static_cast<int>(builder.rim_m.size());
    net.rest_m.setZero(3, net.n_free + n_rim + net.n_cap);
    int column = 0;
    for (const auto* list : {&builder.free_m, &builder.rim_m, &builder.cap_m})
        for (const Vector2d& p : *list) net.rest_m.col(column++).head<2>() = p;
    for (CoverSpring& spring : net.springs) {
        if (spring.b >= kCapBase) {
            spring.b += net.n_free + n_rim - kCapBase;
        } else if (spring.b < 0) {
            spring.b = net.n_free - 1 - spring.b;
        }
    }
}

Vector3d position_m(const CoverNet& net, const Matrix3Xd& u_m, double travel_m, int node) {
    Vector3d p = net.rest_m.col(node);
    if (node < net.n_free) return p + u_m.col(node);
    if (node >= net.rest_m.cols() - net.n_cap) p.z() += travel_m;
    return p;
}

// Gradient and lower triangle of the tangent for the free nodes; and those of the cap's travel.
struct NetTangent {
    Eigen::VectorXd gradient_N;  // 3 n_free
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd coupling_N_per_m;  // d gradient / d travel
    double cap_N_per_m = 0.0;
    double largest_N = 0.0;  // force of a spring
};

void add_block(int row, int column, const Matrix3d& block, std::vector<Eigen::Triplet<double>>& entries) {
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            if (3 * row + i >= 3 * column + j) entries.emplace_back(3 * row + i, 3 * column + j, block(i, j));
        }
    }
}

void add_spring_tangent(const CoverNet& net, const CoverSpring& spring, const Vector3d& d, NetTangent& out) {
    const double L = d.norm();
    const double tension_N = spring.k_N_per_m * (L - spring.length_m);
    out.largest_N = std::max(out.largest_N, std::abs(tension_N));
    const Vector3d n = d / L;
    // 1 - L0/L from the difference, which does not cancel
    const double across = spring.k_N_per_m * (L - spring.length_m) / L;
    const Matrix3d block = across * Matrix3d::Identity() + (spring.k_N_per_m - across) * n * n.transpose();
    out.gradient_N.segment<3>(3 * spring.a) -= tension_N * n;
    add_block(spring.a, spring.a, block, out.entries);
    if (spring.b < net.n_free) {
        out.gradient_N.segment<3>(3 * spring.b) += tension_N * n;
        add_block(spring.b, spring.b, block, out.entries);
        add_block(std::max(spring.a, spring.b), std::min(spring.a, spring.b), -block, out.entries);
    } else if (spring.b >= net.rest_m.cols() - net.n_cap) {
        out.coupling_N_per_m.segment<3>(3 * spring.a) -= block.col(2);
        out.cap_N_per_m += block(2, 2);
    }
}

NetTangent tangent_of(const CoverNet& net, const Matrix3Xd& u_m, double travel_m) {
    NetTangent out;
    out.gradient_N.setZero(3 * net.n_free);
    out.coupling_N_per_m.setZero(3 * net.n_free);
    for (const CoverSpring& spring : net.springs) {
        const Vector3d d = position_m(net, u_m, travel_m, spring.b) - position_m(net, u_m, travel_m, spring.a);
        add_spring_tangent(net, spring, d, out);
    }
    for (int i = 0; i < net.n_free; ++i) out.gradient_N.segment<3>(3 * i) -= net.node_kg * net.cover.gravity_m_per_s2;
    return out;
}

// The factorisation of a net's tangents, which have one pattern.
struct CoverSolver {
    SparseCholesky cholesky{SolverKind::eigen};
    bool analysed = false;
};

// Factors the tangent with the least shift of its diagonal that makes it positive definite.
bool factor_shifted(const NetTangent& tangent, CoverSolver& solver) {
    const auto n = tangent.gradient_N.size();
    LowerMatrix K(n, n);
    K.setFromTriplets(tangent.entries.begin(), tangent.entries.end());
    double largest = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) largest = std::max(largest, K.coeff(i, i));
    if (!std::exchange(solver.analysed, true)) solver.cholesky.analyse(K);
    for (double shift = 0.0; shift<10.0 * largest; shift = shift> 0.0 ? 10.0 * shift : 1e-9 * largest) {
        LowerMatrix shifted = K;
        for (Eigen::Index i = 0; i < n; ++i) shifted.coeffRef(i, i) += shift;
        if (solver.cholesky.try_factor(shifted)) return true;
    }
    return false;
}

// The shape of the closed form, and the sag that a flat net's own weight gives it.
Matrix3Xd first_shape(const CoverNet& net, double travel_m) {
    const ButtonCover& c = net.cover;
    const double rim = std::cbrt(c.radius_m * c.radius_m), cap = std::cbrt(c.cap_radius_m * c.cap_radius_m);
    const double load = c.density_kg_per_m3 * c.gravity_m_per_s2.z() * c.radius_m / c.young_Pa;
    const double sag_m = 0.5 * c.radius_m * std::cbrt(load);
    Matrix3Xd u_m = Matrix3Xd::Zero(3, net.n_free);
    for (int i = 0; i < net.n_free; ++i) {
        const double r = net.rest_m.col(i).head<2>().norm();
        const double x = (r - c.cap_radius_m) / (c.radius_m - c.cap_radius_m);
        u_m(2, i) = travel_m * (rim - std::cbrt(r * r)) / (rim - cap) + 4.0 * sag_m * x * (1.0 - x);
    }
    return u_m;
}

// Takes a step along d that lowers the energy; false if none does.
bool take_cover_step(const CoverNet& net, const Eigen::VectorXd& d, double slope, CoverState& state) {
    const Matrix3Xd before = state.u_m;
    for (double share = 1.0; share > 1e-6; share *= 0.5) {
        state.u_m = before + share * d.reshaped(3, net.n_free);
        const double energy_J = cover_energy_J(net, state.u_m, state.travel_m);
        // what round-off in the lengths leaves of small energies must not stop the last steps
        if (energy_J <= state.energy_J + 1e-4 * share * slope + 1e-9 * std::abs(state.energy_J)) {
            state.energy_J = energy_J;
            return true;
        }
    }
    state.u_m = before;
    return false;
}

// Newton's method from the shape `start_m`.
CoverState settle(const CoverNet& net, double travel_m, Matrix3Xd start_m, CoverSolver& solver) {
    CoverState out;
    out.travel_m = travel_m;
    out.u_m = std::move(start_m);
    out.energy_J = cover_energy_J(net, out.u_m, travel_m);
    if (travel_m == 0.0 && net.cover.gravity_m_per_s2.isZero()) {
        out.converged = true;
        return out;
    }
    for (; out.iterations < 100; ++out.iterations) {
        const NetTangent tangent = tangent_of(net, out.u_m, travel_m);
        if (!factor_shifted(tangent, solver)) break;
        const double resolved_N = 4e-15 * net.springs.front().k_N_per_m * net.cover.radius_m;
        const double residual_N = tangent.gradient_N.cwiseAbs().maxCoeff();
        if (residual_N <= std::max(1e-10 * tangent.largest_N, resolved_N)) {
            Eigen::MatrixXd y = tangent.coupling_N_per_m;
            solver.cholesky.solve(y);
            out.slope_N_per_m = tangent.cap_N_per_m - tangent.coupling_N_per_m.dot(y.col(0));
            out.converged = true;
            break;
        }
        Eigen::MatrixXd d = -tangent.gradient_N;
        solver.cholesky.solve(d);
        if (!take_cover_step(net, d.col(0), tangent.gradient_N.dot(d.col(0)), out)) break;
    }
    out.force_N = cover_force_N(net, out.u_m, travel_m);
    return out;
}

}  // namespace

CoverNet make_net(const ButtonCover& cover) {
    check_cover(cover);
    NetBuilder builder;
    builder.net.cover = cover;
    const double s = builder.spacing_m = cover.radius_m / cover.spacings;
    const int reach = 2 * cover.spacings;
    std::vector<std::array<int, 2>> nodes;
    for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
            const Vector2d p = builder.place_m(i, j);
            if (builder.where(p) != Where::ring) continue;
            builder.number[{i, j}] = static_cast<int>(nodes.size());
            nodes.push_back({i, j});
            builder.free_m.push_back(p);
        }
    }
    constexpr std::array<std::array<int, 2>, 6> kNeighbour{{{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}}};
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        for (const auto& step : kNeighbour) {
            add_spring(static_cast<int>(n), builder.free_m[n], {nodes[n][0] + step[0], nodes[n][1] + step[1]}, builder);
        }
    }
    finish_net(builder);
    const double sheet_kg_per_m2 = cover.density_kg_per_m3 * cover.thickness_m;
    builder.net.node_kg = sheet_kg_per_m2 * 0.5 * std::sqrt(3.0) * s * s;
    builder.net.cap_kg = sheet_kg_per_m2 * 3.14159265358979323846 * cover.cap_radius_m * cover.cap_radius_m;
    return builder.net;
}

double cover_energy_J(const CoverNet& net, const Matrix3Xd& u_m, double travel_m) {
    double energy = -net.cap_kg * net.cover.gravity_m_per_s2.z() * travel_m;
    for (const CoverSpring& spring : net.springs) {
        const double L = (position_m(net, u_m, travel_m, spring.b) - position_m(net, u_m, travel_m, spring.a)).norm();
        energy += 0.5 * spring.k_N_per_m * (L - spring.length_m) * (L - spring.length_m);
    }
    return energy - net.node_kg * net.cover.gravity_m_per_s2.dot(u_m.rowwise().sum());
}

double cover_force_N(const CoverNet& net, const Matrix3Xd& u_m, double travel_m) {
    double force_N = -net.cap_kg * net.cover.gravity_m_per_s2.z();
    for (const CoverSpring& spring : net.springs) {
        if (spring.b < net.rest_m.cols() - net.n_cap) continue;
        const Vector3d d = position_m(net, u_m, travel_m, spring.b) - position_m(net, u_m, travel_m, spring.a);
        const double L = d.norm();
        force_N += spring.k_N_per_m * (L - spring.length_m) * d.z() / L;
    }
    return force_N;
}

CoverState press_cover(const CoverNet& net, double travel_m) {
    CoverSolver solver;
    return settle(net, travel_m, first_shape(net, travel_m), solver);
}

std::vector<CoverState> press_cover(const CoverNet& net, const std::vector<double>& travels_m) {
    CoverSolver solver;
    std::vector<CoverState> out;
    for (const double travel_m : travels_m) {
        const std::size_t n = out.size();
        CoverState state;
        if (n >= 3) state = settle(net, travel_m, 3.0 * (out[n - 1].u_m - out[n - 2].u_m) + out[n - 3].u_m, solver);
        if (!state.converged) state = settle(net, travel_m, first_shape(net, travel_m), solver);
        out.push_back(std::move(state));
    }
    return out;
}

double membrane_force_N(const ButtonCover& cover, double travel_m) {
    const double root = std::cbrt(cover.radius_m * cover.radius_m) - std::cbrt(cover.cap_radius_m * cover.cap_radius_m);
    const double ratio = travel_m / root;
    return 3.14159265358979323846 / 3.0 * cover.young_Pa * cover.thickness_m * ratio * ratio * ratio;
}

}  // namespace palpa::mechanics
