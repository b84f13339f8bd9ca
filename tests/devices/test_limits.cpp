// The guard between every loop and the wire.

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

#include "devices/limits.h"
#include "tests/close_to.h"
#include "tests/scene/allocations.h"

using namespace palpa::devices;
using namespace palpa::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

ArmCommand force_of(double force_N, double feedforward_N = 0.0) {
    return {force_N, feedforward_N, 0.0, static_cast<double>(ArmMode::force)};
}

// One tick of 1 ms with feedback; what passes of the command.
ArmCommand one_tick(const Limits& limits, double now_s, ArmCommand command, Guard& guard, bool fresh = true) {
    ArmFeedback in;
    begin_tick(limits, now_s, fresh, &in, guard);
    guard_arm(limits, command, guard);
    return command;
}

// A guard that has run for a while and lets the command through.
Guard settled(const Limits& limits, const ArmCommand& command, double& now_s) {
    Guard guard;
    for (int i = 0; i < 100; ++i) one_tick(limits, now_s += 1e-3, command, guard);
    REQUIRE(guard.fault == Fault::none);
    return guard;
}

}  // namespace

TEST_CASE("guard: a command in range passes as it is, one beyond it is cut off") {
    const Limits limits;
    double now_s = 0.0;
    Guard guard = settled(limits, force_of(1.0, -3.0), now_s);
    CHECK(guard.force_N == 1.0);
    CHECK(guard.feedforward_N == -3.0);
    CHECK(one_tick(limits, now_s += 1e-3, force_of(1.0, -3.0), guard).force_N == 1.0);
    for (int i = 0; i < 100; ++i) one_tick(limits, now_s += 1e-3, force_of(99.0, 99.0), guard);
    CHECK(guard.force_N == limits.force_N);
    CHECK(guard.feedforward_N == limits.feedforward_N);
    for (int i = 0; i < 100; ++i) one_tick(limits, now_s += 1e-3, force_of(-1.0), guard);
    CHECK(guard.force_N == 0.0);  // never along the press
    CHECK(guard.limited > 0);
}

TEST_CASE("guard: nothing changes faster than its slew, also after a pause of the loop") {
    const Limits limits;
    double now_s = 0.0;
    Guard guard = settled(limits, force_of(0.0), now_s);
    CHECK(one_tick(limits, now_s += 1e-3, force_of(2.5), guard).force_N == close_to(1.0));
    Guard paused = settled(limits, force_of(0.0), now_s);
    Limits slow;
    slow.force_slew_N_per_s = 10.0;
    CHECK(one_tick(slow, now_s + 0.09, force_of(2.5), paused).force_N <= 0.2 + 1e-9);
}

TEST_CASE("guard: NaN anywhere makes all rest, for good") {
    const Limits limits;
    for (const double bad : {kNan, kInf, -kInf}) {
        for (int field = 0; field < 6; ++field) {
            CAPTURE(bad);
            CAPTURE(field);
            double now_s = 0.0;
            Guard guard = settled(limits, force_of(1.0, 1.0), now_s);
            ArmCommand command = force_of(1.0, 1.0);
            if (field == 0) command.force_N = bad;
            if (field == 1) command.feedforward_N = bad;
            if (field == 2) command.depth_m = bad;
            if (field == 3) command.mode = bad;
            if (field == 4) {
                double heights_m[3] = {1e-3, bad, 1e-3};
                begin_tick(limits, now_s, true, nullptr, guard);
                guard_pins(limits, heights_m, guard);
                for (const double height_m : heights_m) CHECK(height_m == limits.pin_rest_m);
            }
            now_s += 1e-3;
            if (field == 5) begin_tick(limits, bad, true, nullptr, guard);
            const ArmCommand passed = one_tick(limits, now_s, command, guard);
            CHECK(guard.fault == Fault::not_a_number);
            CHECK(passed.force_N == 0.0);
            CHECK(passed.feedforward_N == 0.0);
            CHECK(passed.mode == 0.0);
            CHECK(one_tick(limits, now_s += 1e-3, force_of(1.0), guard).force_N == 0.0);
            CHECK(guard.count[static_cast<std::size_t>(Fault::not_a_number)] == 1);
            release(guard);
            for (int i = 0; i < 10; ++i) one_tick(limits, now_s += 1e-3, force_of(1.0), guard);
            CHECK(guard.force_N == 1.0);
        }
    }
}

