#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <random>

#include "mechanics/error.h"
#include "mechanics/finger.h"
#include "mechanics/layer.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;
using Eigen::Vector2d;
using palpa::test::close_to;

namespace {

// An even grid whose compliance is that of a half-space; modulus infinity: rigid.
Compliance half_space(int n, double spacing_m, double plane_modulus_Pa) {
    Compliance c;
    c.revision = new_revision();
    c.n_touch = n * n;
    c.position_m.setZero(3, c.n_touch);
    for (int k = 0; k < c.n_touch; ++k) c.position_m.col(k) << k % n * spacing_m, k / n * spacing_m, 1.0;
    c.area_m2.setConstant(c.n_touch, spacing_m * spacing_m);
    c.surface_z_m = c.thickness_m = 1.0;
    c.normal_m_per_N = half_space_kernel_per_m(surface_grid(c)) / plane_modulus_Pa;
    return c;
}

Finger pad_finger(double young_Pa, double rise_Pa_per_N = 0.0, double diameter_m = 16e-3) {
    return {FingerContact::pad, diameter_m, {young_Pa, rise_Pa_per_N, 0.5}};
}

// The paper's slab, graded around its middle; all its surface can be touched.
const Compliance& finger_slab() {
    static const Compliance c = [] {
        const Problem problem =
            slab_problem(hex_box(graded_box(0.1, 0.05, 26, 6, 0.0018)), Element::hex8_bbar, {17500.0, 0.45});
        return slab_compliance(problem, {0.0, 0.1, 0.0, 0.1});
    }();
    return c;
}

bool is_finite(const FingerPress& p) {
    return std::isfinite(p.force_N) && std::isfinite(p.depth_m) && std::isfinite(p.linearity);
}

const Finger kFingers[] = {
    {FingerContact::parabola, 16e-3, {}}, {FingerContact::rigid, 16e-3, {}}, {FingerContact::pad, 16e-3, {}}};

}  // namespace

TEST_CASE("finger: the parabola's forces on a grid are those on the mesh") {
    const Mesh mesh = hex_box(graded_box(0.1, 0.05, 14, 2, 0.004));
    const Faces outer = boundary_faces(mesh);
    Compliance c;
    const SurfaceRequest request = request_rectangle(mesh, outer, {0.0, 0.1, 0.0, 0.1});
    c.n_touch = static_cast<int>(request.touch_nodes.size());
    c.position_m.resize(3, c.n_touch);
    for (int k = 0; k < c.n_touch; ++k)
        c.position_m.col(k) = mesh.nodes_m.col(request.touch_nodes[static_cast<std::size_t>(k)]);
    FingerWork work;
    work.grid = surface_grid(c);
    work.force_N.setZero(c.n_touch);
    work.corner_m.setZero(2, 4);

    const unsigned seed = 11;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> anywhere(-0.005, 0.105);
    std::uniform_real_distribution<double> size(0.0005, 0.04);
    for (int k = 0; k < 60; ++k) {
        Vector2d place_m(anywhere(random), anywhere(random));
        if (k % 6 == 0) place_m = c.position_m.col(k % c.n_touch).head<2>();  // on a node
        const double diameter_m = size(random);
        CAPTURE(place_m.transpose());
        CAPTURE(diameter_m);
        parabola_on_grid(place_m, diameter_m, work);
        const PressureLoad load = parabolic_load(mesh, outer, {Side::zmax, {place_m.x(), place_m.y()}, diameter_m, 1.0},
                                                 LoadShare::consistent);
        Eigen::VectorXd on_grid = Eigen::VectorXd::Zero(c.n_touch);
        for (const NodeRun& run : work.run)
            on_grid.segment(run.first, run.count) += work.force_N.segment(run.offset, run.count);
        double worst = 0.0;
        for (int node = 0; node < c.n_touch; ++node) {
            const double on_mesh = -load.force_N(2, request.touch_nodes[static_cast<std::size_t>(node)]);
            worst = std::max(worst, std::abs(on_grid(node) - on_mesh));
        }
        CHECK(worst < 1e-10);
        CHECK(std::abs(work.share - load.applied_N) < 1e-10);
    }
}

