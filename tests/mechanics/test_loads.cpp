#include <algorithm>
#include <doctest/doctest.h>
#include <limits>
#include <numbers>
#include <random>

#include "mechanics/error.h"
#include "mechanics/loads.h"
#include "mechanics/mesh_check.h"
#include "tests/close_to.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

// Top nodes pushed about within the surface: triangles, or quads that are no parallelograms.
Mesh jittered(bool tets, unsigned seed, double amount_m) {
    Mesh mesh = hex_box({{0.1, 0.1, 0.02}, {9, 9, 1}, std::nullopt});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> push(-amount_m, amount_m);
    for (int node = 0; node < mesh.nodes_m.cols(); ++node) {
        const double x = mesh.nodes_m(0, node);
        const double y = mesh.nodes_m(1, node);
        if (std::min({x, y, 0.1 - x, 0.1 - y}) < 1e-9) continue;
        mesh.nodes_m(0, node) += push(random);
        mesh.nodes_m(1, node) += push(random);
    }
    return tets ? split_to_tets(mesh) : mesh;
}

void check_exact(const Mesh& mesh, const ParabolicPressure& pressure) {
    const Faces outer = boundary_faces(mesh);
    CAPTURE(pressure.centre_m[0]);
    CAPTURE(pressure.centre_m[1]);
    CAPTURE(pressure.diameter_m);
    const double Pmax = 8.0 * pressure.force_N / (std::numbers::pi * pressure.diameter_m * pressure.diameter_m);
    CHECK(Pmax * std::numbers::pi * pressure.diameter_m * pressure.diameter_m / 8.0 ==
          close_to(pressure.force_N).epsilon(1e-14));
    for (const LoadShare share : {LoadShare::consistent, LoadShare::thirds}) {
        const PressureLoad load = parabolic_load(mesh, outer, pressure, share);
        CHECK(std::abs(-load.force_N.row(2).sum() / pressure.force_N - 1.0) < 1e-10);
        CHECK(std::abs(load.applied_N / pressure.force_N - 1.0) < 1e-10);
        CHECK(!load.partial);
        CHECK(load.force_N.topRows<2>().isZero(0.0));
        if (share == LoadShare::thirds) continue;
        // first moment about the disc's centre, in radii
        for (int c = 0; c < 2; ++c) {
            const double moment = (load.force_N.row(2).array() *
                                   (mesh.nodes_m.row(c).array() - pressure.centre_m[static_cast<std::size_t>(c)]))
                                      .sum();
            CHECK(std::abs(moment) / (pressure.force_N * 0.5 * pressure.diameter_m) < 1e-9);
        }
    }
}

}  // namespace

TEST_CASE("hard case 19: the load is exact for any mesh and centre, even a disc smaller than a face") {
    std::mt19937 random(19);
    std::uniform_real_distribution<double> place(0.03, 0.07);
    std::uniform_real_distribution<double> logarithm(std::log(0.0005), std::log(0.05));
    for (unsigned trial = 0; trial < 25; ++trial) {
        const ParabolicPressure pressure{Side::zmax, {place(random), place(random)}, std::exp(logarithm(random)), 0.7};
        check_exact(jittered(true, trial, 0.003), pressure);
        check_exact(jittered(false, trial, 0.003), pressure);
        check_exact(jittered(false, trial, 0.0), pressure);
    }
    const double h = 0.1 / 9.0;
    for (const auto& centre :
         {std::array{4.0 * h, 5.0 * h}, std::array{4.0 * h, 4.5 * h}, std::array{4.5 * h, 4.5 * h}}) {
        for (const double diameter : {1e-4, 0.5 * h, h, 2.0 * h, 0.04}) {  // corner, edge, diagonal; touching circles
            check_exact(jittered(true, 0, 0.0), {Side::zmax, centre, diameter, 0.025});
            check_exact(jittered(false, 0, 0.0), {Side::zmax, centre, diameter, 0.025});
        }
    }
}

TEST_CASE("hard case 19: off the mesh only the inside share acts, and it is flagged") {
    const Mesh mesh = jittered(true, 1, 0.003);
    const Faces outer = boundary_faces(mesh);
    const PressureLoad half = parabolic_load(mesh, outer, {Side::zmax, {0.0, 0.05}, 0.02, 1.0}, LoadShare::consistent);
    CHECK(half.applied_N == close_to(0.5).epsilon(1e-10));
    CHECK(half.partial);
    const PressureLoad quarter = parabolic_load(mesh, outer, {Side::zmax, {0.1, 0.1}, 0.02, 1.0}, LoadShare::thirds);
    CHECK(quarter.applied_N == close_to(0.25).epsilon(1e-10));
    const PressureLoad none = parabolic_load(mesh, outer, {Side::zmax, {0.2, 0.2}, 0.02, 1.0}, LoadShare::consistent);
    CHECK(none.applied_N == 0.0);
    CHECK(none.partial);
}