TEST_CASE("guard: NaN from the arm is no place") {
    const Limits limits;
    double now_s = 0.0;
    Guard guard = settled(limits, force_of(1.0), now_s);
    ArmFeedback in;
    in.depth_m = kNan;
    begin_tick(limits, now_s += 1e-3, true, &in, guard);
    ArmCommand command = force_of(1.0);
    guard_arm(limits, command, guard);
    CHECK(guard.fault == Fault::out_of_range);
    CHECK(command.force_N == 0.0);
}

TEST_CASE("guard: after 100 ms of silence all rests; when the device is back, it rises again from rest") {
    const Limits limits;
    double now_s = 0.0;
    Guard guard = settled(limits, force_of(2.0, 1.0), now_s);
    double heights_m[2] = {1e-3, 2e-3};
    for (int i = 0; i < 100; ++i) {
        begin_tick(limits, now_s += 1e-3, true, nullptr, guard);
        ArmCommand command = force_of(2.0, 1.0);
        guard_arm(limits, command, guard);
        heights_m[1] = 2e-3;
        guard_pins(limits, heights_m, guard);
    }
    CHECK(heights_m[1] == 2e-3);
    for (int i = 0; i < 99; ++i) CHECK(one_tick(limits, now_s += 1e-3, force_of(2.0), guard, false).force_N == 2.0);
    one_tick(limits, now_s += 1e-3, force_of(2.0), guard, false);
    const ArmCommand silent = one_tick(limits, now_s += 1e-3, force_of(2.0), guard, false);
    CHECK(silent.force_N == 0.0);
    CHECK(guard.fault == Fault::silence);
    guard_pins(limits, heights_m, guard);
    CHECK(heights_m[1] == limits.pin_rest_m);
    CHECK(one_tick(limits, now_s += 1e-3, force_of(2.0), guard).force_N == close_to(1.0));  // by its slew
    CHECK(guard.fault == Fault::none);
}

TEST_CASE("guard: F12 stops everything until a person lets it go on; a later fault does not hide it") {
    const Limits limits;
    double now_s = 0.0;
    Guard guard = settled(limits, force_of(2.0), now_s);
    stop(guard);
    latch(Fault::board_error, guard);
    CHECK(guard.fault == Fault::stopped);
    for (int i = 0; i < 500; ++i) CHECK(one_tick(limits, now_s += 1e-3, force_of(2.0), guard).mode == 0.0);
    CHECK(guard.fault == Fault::stopped);
    release(guard);
    CHECK(one_tick(limits, now_s += 10.0, force_of(2.0), guard).force_N == 0.0);  // the first tick knows no time
    CHECK(one_tick(limits, now_s += 1e-3, force_of(2.0), guard).force_N == close_to(1.0));
}

TEST_CASE("guard: an arm that is where it cannot be stops for good; one that is too fast, while it is") {
    const Limits limits;
    double now_s = 0.0;
    Guard guard = settled(limits, force_of(2.0), now_s);
    ArmFeedback fast;
    fast.velocity_m_per_s = 2.0 * limits.speed_m_per_s;
    begin_tick(limits, now_s += 1e-3, true, &fast, guard);
    CHECK(guard.fault == Fault::too_fast);
    one_tick(limits, now_s += 1e-3, force_of(2.0), guard);
    CHECK(guard.fault == Fault::none);
    ArmFeedback gone;
    gone.depth_m = limits.deepest_m + 2.0 * limits.range_slack_m;
    begin_tick(limits, now_s += 1e-3, true, &gone, guard);
    one_tick(limits, now_s += 1e-3, force_of(2.0), guard);
    CHECK(guard.fault == Fault::out_of_range);
}

TEST_CASE("guard: an arm that reports a fault of its own stops for good") {
    const Limits limits;
    double now_s = 0.0;
    Guard guard = settled(limits, force_of(1.0), now_s);
    ArmFeedback in;
    in.faulty = 1.0;
    ArmCommand command = force_of(1.0);
    begin_tick(limits, now_s += 1e-3, true, &in, guard);
    guard_arm(limits, command, guard);
    CHECK(guard.fault == Fault::arm_error);
    CHECK(command.force_N == 0.0);
    for (int i = 0; i < 100; ++i) command = one_tick(limits, now_s += 1e-3, force_of(1.0), guard);
    CHECK(command.force_N == 0.0);
    release(guard);
    for (int i = 0; i < 100; ++i) command = one_tick(limits, now_s += 1e-3, force_of(1.0), guard);
    CHECK(command.force_N == 1.0);
}