TEST_CASE("finger: depth and surface of a slab 400 mm wide are within 1 % of the exact layer") {
    if (kSlow) return;
    // 24,000 nodes: 1.25 mm within 8.75 mm of the middle, from there on growing; only nodes within 10 mm are touched
    const Eigen::VectorXd outside_m = graded_coordinates_m(0.2 - 8.75e-3, 14, 0.0, 1.25e-3);
    Eigen::VectorXd x_m(43);
    x_m.segment(14, 15) = Eigen::VectorXd::LinSpaced(15, 0.2 - 8.75e-3, 0.2 + 8.75e-3);
    x_m.head(14) = (0.2 - 8.75e-3 - outside_m.tail(14).array()).reverse();
    x_m.tail(14) = 0.2 + 8.75e-3 + outside_m.tail(14).array();
    const Problem problem = slab_problem(hex_box(x_m, x_m, graded_coordinates_m(0.05, 12, 0.05, 1e-3)),
                                         Element::hex8_bbar, {17500.0, 0.45});
    const Compliance c = slab_compliance(problem, {0.19, 0.21, 0.19, 0.21});
    const Finger finger;
    FingerWork work = make_finger_work(c, finger);
    const double force_N = 0.5;
    const Vector2d middle_m(0.2, 0.2);
    const FingerPress press = finger_with_force(c, finger, middle_m, force_N, work);
    const Layer layer{17500.0, 0.45, 0.05};
    const ParabolicPatch patch{8e-3, force_N};
    CHECK(press.depth_m == close_to(layer_mean_depression_m(layer, patch)).epsilon(0.01));
    Eigen::Matrix2Xd pins_m(2, 36);
    for (int k = 0; k < 36; ++k) pins_m.col(k) = middle_m + Vector2d(k % 6 - 2.5, k / 6 - 2.5) * 2e-3;
    Eigen::VectorXd u_m(36);
    finger_surface_m(c, work, pins_m, u_m);
    for (int k = 0; k < 36; ++k) {
        CAPTURE(k);
        const double exact_m = layer_depression_m(layer, patch, (pins_m.col(k) - middle_m).norm());
        CHECK(u_m(k) == close_to(exact_m).epsilon(0.01));
    }
}

TEST_CASE("finger: a pad of constant modulus follows Hertz within 3 % from four spacings on") {
    const double spacing_m = 0.5e-3;
    const double young_Pa = 60e3;
    const double plane_Pa = plane_strain_modulus_Pa(young_Pa, 0.5);
    Compliance rigid = half_space(25, spacing_m, 1.0);
    rigid.normal_m_per_N.setZero();
    const Finger finger = pad_finger(young_Pa, 0.0, 40e-3);
    const unsigned seed = 5;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> within(-0.5, 0.5);
    for (const double spacings : {4.1, 5.0, 6.5, 8.0}) {
        FingerWork work = make_finger_work(rigid, finger);
        const double approach_m = std::pow(spacings * spacing_m, 2.0) / (0.5 * finger.diameter_m);
        const double force_N = hertz_force_N(plane_Pa, 0.5 * finger.diameter_m, approach_m);
        for (int k = 0; k < 5; ++k) {
            const Vector2d place_m = Vector2d(12 + within(random), 12 + within(random)) * spacing_m;
            const FingerPress press = finger_with_force(rigid, finger, place_m, force_N, work);
            CAPTURE(spacings);
            CHECK(press.force_N == close_to(force_N).epsilon(1e-6));
            CHECK(press.depth_m == 0.0);  // all of it is the pad's own yielding
            // F rises as approach^1.5: 3 % of the force are 2 % of the approach
            CHECK(work.contact.tool[0].depth_m == close_to(approach_m).epsilon(0.02));
        }
    }
}

TEST_CASE("finger: the person's own pad is not counted in the depth") {
    // two half-spaces share the approach as their compliances; under Hertz's pressure the mean depression is 4/5 of it
    const double tissue_Pa = 30e3;
    const Compliance c = half_space(25, 0.5e-3, tissue_Pa);
    for (const double young_Pa : {10e3, 60e3, 400e3}) {
        const Finger finger = pad_finger(young_Pa, 0.0, 40e-3);
        const double pad_Pa = pad_modulus_Pa(finger.pad, 0.0);
        const double both_Pa = 1.0 / (1.0 / pad_Pa + 1.0 / tissue_Pa);
        const double approach_m = std::pow(3.0e-3, 2.0) / 20e-3;
        const double force_N = hertz_force_N(both_Pa, 20e-3, approach_m);
        FingerWork work = make_finger_work(c, finger);
        const FingerPress press = finger_with_force(c, finger, Vector2d(6e-3, 6e-3), force_N, work);
        CAPTURE(young_Pa);
        CHECK(press.depth_m == close_to(0.8 * approach_m * both_Pa / tissue_Pa).epsilon(0.02));
        CHECK(work.contact.tool[0].depth_m == close_to(approach_m).epsilon(0.02));
    }
}

