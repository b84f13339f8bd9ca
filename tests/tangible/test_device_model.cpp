#include <cmath>
#include <doctest/doctest.h>

#include "tangible/device_checks.h"
#include "tangible/device_model.h"
#include "tests/assets.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;

namespace {

DeviceModel strip_model() { return make_device_model(read_soft_device(test::kAssets / "devices" / "strip.json")); }

DeviceLoad pulled(double tension_N, double finger_N) {
    DeviceLoad load;
    load.actuation[0] = load.actuation[1] = tension_N;
    load.finger = finger_N;
    return load;
}

// Height over the shape at rest, mm.
double height_mm(const DeviceState& state, const ForwardAnswer& answer) {
    return -1e3 * (answer.depth_m + state.rest_depth_m);
}

}  // namespace

TEST_CASE("device model: the heights of the strip under tension and finger") {
    // reference: an independent prototype of the same device, 2026-11; at small tensions, where the device gives way by
    // 3 cm per newton, the two differ by up to 1.2 % and 0.15 mm
    struct Row {
        double tension_N;
        std::array<double, 5> height_mm;  // at 0, 0.1, 0.2, 0.4 and 0.8 N; NaN: none
        double length_mm;
    };
    const double none = std::nan("");
    const DeviceModel model = strip_model();
    const DeviceState rest = rest_state(model);
    for (const Row& row : {Row{0.3, {1.4937, -1.8629, -5.3097, -13.458, none}, 51.07},
                           Row{0.6, {0.8388, -1.1825, -3.1555, -7.2248, -17.358}, 49.31},
                           Row{1.0, {0.4051, -0.9218, -2.2352, -4.8492, -10.385}, 46.91},
                           Row{2.0, {-0.1236, -0.8531, -1.5856, -3.0629, -6.0504}, 40.30},
                           Row{3.5, {-0.5797, -1.0367, -1.4963, -2.4235, -4.3043}, 28.37},
                           Row{5.0, {-0.9883, -1.3221, -1.6572, -2.3322, -3.7001}, 13.94}}) {
        CAPTURE(row.tension_N);
        DeviceState state = rest;
        constexpr std::array<double, 5> kForces_N{0.0, 0.1, 0.2, 0.4, 0.8};
        for (std::size_t k = 0; k < kForces_N.size(); ++k) {
            if (std::isnan(row.height_mm[k])) continue;
            CAPTURE(kForces_N[k]);
            const ForwardAnswer answer = equilibrium(model, state, pulled(row.tension_N, kForces_N[k]));
            REQUIRE(answer.status == DeviceStatus::good);
            const double share = row.tension_N < 1.0 ? 0.012 : 0.0015;
            CHECK(std::abs(height_mm(state, answer) - row.height_mm[k]) < 0.003 + share * std::abs(row.height_mm[k]));
            if (k == 0) CHECK(std::abs(1e3 * answer.length[0] - row.length_mm) < 0.06);
        }
    }
}

TEST_CASE("device model: the finger held at a depth feels the force that leads there") {
    const DeviceModel model = strip_model();
    DeviceState state = rest_state(model);
    equilibrium(model, state, pulled(1.0, 0.0));
    const ForwardAnswer pressed = equilibrium(model, state, pulled(1.0, 0.3));
    const ForwardAnswer held = press_to_depth(model, state, {1.0, 1.0}, pressed.depth_m);
    CHECK(held.force_N == close_to(0.3).epsilon(1e-8));
    DeviceLoad by_length;
    by_length.by_position = {true, true};
    by_length.length = pressed.length;
    by_length.finger = 0.3;
    const ForwardAnswer led = equilibrium(model, state, by_length);
    REQUIRE(led.status == DeviceStatus::good);
    CHECK(led.actuation[0] == close_to(1.0).epsilon(1e-6));
}

TEST_CASE("device model: F > 2 T pulls the strip through, which is a status and no wild shape") {
    const DeviceModel model = strip_model();
    DeviceState state = rest_state(model);
    equilibrium(model, state, pulled(0.3, 0.0));
    const ForwardAnswer answer = equilibrium(model, state, pulled(0.3, 2.0));
    CHECK(answer.status != DeviceStatus::good);
    CHECK(state.u_m.allFinite());
    CHECK(equilibrium(model, state, pulled(1.0, 0.1)).status == DeviceStatus::good);
}

TEST_CASE("device model: equal forces alone leave the strip free to slide, and info says so") {
    files::Json json = files::read_json(test::kAssets / "devices" / "strip.json");
    CHECK(device_warnings(strip_model()).empty());
    json["ties"] = files::Json::parse(R"([{"actuators": ["left", "right"], "force": true}])");
    const DeviceModel untied = make_device_model(parse_soft_device(json, "untied.json", test::kAssets / "devices"));
    const auto warnings = device_warnings(untied);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("slides along x") != std::string::npos);
}

TEST_CASE("device model: one linear tetrahedron through the wall is a warning") {
    const DeviceModel model = make_device_model(read_soft_device(test::kAssets / "devices" / "accordion.json"));
    const auto warnings = device_warnings(model);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("1 linear tetrahedron") != std::string::npos);
    CHECK(device_warnings(make_device_model(read_soft_device(test::kAssets / "devices" / "bellows.json"))).empty());
}

TEST_CASE("device model: the strip weighs 0.08 N, and as little as that moves it when it is simulated") {
    const DeviceModel model = strip_model();
    CHECK(weight_N(model) == close_to(0.0839).epsilon(0.01));
    files::Json json = files::read_json(test::kAssets / "devices" / "strip.json");
    json["gravity_m_per_s2"] = {0.0, 0.0, -9.80665};
    const DeviceModel heavy = make_device_model(parse_soft_device(json, "heavy.json", test::kAssets / "devices"));
    CHECK(heavy.weight_N.sum() == close_to(-weight_N(model)).epsilon(1e-9));
    DeviceState light_state = rest_state(model);
    DeviceState heavy_state = rest_state(heavy);
    const double sunk_m = equilibrium(heavy, heavy_state, pulled(1.0, 0.0)).depth_m + heavy_state.rest_depth_m -
                          equilibrium(model, light_state, pulled(1.0, 0.0)).depth_m - light_state.rest_depth_m;
    CHECK(sunk_m > 1e-5);
    CHECK(sunk_m < 1e-3);
}

TEST_CASE("device model: unequal cables tilt the bellows' top and stay within its model") {
    const DeviceModel model = make_device_model(read_soft_device(test::kAssets / "devices" / "bellows.json"));
    DeviceState state = rest_state(model);
    DeviceLoad load;
    load.actuation[0] = 0.02;
    const ForwardAnswer answer = equilibrium(model, state, load);
    REQUIRE(answer.status == DeviceStatus::good);
    CHECK(answer.tilt[0] < -0.001);  // down towards the pulled side, +x
    CHECK(std::abs(answer.tilt[1]) < 0.02 * std::abs(answer.tilt[0]));
    load.actuation[0] = std::nan("");
    CHECK(equilibrium(model, state, load).status == DeviceStatus::bad_input);
}
