#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

#include "mechanics/button.h"
#include "mechanics/error.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"

using namespace palpa::mechanics;
using namespace palpa::test;
using palpa::test::close_to;

namespace {

constexpr double kE_Pa = 2e6, kThick_m = 1e-3;
const TrussSupport kTruss{1000.0, 5e-3, 2e-3};

ButtonCover small_cover(int spacings) {
    return {6e-3, 2.5e-3, kThick_m, kE_Pa, 1100.0, spacings, Eigen::Vector3d::Zero()};
}

Button truss_button(double travel_m) {
    Button out;
    out.support = kTruss;
    out.travel_m = travel_m;
    return out;
}

// A latch under a cover: 500 N/m that let go at 0.6 N.
Button latched() {
    Button out;
    out.cover = small_cover(8);
    out.support = LatchSupport{500.0, 0.6};
    out.travel_m = 3e-3;
    return out;
}

// A truss under a cover that brings it back by itself.
Button snapping() {
    Button out = latched();
    out.support = TrussSupport{20000.0, 5e-3, 2e-3};
    out.cover->thickness_m = 0.26e-3;
    out.travel_m = 4e-3;
    return out;
}

Button measured(std::vector<double> press_N, std::vector<double> release_N) {
    Button out;
    MeasuredSupport support{{}, std::move(press_N), std::move(release_N)};
    for (std::size_t i = 0; i < support.press_N.size(); ++i) support.travel_m.push_back(1e-3 * static_cast<double>(i));
    out.travel_m = support.travel_m.back();
    out.support = support;
    return out;
}

}  // namespace

TEST_CASE("button: a stop before the trough leaves no trough, and nothing that goes on there") {
    const ButtonCurve curve = press_button(truss_button(1.5e-3));
    CHECK(curve.snaps);
    CHECK(curve.peak_N == close_to(0.114218831724).epsilon(1e-10));
    CHECK(std::isnan(curve.trough_m));
    CHECK(std::isnan(curve.trough_N));
    CHECK_FALSE(curve.on_m);
    CHECK_FALSE(curve.off_m);
}

TEST_CASE("button: a measured curve snaps where it falls most, whatever its noise; noise alone is no snap") {
    constexpr int kRows = 151;
    constexpr unsigned kSeed = 5;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::normal_distribution<double> noise_N(0.0, 0.005);
    MeasuredSupport dome, spring;
    for (int i = 0; i < kRows; ++i) {
        const double w_mm = 0.02 * i;  // up to 0.6 N at 1.4 mm, down to 0.3 N at 2.2 mm, up to 1.1 N
        const double dome_N = w_mm < 1.4   ? 0.6 * w_mm / 1.4
                              : w_mm < 2.2 ? 0.6 - 0.375 * (w_mm - 1.4)
                                           : 0.3 + (w_mm - 2.2);
        for (auto& [support, press_N] : {std::pair<MeasuredSupport&, double>{dome, dome_N}, {spring, 0.3 * w_mm}}) {
            support.travel_m.push_back(1e-3 * w_mm);
            support.press_N.push_back(i == 0 ? 0.0 : press_N + noise_N(random));
            support.release_N.push_back(i == 0 ? 0.0 : press_N - 0.05);
        }
    }
    Button button;
    button.travel_m = 3e-3;
    button.support = dome;
    const ButtonCurve curve = press_button(button);
    REQUIRE(curve.snaps);
    CHECK(1e3 * curve.peak_m == close_to(1.4).epsilon(0.05));
    CHECK(curve.peak_N == close_to(0.6).epsilon(0.03));
    CHECK(1e3 * curve.trough_m == close_to(2.2).epsilon(0.05));
    CHECK(curve.trough_N == close_to(0.3).epsilon(0.06));
    button.support = spring;
    CHECK_FALSE(press_button(button).snaps);
}

TEST_CASE("button: the two-bar truss snaps at the closed form's force and travel, to 1e-9") {
    const ButtonCurve curve = press_button(truss_button(4e-3));
    REQUIRE(curve.snaps);
    CHECK(std::abs(curve.peak_N / 0.114218831724 - 1.0) < 1e-10);
    CHECK(std::abs(curve.peak_m / 0.873971864266e-3 - 1.0) < 1e-9);
    CHECK(curve.trough_N == close_to(-0.114218831724).epsilon(1e-10));
    CHECK(curve.trough_m == close_to(3.1260281357e-3).epsilon(1e-9));
    CHECK(std::abs(curve.loss_J) < 1e-15);  // elastic: by travel nothing is lost
    for (const double w : {1e-5, 0.5e-3, 1.7e-3, 3.3e-3}) {
        const double h = 1e-8;
        CHECK(truss_slope_N_per_m(kTruss, w) ==
              close_to((truss_force_N(kTruss, w + h) - truss_force_N(kTruss, w - h)) / (2.0 * h)).epsilon(1e-6));
    }
}