TEST_CASE("finger: a very stiff pad is a rigid sphere, and its modulus follows the force") {
    const Compliance& c = finger_slab();
    const Vector2d place_m(0.05, 0.05);
    const Finger rigid{FingerContact::rigid, 16e-3, {}};
    const Finger stiff = pad_finger(1e12);
    FingerWork of_rigid = make_finger_work(c, rigid);
    FingerWork of_stiff = make_finger_work(c, stiff);
    const double depth_m = finger_with_force(c, rigid, place_m, 0.6, of_rigid).depth_m;
    CHECK(finger_with_force(c, stiff, place_m, 0.6, of_stiff).depth_m == close_to(depth_m).epsilon(1e-5));

    const Finger rising = pad_finger(20e3, 30e3);
    FingerWork work = make_finger_work(c, rising);
    const FingerPress press = finger_with_force(c, rising, place_m, 0.8, work);
    const Finger constant = pad_finger(20e3 + 0.8 * 30e3);
    FingerWork other = make_finger_work(c, constant);
    CHECK(press.depth_m == close_to(finger_with_force(c, constant, place_m, 0.8, other).depth_m).epsilon(1e-9));
}

TEST_CASE("finger: scaling the pad's law scales the tissue") {
    const Compliance& c = finger_slab();
    Compliance stiffer = c;
    stiffer.revision = new_revision();
    stiffer.normal_m_per_N /= 1.7;
    const Finger finger = kFingers[2];
    Finger as_scaled = finger;
    as_scaled.pad = scaled(finger.pad, 1.7);
    FingerWork direct = make_finger_work(stiffer, finger);
    FingerWork by_scale = make_finger_work(c, as_scaled);
    const Vector2d place_m(0.052, 0.047);
    const FingerPress a = finger_with_force(stiffer, finger, place_m, 0.9, direct);
    const FingerPress b = finger_with_force(c, as_scaled, place_m, 0.9 / 1.7, by_scale);
    CHECK(a.depth_m == close_to(b.depth_m).epsilon(1e-8));
}

TEST_CASE("finger: depth for force and force for depth are inverse, and force rises with depth") {
    const Compliance& c = finger_slab();
    const unsigned seed = 3;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0.02, 0.08);
    std::uniform_real_distribution<double> force(0.01, 1.5);
    for (const Finger& finger : kFingers) {
        CAPTURE(static_cast<int>(finger.contact));
        FingerWork work = make_finger_work(c, finger);
        for (int k = 0; k < 25; ++k) {
            const Vector2d place_m(place(random), place(random));
            const double force_N = force(random);
            const FingerPress there = finger_with_force(c, finger, place_m, force_N, work);
            if (there.capped) continue;
            const FingerPress back = finger_to_depth(c, finger, place_m, there.depth_m, work);
            CHECK(back.force_N == close_to(force_N).epsilon(1e-5));
            CHECK_FALSE(back.inexact);
        }
        double last_N = 0.0;
        for (double depth_m = 0.2e-3; depth_m < 8e-3; depth_m += 0.2e-3) {
            const FingerPress press = finger_to_depth(c, finger, {0.05, 0.05}, depth_m, work);
            CHECK(press.force_N > last_N);
            last_N = press.force_N;
        }
    }
}

TEST_CASE("finger: work in is energy: force is the slope of the tissue's energy for the parabola") {
    const Compliance& c = finger_slab();
    const Finger finger;
    FingerWork work = make_finger_work(c, finger);
    const FingerPress press = finger_with_force(c, finger, {0.043, 0.061}, 0.7, work);
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(c.n_touch);
    for (const NodeRun& run : work.run)
        force_N.segment(run.first, run.count) += work.surface_scale * work.force_N.segment(run.offset, run.count);
    CHECK(force_N.sum() == close_to(0.7).epsilon(1e-10));
    CHECK(press.depth_m == close_to(force_N.dot(c.normal_m_per_N * force_N) / 0.7).epsilon(1e-10));
}