TEST_CASE("parabolic load: thirds move the first moment, consistent shares do not") {
    const Mesh mesh = jittered(true, 2, 0.003);
    const Faces outer = boundary_faces(mesh);
    const ParabolicPressure pressure{Side::zmax, {0.0433, 0.0517}, 0.012, 1.0};
    const auto centre_x = [&](LoadShare share) {
        const PressureLoad load = parabolic_load(mesh, outer, pressure, share);
        return load.force_N.row(2).dot(mesh.nodes_m.row(0)) / load.force_N.row(2).sum();
    };
    CHECK(centre_x(LoadShare::consistent) == close_to(0.0433).epsilon(1e-10));
    CHECK(std::abs(centre_x(LoadShare::thirds) - 0.0433) > 1e-6);
}

TEST_CASE("parabolic load: moved and turned meshes carry the same forces, all six sides push inwards") {
    const Mesh mesh = hex_box({{0.1, 0.1, 0.1}, {6, 6, 6}, std::nullopt});
    const Faces outer = boundary_faces(mesh);
    std::vector<double> first;
    for (const Side side : {Side::xmin, Side::xmax, Side::ymin, Side::ymax, Side::zmin, Side::zmax}) {
        const PressureLoad load = parabolic_load(mesh, outer, {side, {0.043, 0.06}, 0.03, 1.0}, LoadShare::consistent);
        const double sign = is_max(side) ? -1.0 : 1.0;
        CHECK(load.force_N.row(axis_of(side)).sum() * sign == close_to(1.0).epsilon(1e-12));
        std::vector<double> forces;
        for (Eigen::Index i = 0; i < load.force_N.cols(); ++i)
            forces.push_back(std::abs(load.force_N(axis_of(side), i)));
        std::sort(forces.begin(), forces.end());
        if (first.empty()) first = forces;
        for (std::size_t i = 0; i < forces.size(); ++i) CHECK(std::abs(forces[i] - first[i]) < 1e-13);
    }
}

TEST_CASE("loads: traction adds up, wrong numbers are refused") {
    const Mesh mesh = hex_box({{0.1, 0.2, 0.05}, {3, 3, 3}, std::nullopt});
    const Faces outer = boundary_faces(mesh);
    const Eigen::Vector3d total =
        traction_load(mesh, faces_on(mesh, outer, Side::zmax), {1.0, -2.0, 3.0}).rowwise().sum();
    CHECK((total - 0.02 * Eigen::Vector3d(1.0, -2.0, 3.0)).norm() < 1e-15);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(traction_load(mesh, outer, {nan, 0.0, 0.0}), LoadError);
    CHECK_THROWS_AS(parabolic_load(mesh, outer, {Side::zmax, {0.05, 0.05}, 0.0, 1.0}, LoadShare::consistent),
                    LoadError);
    CHECK_THROWS_AS(parabolic_load(mesh, outer, {Side::zmax, {nan, 0.05}, 0.01, 1.0}, LoadShare::consistent),
                    LoadError);
}

TEST_CASE("pressure load: over a whole bent surface it has no resultant and no moment; it turns with the faces") {
    Mesh mesh = hex_box({{0.04, 0.03, 0.02}, {4, 3, 2}, std::nullopt});
    std::mt19937 random(5);
    std::uniform_real_distribution<double> push(-0.0015, 0.0015);
    for (double& x : mesh.nodes_m.reshaped()) x += push(random);
    for (const bool tets : {false, true}) {
        const Mesh body = tets ? split_to_tets(mesh) : mesh;
        const Faces outer = boundary_faces(body);
        const Eigen::Matrix3Xd f_N = pressure_load(body, outer, 100.0);
        CHECK(f_N.rowwise().sum().norm() < 1e-12 * f_N.norm());
        const Eigen::Matrix3d moment = f_N * body.nodes_m.transpose();  // -p V on the diagonal (divergence theorem)
        CHECK((moment + 100.0 * check_mesh(body).volume_m3 * Eigen::Matrix3d::Identity()).norm() <
              1e-10 * moment.norm());
        Eigen::Matrix3d turn;
        turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
        Mesh turned = body;
        turned.nodes_m = turn * body.nodes_m;
        CHECK((pressure_load(turned, outer, 100.0) - turn * f_N).norm() < 1e-12 * f_N.norm());
    }
    CHECK_THROWS_AS(pressure_load(mesh, boundary_faces(mesh), std::numeric_limits<double>::quiet_NaN()), LoadError);
}