TEST_CASE(
    "button: the cover's net has the membrane's force at small travel, 24 spacings to 0.5 %, and falls below it") {
    const ButtonCover cover = small_cover(24);
    const CoverNet net = make_net(cover);
    CHECK(net.n_free == 1710);  // 1,722 with those that stand on the circles
    CHECK(membrane_force_N(cover, 0.06e-3) == close_to(1.453894e-4).epsilon(1e-6));
    struct Row {
        double travel, share;
    };
    for (const Row& row :
         {Row{0.01, 0.9995}, Row{0.02, 0.9989}, Row{0.05, 0.9950}, Row{0.1, 0.9813}, Row{0.2, 0.9306}}) {
        const double w = row.travel * cover.radius_m;
        const CoverState state = press_cover(net, w);
        CAPTURE(row.travel);
        CHECK(state.converged);
        CHECK(state.force_N / membrane_force_N(cover, w) == close_to(row.share).epsilon(2e-4));
    }
}

TEST_CASE("button: the cover's force is the slope of its energy, and its own slope is right") {
    ButtonCover cover = small_cover(10);
    for (const Eigen::Vector3d& gravity :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 9.81), Eigen::Vector3d(3, 0, -9)}) {
        cover.gravity_m_per_s2 = gravity;
        const CoverNet net = make_net(cover);
        for (const double w : {0.3e-3, 1.5e-3}) {
            const double h = 1e-4 * w;
            const CoverState here = press_cover(net, w), less = press_cover(net, w - h), more = press_cover(net, w + h);
            REQUIRE(here.converged);
            CHECK(here.force_N == close_to((more.energy_J - less.energy_J) / (2.0 * h)).epsilon(1e-7));
            CHECK(here.slope_N_per_m == close_to((more.force_N - less.force_N) / (2.0 * h)).epsilon(1e-6));
            // at nodes that are not in equilibrium, too
            const Eigen::Matrix3Xd u = here.u_m + 1e-5 * Eigen::Matrix3Xd::Random(3, net.n_free);
            const double less_J = cover_energy_J(net, u, w - 0.1 * h), more_J = cover_energy_J(net, u, w + 0.1 * h);
            const double slope = (more_J - less_J) / (0.2 * h);
            CHECK(cover_force_N(net, u, w) == close_to(slope).epsilon(1e-6));
        }
    }
}

TEST_CASE("button: gravity along the travel helps to press, against it hinders, by the weight that moves") {
    ButtonCover cover = small_cover(10);
    cover.density_kg_per_m3 = 1e5;  // so that it shows
    const double plain_N = press_cover(make_net(cover), 1e-3).force_N;
    cover.gravity_m_per_s2.z() = 9.81;
    const CoverState down = press_cover(make_net(cover), 1e-3);
    cover.gravity_m_per_s2.z() = -9.81;
    const CoverState up = press_cover(make_net(cover), 1e-3);
    REQUIRE((down.converged && up.converged));
    CHECK(down.force_N < plain_N);
    CHECK(up.force_N > plain_N);
}

TEST_CASE("button: a flat net without gravity bears nothing and asks no solver; under its own weight it sags") {
    const CoverState flat = press_cover(make_net(small_cover(10)), 0.0);
    CHECK(flat.converged);
    CHECK(flat.force_N == 0.0);
    CHECK(flat.iterations == 0);
    ButtonCover heavy = small_cover(10);
    heavy.gravity_m_per_s2.z() = 9.81;
    const CoverState sags = press_cover(make_net(heavy), 0.0);
    CHECK(sags.converged);
    CHECK(sags.u_m.row(2).maxCoeff() > 0.0);
    CHECK(sags.force_N < 0.0);  // the cap must be held up
    heavy.young_Pa = 2e9;       // energies that round-off nearly hides
    CHECK(press_cover(make_net(heavy), 0.0).converged);
}

TEST_CASE("button: a latch lets go at its threshold once, and holds again before it") {
    const ButtonCurve curve = press_button(latched());
    REQUIRE(curve.on_m);
    CHECK(curve.peak_N == close_to(0.6).epsilon(1e-9));
    CHECK(curve.trough_N == close_to(0.6 - 500.0 * *curve.on_m).epsilon(1e-6));
    CHECK(*curve.off_m < *curve.on_m);
    CHECK(curve.loss_J > 0.0);
    ButtonState state;
    for (const double force_N : {0.3, 0.59, 0.7}) move_button(curve, force_N, state);
    CHECK(state.on);
    CHECK(state.travel_m > *curve.on_m);
    CHECK(press_force_N(curve, true, state.travel_m) == close_to(0.7).epsilon(1e-6));
    move_button(curve, 0.0, state);
    CHECK_FALSE(state.on);
    CHECK(state.travel_m < 1e-9);
    CHECK(state.switched == 1);
}