TEST_CASE("finger over the edge: softer, flagged, finite, and continuous across it") {
    const Compliance& c = finger_slab();
    for (const Finger& finger : kFingers) {
        CAPTURE(static_cast<int>(finger.contact));
        FingerWork work = make_finger_work(c, finger);
        double last_N = -1.0;
        for (double x_m = 0.02; x_m > -0.02; x_m -= 0.25e-3) {
            CAPTURE(x_m);
            const FingerPress press = finger_to_depth(c, finger, {x_m, 0.05}, 2e-3, work);
            CHECK(is_finite(press));
            CHECK(press.force_N >= 0.0);
            if (x_m < 0.0) CHECK((press.over_edge || press.force_N == 0.0));
            if (last_N >= 0.0) CHECK(std::abs(press.force_N - last_N) < 0.06);
            last_N = press.force_N;
        }
        CHECK(last_N == 0.0);
        CHECK(finger_to_depth(c, finger, {-1.0, 0.05}, 2e-3, work).over_edge);
        CHECK(finger_with_force(c, finger, {0.05, 9.0}, 1.0, work).force_N == 0.0);
    }
}

TEST_CASE("finger: a disc smaller than an element presses with its whole force") {
    const Compliance& c = finger_slab();
    const Finger finger{FingerContact::parabola, 0.3e-3, {}};
    FingerWork work = make_finger_work(c, finger);
    for (const Vector2d& place_m : {Vector2d(0.0312, 0.0457), Vector2d(0.0500, 0.0500), Vector2d(0.0101, 0.0899)}) {
        const FingerPress press = finger_with_force(c, finger, place_m, 1e-3, work);
        CHECK(press.force_N == 1e-3);
        CHECK(work.share == close_to(1.0).epsilon(1e-9));
        CHECK(press.depth_m > 0.0);
        CHECK_FALSE(press.over_edge);
    }
}

TEST_CASE("finger: an inclusion at the surface, contrast 1e6") {
    Problem problem = slab_problem(hex_box(graded_box(0.1, 0.05, 20, 5, 0.0025)), Element::hex8_bbar, {17500.0, 0.45});
    assign_sphere({{0.05, 0.05, 0.047}, 0.006}, 1, problem.mesh);  // breaks through the surface
    const Material list[2] = {{17500.0, 0.45}, {17500.0e6, 0.3}};
    problem.materials = materials_of_cells(problem.mesh.region, list);
    const Compliance c = slab_compliance(problem, {0.0, 0.1, 0.0, 0.1});
    for (const Finger& finger : kFingers) {
        CAPTURE(static_cast<int>(finger.contact));
        FingerWork work = make_finger_work(c, finger);
        Eigen::VectorXd u_m(3);
        Eigen::Matrix2Xd points_m(2, 3);
        points_m << 0.046, 0.05, 0.054, 0.05, 0.05, 0.05;
        const double on_N = finger_to_depth(c, finger, {0.05, 0.05}, 1e-3, work).force_N;
        finger_surface_m(c, work, points_m, u_m);
        CHECK(u_m.allFinite());
        // the ball moves as one
        CHECK(u_m.maxCoeff() - u_m.minCoeff() < 0.05 * u_m.mean());
        const double beside_N = finger_to_depth(c, finger, {0.025, 0.05}, 1e-3, work).force_N;
        CHECK(on_N > 1.2 * beside_N);
        double last_N = 0.0;
        for (double x_m = 0.025; x_m < 0.06; x_m += 0.5e-3) {
            const FingerPress press = finger_to_depth(c, finger, {x_m, 0.05}, 1e-3, work);
            CHECK(is_finite(press));
            CHECK_FALSE(press.inexact);
            // a sphere meets the stiff ball within one node spacing, five of these steps
            const double most = finger.contact == FingerContact::parabola ? 0.35 : 1.0;
            if (last_N > 0.0) CHECK(std::abs(press.force_N / last_N - 1.0) < most);
            last_N = press.force_N;
        }
    }
}

TEST_CASE("finger: NaN anywhere holds the last answer") {
    const Compliance& c = finger_slab();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    for (const Finger& finger : kFingers) {
        FingerWork work = make_finger_work(c, finger);
        CHECK(finger_to_depth(c, finger, {nan, 0.05}, 1e-3, work).force_N == 0.0);
        const FingerPress good = finger_to_depth(c, finger, {0.05, 0.05}, 1e-3, work);
        CHECK_FALSE(good.held);
        for (const double bad : {nan, inf, -inf}) {
            for (const FingerPress& press : {finger_to_depth(c, finger, {bad, 0.05}, 1e-3, work),
                                             finger_to_depth(c, finger, {0.05, bad}, 1e-3, work),
                                             finger_to_depth(c, finger, {0.05, 0.05}, bad, work),
                                             finger_with_force(c, finger, {0.05, 0.05}, bad, work)}) {
                CHECK(press.held);
                CHECK(press.force_N == good.force_N);
                CHECK(press.depth_m == good.depth_m);
            }
        }
        Eigen::Matrix2Xd points_m = Eigen::Matrix2Xd::Constant(2, 2, nan);
        Eigen::VectorXd u_m(2);
        finger_surface_m(c, work, points_m, u_m);
        CHECK(u_m.isZero());
        CHECK_FALSE(finger_to_depth(c, finger, {0.05, 0.05}, 2e-3, work).held);
    }
}

