#include <cmath>
#include <doctest/doctest.h>

#include "files/json.h"
#include "tangible/inverse.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;

namespace {

struct ReadyDevice {
    DeviceModel model;
    DeviceState state;
};

ReadyDevice ready(const char* file, double stiffness_N_per_m, [[maybe_unused]] bool whole = false) {
    ReadyDevice out;
    const std::filesystem::path path = test::kAssets / "devices" / file;
    files::Json json = files::read_json(path);
#ifdef __SANITIZE_ADDRESS__  // which takes seven times as long: fewer cells
    if (!whole && json["mesh"].contains("box")) json["mesh"]["box"]["elements"] = {50, 2, 2};
    if (json["mesh"].contains("bellows")) json["mesh"]["bellows"].update({{"sectors", 8}, {"along", 11}});
#endif
    out.model = make_device_model(parse_soft_device(json, path.string(), path.parent_path()));
    out.state = rest_state(out.model);
    prepare_press(out.model, out.state, stiffness_N_per_m * out.model.device.depth_floor_m);
    return out;
}

double press_depth_m(int tick, int ticks) {
    const double there = 2.0 * tick / ticks;
    const double t = there <= 1.0 ? there : 2.0 - there;
    return 6e-3 * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
}

// Root mean square of plant minus wanted force over a press of 6 mm, against the greatest wanted one, %.
double press_error_percent(ReadyDevice& device, double stiffness_N_per_m, Fidelity fidelity,
                           double* most_change = nullptr) {
    DeviceState plant = device.state;
    double sum = 0.0;
    constexpr int kTicks = 240;
    for (int tick = 0; tick <= kTicks; ++tick) {
        const double depth_m = press_depth_m(tick, kTicks);
        const double before = device.state.actuation[0];
        InverseOptions options;
        options.fidelity = fidelity;
        const InverseAnswer answer =
            inverse_step(device.model, device.state, {depth_m, stiffness_N_per_m * depth_m, {}}, options);
        if (most_change != nullptr && depth_m < 2e-3)
            *most_change = std::max(*most_change, std::abs(answer.actuation[0] - before));
        const double error_N =
            press_to_depth(device.model, plant, answer.actuation, depth_m).force_N - stiffness_N_per_m * depth_m;
        sum += error_N * error_N;
    }
    return 100.0 * std::sqrt(sum / (kTicks + 1)) / (stiffness_N_per_m * 6e-3);
}

}  // namespace

TEST_CASE("inverse: a press on the strip renders a factor of 10 in stiffness, with small changes at small depths") {
    for (const double stiffness_N_per_m : {30.0, 300.0}) {
        CAPTURE(stiffness_N_per_m);
        ReadyDevice strip = ready("strip.json", stiffness_N_per_m, true);
        double most_change_N = 0.0;
        CHECK(press_error_percent(strip, stiffness_N_per_m, Fidelity::step, &most_change_N) < 0.5);
        CHECK(most_change_N < 0.1);
    }
}

TEST_CASE("inverse: a press on the accordion, whose cables and cavity share the work") {
    ReadyDevice accordion = ready("accordion.json", 100.0);
    CHECK(press_error_percent(accordion, 100.0, Fidelity::step) < 0.5);
}

TEST_CASE("inverse: the stale factor renders within 1 % of converged") {
    ReadyDevice strip = ready("strip.json", 100.0);
    CHECK(press_error_percent(strip, 100.0, Fidelity::stale) < 1.0);
    ReadyDevice accordion = ready("accordion.json", 100.0);
    CHECK(press_error_percent(accordion, 100.0, Fidelity::stale) < 1.0);
}

TEST_CASE("inverse: the stale factor follows W through its change of sign, from the pretension to 3 mm") {
    ReadyDevice device = ready("strip.json", 100.0);
    InverseOptions options;
    options.fidelity = Fidelity::stale;
    options.slew = false;
    InverseAnswer answer;
    for (int tick = 1; tick <= 60; ++tick)
        answer = inverse_step(device.model, device.state, {5e-5 * tick, 5e-3 * tick, {}}, options);
    CHECK(answer.status == DeviceStatus::good);
    CHECK(std::abs(answer.residual_m) < 1e-6);
    CHECK(press_to_depth(device.model, device.state, answer.actuation, 3e-3).force_N == close_to(0.3).epsilon(0.01));
}

TEST_CASE("inverse: step, repeated at held input, reaches converged to 1e-8") {
    for (const char* file : {"strip.json", "accordion.json"}) {
        CAPTURE(file);
        ReadyDevice device = ready(file, 100.0);
        InverseOptions options;
        // where actuators oppose one another the rate term makes them creep to their place
        options.rate_term = device.model.device.pretension.has_value();
        for (int tick = 1; tick <= 40; ++tick) {
            options.fidelity = Fidelity::step;
            inverse_step(device.model, device.state, {1e-4 * tick, 1e-2 * tick, {}}, options);
        }
        DeviceState other = device.state;
        for (int i = 0; i < 60; ++i) inverse_step(device.model, device.state, {4e-3, 0.4, {}}, options);
        options.fidelity = Fidelity::converged;
        for (int i = 0; i < 20; ++i) inverse_step(device.model, other, {4e-3, 0.4, {}}, options);
        CHECK((device.state.u_m - other.u_m).norm() < 1e-8 * other.u_m.norm());
        for (int j = 0; j < device.model.n_actuators(); ++j) {
            const auto at = static_cast<std::size_t>(j);
            const double range = device.model.actuators[at].upper;
            CHECK(std::abs(device.state.actuation[at] - other.actuation[at]) < 1e-8 * range);
        }
    }
}