TEST_CASE("button: a force that rests at the peak with noise switches once per press, over 1e5 frames") {
    for (const Button& button : {latched(), snapping()}) {
        const ButtonCurve curve = press_button(button);
        REQUIRE(curve.on_m);
        CAPTURE(curve.peak_N);
        std::mt19937 random(7);  // seed 7
        std::normal_distribution<double> noise(0.0, 0.02 * curve.peak_N);
        ButtonState state;
        for (int press = 1; press <= 3; ++press) {
            for (int frame = 0; frame < 100000; ++frame) move_button(curve, curve.peak_N + noise(random), state);
            CHECK(state.switched == press);
            move_button(curve, 0.0, state);
            CHECK_FALSE(state.on);
        }
    }
}

TEST_CASE("button: a release inside the snap goes back to rest, or on to the stop, never to a force it does not bear") {
    const ButtonCurve curve = press_button(snapping());
    REQUIRE(curve.snaps);
    REQUIRE(curve.trough_N > 0.0);
    const double between_N = 0.5 * (curve.peak_N + curve.trough_N);
    ButtonState before, after;
    move_button(curve, between_N, before);
    move_button(curve, 1.01 * curve.peak_N, after);
    move_button(curve, between_N, after);
    CHECK(before.travel_m < curve.peak_m);
    CHECK(after.travel_m > curve.trough_m);
    for (const ButtonState& state : {before, after})
        CHECK(press_force_N(curve, state.on, state.travel_m) == close_to(between_N).epsilon(1e-6));
    move_button(curve, 0.99 * curve.trough_N, after);
    CHECK(after.travel_m < curve.peak_m);
    CHECK_FALSE(after.on);
}

TEST_CASE("button: a closed cycle of any forces makes no energy") {
    std::mt19937 random(11);  // seed 11
    std::uniform_real_distribution<double> force(0.0, 1.0);
    for (const Button& button : {latched(), snapping(), measured({0, 0.5, 0.3, 0.9}, {0, 0.3, 0.2, 0.8})}) {
        const ButtonCurve curve = press_button(button);
        CHECK(curve.loss_J >= -1e-15);
        ButtonState state;
        double work_J = 0.0, before_m = 0.0;
        for (int i = 0; i < 20000; ++i) {
            // what the finger gives: the force that it holds times the way, which is at most what the button takes
            const double force_N = i == 19999 ? 0.0 : force(random);
            move_button(curve, force_N, state);
            work_J += force_N * (state.travel_m - before_m);
            before_m = state.travel_m;
        }
        CHECK(state.travel_m == close_to(0.0));
        CHECK(work_J >= 0.0);
    }
}

TEST_CASE("button: forces that are not numbers change nothing; large ones stop at the end; nothing allocates") {
    const ButtonCurve curve = press_button(latched());
    ButtonState state;
    move_button(curve, 0.4, state);
    const double travel_m = state.travel_m;
    const long before = allocation_count();
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        move_button(curve, bad, state);
    CHECK(state.travel_m == travel_m);
    move_button(curve, 1e9, state);
    CHECK(state.stopped);
    CHECK(state.travel_m == curve.travel_m);
    CHECK(allocation_count() == before);
}

TEST_CASE(
    "button: wrong buttons are refused: off after on, a cap not smaller, curves that make energy, nothing at all") {
    Button late = latched();
    late.off_m = 2.9e-3;
    CHECK_THROWS_WITH_AS(press_button(late), doctest::Contains("goes off before"), LoadError);
    Button wide = latched();
    wide.cover->cap_radius_m = 6e-3;
    CHECK_THROWS_WITH_AS(press_button(wide), doctest::Contains("the cap must be smaller"), MeshError);
    CHECK_THROWS_WITH_AS(press_button(measured({0, 0.5}, {0, 0.6})), doctest::Contains("make energy"), LoadError);
    CHECK_THROWS_AS(press_button(measured({0, std::nan("")}, {0, 0.0})), LoadError);
    CHECK_THROWS_AS(press_button(measured({0}, {0})), LoadError);
    Button nothing;
    nothing.travel_m = 1e-3;
    CHECK_THROWS_AS(press_button(nothing), LoadError);
    Button high = latched();
    std::get<LatchSupport>(high.support).threshold_N = 50.0;
    CHECK_THROWS_WITH_AS(press_button(high), doctest::Contains("not reached"), LoadError);
}

TEST_CASE("button cover: equilibria along a path are those of single travels") {
    ButtonCover cover = small_cover(10);
    cover.gravity_m_per_s2 = {0.0, 0.0, 9.80665};
    const CoverNet net = make_net(cover);
    const std::vector<double> travels_m{0.0, 0.5e-3, 1e-3, 1.5e-3, 2e-3, 2.5e-3};
    int alone = 0, path = 0;
    const std::vector<CoverState> states = press_cover(net, travels_m);
    REQUIRE(states.size() == travels_m.size());
    for (std::size_t i = 0; i < travels_m.size(); ++i) {
        CAPTURE(i);
        const CoverState single = press_cover(net, travels_m[i]);
        CHECK(states[i].converged);
        CHECK(states[i].force_N == close_to(single.force_N).epsilon(1e-8));
        CHECK(states[i].slope_N_per_m == close_to(single.slope_N_per_m).epsilon(1e-6));
        alone += single.iterations;
        path += states[i].iterations;
    }
    CHECK(path < alone);
}