TEST_CASE("guard: what the driver of the pins says counts") {
    CHECK(fault_of(PinState::proving) == Fault::none);
    CHECK(fault_of(PinState::driving) == Fault::none);
    CHECK(fault_of(PinState::gone) == Fault::silence);
    CHECK(fault_of(PinState::no_answer) == Fault::silence);
    CHECK(fault_of(PinState::no_timeout) == Fault::timeout_missing);
    CHECK(fault_of(PinState::no_crc) == Fault::crc_missing);
    CHECK(fault_of(PinState::faulty) == Fault::board_error);
    const Limits limits;
    Guard guard;
    begin_tick(limits, 1.0, true, nullptr, guard, Fault::silence);
    CHECK(guard.fault == Fault::silence);
    begin_tick(limits, 1.001, true, nullptr, guard);
    CHECK(guard.fault == Fault::none);
    begin_tick(limits, 1.002, true, nullptr, guard, Fault::timeout_missing);
    begin_tick(limits, 1.003, true, nullptr, guard);
    CHECK(guard.fault == Fault::timeout_missing);
}

TEST_CASE("guard: a high-impedance arm starts from where it is") {
    Limits limits;
    Guard guard;
    ArmFeedback in;
    in.depth_m = 0.02;
    ArmCommand command{0.0, 0.0, 0.0, static_cast<double>(ArmMode::position)};
    begin_tick(limits, 1.0, true, &in, guard);
    guard_arm(limits, command, guard);
    CHECK(command.depth_m == 0.02);
    command.depth_m = 0.0;
    begin_tick(limits, 1.001, true, &in, guard);
    guard_arm(limits, command, guard);
    CHECK(command.depth_m == close_to(0.02 - 1e-3 * limits.depth_slew_m_per_s));
    command.depth_m = 9.0;
    for (int i = 2; i < 1000; ++i) {
        begin_tick(limits, 1.0 + 1e-3 * i, true, &in, guard);
        command.depth_m = 9.0;
        guard_arm(limits, command, guard);
    }
    CHECK(command.depth_m == limits.deepest_m);
    Guard blind;  // it was never told where the arm is
    begin_tick(limits, 1.0, false, nullptr, blind);
    command = {0.0, 0.0, 0.0, static_cast<double>(ArmMode::position)};
    guard_arm(limits, command, blind);
    CHECK(command.mode == 0.0);
}

TEST_CASE("guard: a user faster than everything, and wild commands, leave all outputs within limits and slew") {
    const Limits limits;
    constexpr std::uint64_t kSeed = 3;
    CAPTURE(kSeed);
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> wild(-100.0, 100.0), step(0.0, 2e-3);
    Guard guard;
    double now_s = 0.0;
    ArmCommand last = force_of(0.0);
    double last_height_m = 0.0;
    const std::int64_t before = palpa::test::allocations();
    int wrong = 0;
    for (int i = 0; i < 100000; ++i) {
        const double dt_s = step(random);
        now_s += dt_s;
        ArmFeedback in;
        in.depth_m = 1e-3 * wild(random);
        in.velocity_m_per_s = 0.1 * wild(random);
        begin_tick(limits, now_s, random() % 100 != 0, &in, guard);
        ArmCommand command = force_of(wild(random), wild(random));
        if (random() % 1000 == 0) command.force_N = kNan;
        guard_arm(limits, command, guard);
        double heights_m[kMostPins];
        for (double& height_m : heights_m) height_m = 1e-4 * wild(random);
        guard_pins(limits, heights_m, guard);
        wrong += !(command.force_N >= 0.0 && command.force_N <= limits.force_N);
        wrong += !(std::abs(command.feedforward_N) <= limits.feedforward_N);
        const bool rests = command.mode == 0.0;
        wrong += !rests && command.force_N - last.force_N > limits.force_slew_N_per_s * dt_s + 1e-9;
        for (const double height_m : heights_m)
            wrong += !(height_m >= limits.pin_lowest_m && height_m <= limits.pin_highest_m);
        wrong += heights_m[0] - last_height_m > limits.pin_slew_m_per_s * dt_s + 1e-12;
        last = command;
        last_height_m = heights_m[0];
        if (latches(guard.fault)) release(guard);
    }
    CHECK(wrong == 0);
    CHECK(palpa::test::allocations() == before);
}

TEST_CASE("limits: the scene's force limit and the arm's, the lower one; pins may be told four times their speed") {
    ArmDevice arm;
    arm.force_N = 10.0;
    PinDevice pins;
    CHECK(limits_of(&arm, &pins, 2.5).force_N == 2.5);
    CHECK(limits_of(&arm, &pins, 25.0).force_N == 10.0);
    CHECK(limits_of(nullptr, &pins, 2.5).pin_slew_m_per_s == close_to(0.12));
    CHECK(delay_warning(4000.0, 2e-3).empty());
    CHECK_FALSE(delay_warning(4000.0, 2.1e-3).empty());
}
