#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "tangible/run_figures.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"
#include "tests/tangible/small_strip.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;

namespace {

struct SmallLoop {
    SmallLoop()
        : plan(make_tangible_plan(small_strip(), known.world, {0.0, 0.0}, {})), state(make_tangible_state(plan)) {}

    TangibleCommand tick(double time_s, double depth_m, double sensor_s, bool stopped = false) {
        TangibleInput in;
        in.time_s = time_s;
        in.feedback = {depth_m, sensor_s, 1.0, stopped ? 1.0 : 0.0};
        return tangible_tick(plan, in, state);
    }
    TangibleCommand tick(double time_s, double depth_m) { return tick(time_s, depth_m, time_s); }

    bool within_limits(const TangibleCommand& command) const {
        for (std::size_t j = 0; j < plan.model->actuators.size(); ++j) {
            const SoftActuator& actuator = plan.model->actuators[j];
            if (!(command.actuation[j] >= actuator.lower - 1e-12 && command.actuation[j] <= actuator.upper + 1e-12))
                return false;
        }
        return true;
    }

    KnownTissue known{0.1};
    TangiblePlan plan;
    TangibleState state;
};

}  // namespace

TEST_CASE("loop: real drives are told what their wires say, and a command that one cannot take is refused") {
    const auto wired = [](devices::Drive drive, CommandKind command) {
        auto model = std::make_shared<DeviceModel>(*small_strip());
        REQUIRE(model->device.wires);
        for (devices::RigChannel& channel : model->device.wires->channels) channel.drive = drive;
        TangiblePlan plan;
        plan.model = model;
        plan.loop.command = command;
        return plan;
    };
    using devices::Drive;
    TangiblePlan lengths = wired(Drive::length, CommandKind::force);
    command_as_wired(false, lengths);
    CHECK(lengths.loop.command == CommandKind::position);
    TangiblePlan both = wired(Drive::length, CommandKind::force);
    auto model = std::make_shared<DeviceModel>(*both.model);
    model->device.wires->channels.front().drive = Drive::force;
    both.model = model;
    command_as_wired(false, both);
    CHECK(name_of(both.loop.command) == "mixed");
    CHECK_THROWS_WITH(command_as_wired(true, std::ref(lengths = wired(Drive::length, CommandKind::force))),
                      doctest::Contains("left.drive: found length, expected force"));
    for (const bool asked : {false, true}) {
        TangiblePlan forces = wired(Drive::force, CommandKind::position);
        CHECK_THROWS_WITH(command_as_wired(asked, forces),
                          doctest::Contains("left.drive: found force, expected length"));
        forces = wired(Drive::force, CommandKind::force);
        command_as_wired(asked, forces);
        CHECK(forces.loop.command == CommandKind::force);
    }
}

TEST_CASE("tangible loop: a press on the exact plant renders the wanted force") {
    for (const double stiffness : {0.1, 0.2}) {
        const PressFigures figures = press_small(stiffness, small_plant());
        CHECK(figures.force_rms_percent < 0.5);
        CHECK(figures.rendered_N_per_m == close_to(1e3 * stiffness).epsilon(0.01));
        CHECK(figures.failed_ticks == 0);
    }
}

TEST_CASE("tangible loop: by position the exact plant renders it too") {
    LoopOptions loop;
    loop.command = CommandKind::position;
    CHECK(press_small(0.1, small_plant(), loop).force_rms_percent < 1.0);
}

TEST_CASE("tangible loop: a tick allocates nothing") {
    if (!allocation_count_works()) return;
    SmallLoop loop;
    for (int k = 0; k < 5; ++k) loop.tick(0.01 * k, 1e-4 * k);
    const long before = allocation_count();
    for (int k = 5; k < 20; ++k) loop.tick(0.01 * k, 1e-4 * k);
    CHECK(allocation_count() == before);
}