TEST_CASE("inverse: W is the slope of converged states over 25 tensions") {
    ReadyDevice strip = ready("strip.json", 100.0);
    DeviceLoad load;
    load.finger = 0.2;
    double worst = 0.0;
    double greatest = 0.0;
    for (int i = 0; i < 25; ++i) {
        const double tension_N = 1.0 + i / 24.0;
        constexpr double kStep_N = 1e-3;
        std::array<double, 2> depth_m{};
        for (std::size_t side = 0; side < 2; ++side) {
            load.actuation[0] = load.actuation[1] = tension_N + (side == 0 ? -kStep_N : kStep_N);
            depth_m[side] = equilibrium(strip.model, strip.state, load).depth_m;
        }
        load.actuation[0] = load.actuation[1] = tension_N;
        const ForwardAnswer here = equilibrium(strip.model, strip.state, load);
        const double slope = (depth_m[1] - depth_m[0]) / (2.0 * kStep_N);
        DeviceState copy = strip.state;
        const InverseAnswer answer = inverse_step(strip.model, copy, {here.depth_m + 1e-3, 0.2, {}}, {});
        const double W = answer.W(0, 0) + answer.W(0, 1);
        worst = std::max(worst, std::abs(W - slope));
        greatest = std::max(greatest, std::abs(slope));
        CHECK(W < 0.0);  // no saw-tooth through 0
    }
    CHECK(worst < 0.05 * greatest);
}

TEST_CASE("inverse: out of reach ends at a limit, by name, and within the limits; what is no number changes nothing") {
    ReadyDevice strip = ready("strip.json", 100.0);
    for (int tick = 0; tick < 200; ++tick) {
        const InverseAnswer answer = inverse_step(strip.model, strip.state, {2e-3, 5.0, {}}, {});
        for (std::size_t j = 0; j < 2; ++j) {
            REQUIRE(std::isfinite(answer.actuation[j]));
            CHECK(answer.actuation[j] >= 0.25);
            CHECK(answer.actuation[j] <= 5.5);
        }
    }
    ReadyDevice other = ready("strip.json", 100.0);
    InverseAnswer answer;
    for (int tick = 0; tick < 100; ++tick)
        answer = inverse_step(other.model, other.state, {3e-3, 1.2 * std::min(1.0, tick / 50.0), {}}, {});
    CHECK(answer.limited_by == 0);
    CHECK_FALSE(answer.rate_limited);
    ReadyDevice sudden = ready("strip.json", 100.0);
    const InverseAnswer first = inverse_step(sudden.model, sudden.state, {3e-3, 0.0, {}}, {});
    CHECK(first.rate_limited);  // on its way is not out of reach
    CHECK(first.limited_by == -1);
    CHECK(answer.actuation[0] == close_to(5.5));
    const Actuation before = other.state.actuation;
    answer = inverse_step(other.model, other.state, {std::nan(""), 0.1, {}}, {});
    CHECK(answer.status == DeviceStatus::bad_input);
    CHECK(answer.actuation == before);
}

TEST_CASE("inverse: tilt of the bellows' top follows what is wanted") {
    ReadyDevice bellows = ready("bellows.json", 60.0);
    InverseAnswer answer;
    for (int tick = 1; tick <= 80; ++tick) {
        const double share = std::min(1.0, tick / 60.0);
        answer =
            inverse_step(bellows.model, bellows.state, {4e-3 * share, 0.2 * share, {0.02 * share, -0.01 * share}}, {});
    }
    CHECK(answer.rank == 3);
    CHECK(std::abs(answer.residual_m) < 1e-6);
    CHECK(std::abs(answer.tilt_residual[0]) < 1e-4);
    CHECK(std::abs(answer.tilt_residual[1]) < 1e-4);
}

TEST_CASE("inverse: a tick of any fidelity allocates nothing") {
    ReadyDevice strip = ready("strip.json", 100.0);
    for (const Fidelity fidelity : {Fidelity::step, Fidelity::converged, Fidelity::stale, Fidelity::linear}) {
        CAPTURE(static_cast<int>(fidelity));
        InverseOptions options;
        options.fidelity = fidelity;
        inverse_step(strip.model, strip.state, {1e-3, 0.1, {}}, options);
        const long before = allocation_count();
        for (int tick = 0; tick < 5; ++tick)
            inverse_step(strip.model, strip.state, {1e-3 + 1e-5 * tick, 0.1, {}}, options);
        CHECK(allocation_count() == before);
    }
}
