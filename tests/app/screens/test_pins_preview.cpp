// Pins that are only drawn, under the touch on the screen.

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "app/screens/pins_preview.h"
#include "tests/close_to.h"
#include "tests/scene/allocations.h"
#include "tests/tactile/tactile_scene.h"

using namespace palpa;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

State touched(double force_N) {
    State state;
    state.touch.p_m = {0.02, 0.02};
    state.touch.force_N = force_N;
    state.touch.down = force_N > 0.0;
    return state;
}

double spread_m(const TactileMoment& moment) {
    const auto n = static_cast<std::size_t>(moment.rows * moment.columns);
    const auto [low, high] =
        std::minmax_element(moment.wanted_m.begin(), moment.wanted_m.begin() + static_cast<int>(n));
    return *high - *low;
}

}  // namespace

TEST_CASE("pins preview: level at rest, a bowl under a press, within the stroke, and held above the limit") {
    const TactileScene slab(R"({"display": {}, "force_limit_N": 1.5})");
    const auto preview = make_pins_preview(slab.scene, slab.plan);
    REQUIRE(preview);
    TactileMoment moment;
    preview_pins(touched(0.0), *preview, moment);
    CHECK(moment.rows == 6);
    CHECK(moment.force_N == 0.0);
    CHECK(spread_m(moment) < 1e-12);
    preview_pins(touched(0.5), *preview, moment);
    CHECK(moment.force_N == close_to(0.5));
    CHECK(moment.depth_m > 1e-4);
    CHECK(moment.wanted_m[0] > moment.wanted_m[14]);  // a corner stands above the middle
    CHECK_FALSE(moment.held);
    preview_pins(touched(1.5), *preview, moment);
    const double at_limit_m = spread_m(moment);
    preview_pins(touched(9.0), *preview, moment);
    CHECK(moment.held);
    CHECK(moment.force_N == close_to(1.5));
    CHECK(spread_m(moment) == at_limit_m);
    for (const double height_m : moment.wanted_m) CHECK((height_m >= 0.0 && height_m <= moment.stroke_m));
}

TEST_CASE("pins preview: a tissue that is twice as stiff bends half as much") {
    const TactileScene soft(R"({"display": {}})");
    Scene stiff = soft.scene;
    stiff.stiffness_scale = 2.0;
    const auto a = make_pins_preview(soft.scene, soft.plan);
    const auto b = make_pins_preview(stiff, soft.plan);
    TactileMoment of_a, of_b;
    preview_pins(touched(0.3), *a, of_a);
    preview_pins(touched(0.3), *b, of_b);
    CHECK(of_b.depth_m == close_to(0.5 * of_a.depth_m));
    CHECK(spread_m(of_b) == close_to(0.5 * spread_m(of_a)).epsilon(1e-6));
}

TEST_CASE("pins preview: a pressure display shows shares of the greatest pressure") {
    const TactileScene slab(R"({"display": {"kind": "pressure"}, "finger": {"contact": "rigid"}})");
    const auto preview = make_pins_preview(slab.scene, slab.plan);
    REQUIRE(preview);
    TactileMoment moment;
    preview_pins(touched(1.0), *preview, moment);
    CHECK(*std::max_element(moment.wanted_m.begin(), moment.wanted_m.end()) == close_to(moment.stroke_m));
    preview_pins(touched(0.0), *preview, moment);
    CHECK(spread_m(moment) == 0.0);
}

TEST_CASE("pins preview: NaN is never drawn, and a frame allocates nothing") {
    const TactileScene slab(R"({"display": {}})");
    const auto preview = make_pins_preview(slab.scene, slab.plan);
    TactileMoment moment;
    preview_pins(touched(0.5), *preview, moment);
    State odd = touched(0.5);
    odd.touch.p_m.x() = std::numeric_limits<double>::quiet_NaN();
    const auto before = allocations();
    preview_pins(touched(0.6), *preview, moment);
    preview_pins(odd, *preview, moment);
    CHECK(allocations() == before);
    for (const double height_m : moment.wanted_m) CHECK(std::isfinite(height_m));
    CHECK(std::isfinite(moment.force_N + moment.depth_m));
}

TEST_CASE("pins preview: scenes without a display have none") {
    const TactileScene arm(R"({"arm": {}})");
    CHECK_FALSE(make_pins_preview(arm.scene, arm.plan));
    Scene plain = arm.scene;
    plain.tactile.reset();
    CHECK_FALSE(make_pins_preview(plain, arm.plan));
}