TEST_CASE("finger: above its limits the answer holds and says so") {
    const Compliance& c = finger_slab();
    for (const Finger& finger : kFingers) {
        CAPTURE(static_cast<int>(finger.contact));
        FingerWork work = make_finger_work(c, finger, {0.8, 0.45});
        const FingerPress at_limit = finger_with_force(c, finger, {0.05, 0.05}, 0.8, work);
        CHECK_FALSE(at_limit.capped);
        for (const double depth_m : {1.1 * at_limit.depth_m, 0.022, 0.049, 10.0}) {
            const FingerPress press = finger_to_depth(c, finger, {0.05, 0.05}, depth_m, work);
            CAPTURE(depth_m);
            CHECK(press.capped);
            CHECK(press.force_N == close_to(0.8).epsilon(1e-6));
            CHECK(press.depth_m == close_to(at_limit.depth_m).epsilon(1e-6));
        }
        CHECK(finger_with_force(c, finger, {0.05, 0.05}, 50.0, work).force_N == close_to(0.8).epsilon(1e-6));
        FingerWork free = make_finger_work(c, finger);
        const FingerPress deep = finger_with_force(c, finger, {0.05, 0.05}, 1e4, free);
        CHECK(deep.capped);
        CHECK(deep.depth_m <= 0.45 * c.thickness_m * (1.0 + 1e-6));
        CHECK(finger_to_depth(c, finger, {0.05, 0.05}, -1.0, work).force_N == 0.0);
    }
}

TEST_CASE("finger: once it has pressed, it allocates nothing") {
    const Compliance& c = finger_slab();
    Eigen::Matrix2Xd points_m = Eigen::Matrix2Xd::Zero(2, 121);
    Eigen::VectorXd u_m(121);
    for (const Finger& finger : kFingers) {
        CAPTURE(static_cast<int>(finger.contact));
        FingerWork work = make_finger_work(c, finger);
        const long before = allocation_count();
        for (int k = 0; k < 40; ++k) {
            const Vector2d place_m(0.03 + 0.001 * k, 0.06 - 0.0007 * k);
            finger_to_depth(c, finger, place_m, 1e-4 * k, work);
            points_m.colwise() = place_m;
            finger_surface_m(c, work, points_m, u_m);
            finger_pressure_Pa(c, work, points_m, u_m);
            finger_with_force(c, finger, place_m, 0.04 * k, work);
        }
        CHECK(allocation_count() == before);
    }
    if (!allocation_count_works()) MESSAGE("allocations are not counted in this build");
}

TEST_CASE("finger: the pressure integrates to the force") {
    const Compliance& c = finger_slab();
    Eigen::Matrix2Xd points_m(2, 81 * 81);
    const double spacing_m = 0.3e-3;
    for (int k = 0; k < points_m.cols(); ++k)
        points_m.col(k) = Vector2d(0.05, 0.05) + Vector2d(k % 81 - 40, k / 81 - 40) * spacing_m;
    Eigen::VectorXd p_Pa(points_m.cols());
    for (const Finger& finger : kFingers) {
        FingerWork work = make_finger_work(c, finger);
        finger_with_force(c, finger, {0.05, 0.05}, 0.5, work);
        finger_pressure_Pa(c, work, points_m, p_Pa);
        CHECK(p_Pa.minCoeff() >= -1e-9 * p_Pa.maxCoeff());
        CHECK(p_Pa.sum() * spacing_m * spacing_m == close_to(0.5).epsilon(0.03));
    }
}

TEST_CASE("finger: wrong fingers are refused with their numbers") {
    const Compliance& c = finger_slab();
    CHECK_THROWS_AS(make_finger_work(c, {FingerContact::parabola, 0.0, {}}), LoadError);
    CHECK_THROWS_AS(make_finger_work(c, pad_finger(-1.0)), LoadError);
    CHECK_THROWS_AS(make_finger_work(c, pad_finger(1.0, -1.0)), LoadError);
    CHECK_THROWS_AS(make_finger_work(c, {}, {0.0, 0.45}), LoadError);
    Compliance scattered = c;
    scattered.position_m(0, 5) += 1e-3;
    CHECK_THROWS_AS(make_finger_work(scattered, {}), LoadError);
}
