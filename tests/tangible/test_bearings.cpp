#include <doctest/doctest.h>
#include <random>

#include "tangible/bearings.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;
using palpa::test::close_to;

namespace {

struct PressedBox {
    mechanics::Mesh mesh;
    Bearing bearing;
    std::vector<BearingPoint> points;
    std::vector<double> shift_m;
    Eigen::Matrix3Xd u_m;
};

PressedBox pressed_box(bool by_nodes) {
    PressedBox out;
    mechanics::Box box;
    box.size_m = {0.01, 0.01, 0.005};
    box.cells = {4, 2, 1};
    out.mesh = mechanics::hex_box(box);
    out.bearing.point_m = Eigen::Vector3d(0.005, 0.0, -0.0076);
    out.bearing.radius_m = 0.008;
    out.bearing.by_nodes = by_nodes;
    out.bearing.faces = mechanics::faces_on(out.mesh, mechanics::boundary_faces(out.mesh), mechanics::Side::zmin);
    std::vector<int> same(static_cast<std::size_t>(out.mesh.nodes_m.cols()));
    for (std::size_t i = 0; i < same.size(); ++i) same[i] = static_cast<int>(i);
    out.points = bearing_points(out.bearing, out.mesh, same);
    out.shift_m.assign(out.points.size(), 0.0);
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    out.u_m.setZero(3, out.mesh.nodes_m.cols());
    for (Eigen::Index i = 0; i < out.u_m.size(); ++i) out.u_m.data()[i] = 5e-5 * normal(random);
    return out;
}

Eigen::Matrix3Xd bearing_gradient_N(const PressedBox& p, const Eigen::Matrix3Xd& u_m, mechanics::BandMatrix* K) {
    Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Zero(3, u_m.cols());
    add_bearing(p.bearing, p.points, p.shift_m, {p.mesh.nodes_m, u_m}, out, K);
    return out;
}

}  // namespace

TEST_CASE("bearings: force is minus the slope of energy, tangent the slope of force") {
    for (const bool by_nodes : {false, true}) {
        CAPTURE(by_nodes);
        const PressedBox p = pressed_box(by_nodes);
        const Eigen::Index n = p.u_m.size();
        mechanics::BandMatrix K = mechanics::band_matrix(n, static_cast<int>(n) - 1);
        const Eigen::Matrix3Xd gradient_N = bearing_gradient_N(p, p.u_m, &K);
        CHECK(gradient_N.norm() > 0.1);
        constexpr double kStep_m = 1e-9;
        double most = 0.0;
        for (Eigen::Index i = 0; i < n; ++i) {
            Eigen::Matrix3Xd up = p.u_m, down = p.u_m;
            up.data()[i] += kStep_m;
            down.data()[i] -= kStep_m;
            const double slope_N = (bearing_energy_J(p.bearing, p.points, p.shift_m, {p.mesh.nodes_m, up}) -
                                    bearing_energy_J(p.bearing, p.points, p.shift_m, {p.mesh.nodes_m, down})) /
                                   (2.0 * kStep_m);
            CHECK(std::abs(slope_N - gradient_N.data()[i]) < 1e-6 * gradient_N.norm());
            const Eigen::Matrix3Xd change =
                (bearing_gradient_N(p, up, nullptr) - bearing_gradient_N(p, down, nullptr)) / (2.0 * kStep_m);
            for (Eigen::Index j = i; j < n; ++j) most = std::max(most, std::abs(change.data()[j] - K.at(j, i)));
        }
        CHECK(most < 1e-5 * K.values.cwiseAbs().maxCoeff());
    }
}

TEST_CASE("bearings: the pressure starts smoothly and then grows by its stiffness") {
    const Bearing b;
    CHECK(push_of(b, -1e-6).pressure_Pa == 0.0);
    CHECK(push_of(b, 0.3e-3).pressure_Pa == close_to(0.5 * 1.25e9 * 0.3e-3));
    CHECK(push_of(b, 1.3e-3).pressure_Pa - push_of(b, 0.3e-3).pressure_Pa == close_to(1.25e6));
    for (const double d : {0.1e-3, 0.29999e-3, 0.30001e-3, 1e-3}) {
        const double slope = (push_of(b, d + 1e-9).energy_J_per_m2 - push_of(b, d - 1e-9).energy_J_per_m2) / 2e-9;
        CHECK(slope == close_to(push_of(b, d).pressure_Pa).epsilon(1e-5));
    }
}

TEST_CASE("bearings: as a constraint the shift grows until nothing penetrates, and never below 0") {
    PressedBox p = pressed_box(false);
    p.bearing.constraint = true;
    const double first_m = move_shifts(p.bearing, p.points, {p.mesh.nodes_m, p.u_m}, p.shift_m);
    CHECK(first_m > 1e-4);
    for (const double shift : p.shift_m) CHECK(shift >= 0.0);
    p.u_m.row(2).array() += 0.01;  // away from it
    move_shifts(p.bearing, p.points, {p.mesh.nodes_m, p.u_m}, p.shift_m);
    for (const double shift : p.shift_m) CHECK(shift == 0.0);
}