TEST_CASE("tangible loop: on failure the last valid command for 100 ms, then relaxed until the finger is lifted") {
    SmallLoop loop;
    TangibleCommand last;
    for (int k = 0; k <= 20; ++k) last = loop.tick(0.01 * k, 1e-4 * k);
    REQUIRE(last.fault == TickFault::none);
    double time_s = 0.21;
    for (; time_s < 0.305; time_s += 0.01) {
        const TangibleCommand held = loop.tick(time_s, NAN);
        CHECK(held.fault == TickFault::bad_input);
        CHECK(held.held);
        CHECK(held.actuation == last.actuation);
    }
    const TangibleCommand rest = loop.tick(0.31, NAN);
    CHECK(rest.relaxed);
    CHECK(rest.actuation == loop.plan.relaxed);
    CHECK(loop.tick(0.34, 2e-3).relaxed);  // the finger is still on it
    CHECK(loop.tick(0.35, 0.0).fault == TickFault::none);
    CHECK_FALSE(loop.tick(0.36, 1e-4).relaxed);
}

TEST_CASE("tangible loop: a silent sensor and a stop") {
    SmallLoop loop;
    for (int k = 0; k <= 10; ++k) loop.tick(0.01 * k, 1e-4 * k);
    CHECK(loop.tick(0.15, 1e-3, 0.10).fault == TickFault::none);
    CHECK(loop.tick(0.25, 1e-3, 0.10).fault == TickFault::no_sensor);
    CHECK(loop.tick(0.36, 1e-3, 0.10).relaxed);
    SmallLoop stopped;
    for (int k = 0; k <= 10; ++k) stopped.tick(0.01 * k, 1e-4 * k);
    const TangibleCommand command = stopped.tick(0.11, 1e-3, 0.11, true);
    CHECK(command.fault == TickFault::stopped);
    CHECK(command.relaxed);  // at once
}

TEST_CASE("tangible loop: wild readings never leave the limits, and nothing is not a number") {
    SmallLoop loop;
    std::mt19937 random(11);
    MESSAGE("seed 11");
    std::uniform_real_distribution<double> anywhere(-5e-3, 15e-3);
    for (int k = 0; k < 120; ++k) {
        const TangibleCommand command = loop.tick(0.01 * k, k % 17 == 0 ? std::nan("") : anywhere(random));
        CHECK(loop.within_limits(command));
        bool finite = true;
        visit_fields(command, [&](const char*, const double& value) { finite = finite && std::isfinite(value); });
        CHECK(finite);
    }
}

TEST_CASE("tangible loop: the drives go no faster than the scene's share of their rates") {
    const auto fastest = [](double share) {
        SmallLoop loop;
        loop.plan.loop.inverse.rate_share = share;
        double most_N = 0.0, before_N = loop.tick(0.0, 0.0).actuation[0];
        for (int k = 1; k < 20; ++k) {
            const double now_N = loop.tick(0.01 * k, 3e-3 * (k % 2)).actuation[0];
            most_N = std::max(most_N, std::abs(now_N - before_N));
            before_N = now_N;
        }
        return most_N;
    };
    const double rate_N_per_tick = 0.01 * small_strip()->actuators[0].rate_per_s;
    CHECK(fastest(1.0) > 0.2 * rate_N_per_tick);
    CHECK(fastest(0.1) <= 0.1 * rate_N_per_tick + 1e-12);
}

TEST_CASE("tangible loop: for a slow sensor the finger is extrapolated") {
    PlantOptions slow = small_plant();
    slow.sensor.rate_Hz = 25.0;
    LoopOptions without;
    without.predict = false;
    const double behind = press_small(0.02, slow, without, 0.0, 3.0).force_rms_percent;
    const double ahead = press_small(0.02, slow, {}, 0.0, 3.0).force_rms_percent;
    CHECK(behind > 0.5);  // a straight line hardly shows it: its tension hardly changes
    CHECK(ahead < 0.5 * behind);
}

TEST_CASE("run figures: ticks in which nobody presses do not dilute the error of the force") {
    tangible::TickFigures figures;
    tangible::TangibleCommand tick;
    tick.pressed = true;
    tick.wanted_N = 1.0;
    add(tick, 1.1, figures);
    CHECK(force_rms_percent(figures) == close_to(10.0));
    tick.pressed = false;
    tick.wanted_N = 0.0;
    for (int i = 0; i < 100; ++i) add(tick, 0.0, figures);
    CHECK(force_rms_percent(figures) == close_to(10.0));
    CHECK(figures.ticks == 101);
}
