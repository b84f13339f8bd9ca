// The limits of a soft device's wires.

#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <random>

#include "devices/rig_guard.h"
#include "tests/close_to.h"
#include "tests/devices/wires.h"
#include "tests/scene/allocations.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::test;

namespace {

ActuatorRig guarded_rig() { return rig_from(rig_text("regulator")); }  // total 9 N: 5 N, a length, 5 kPa on 1443 mm2

double total_N(const ActuatorRig& rig, const RigGuard& guard) {
    double sum_N = 0.0;
    for (std::size_t i = 0; i < rig.channels.size(); ++i)
        sum_N += std::abs(rig.channels[i].force_N_per_unit * guard.value[i]);
    return sum_N;
}

bool at_rest(const ActuatorRig& rig, const RigGuard& guard) {
    for (std::size_t i = 0; i < rig.channels.size(); ++i) {
        if (guard.value[i] != rig.channels[i].relaxed) return false;
    }
    return !guard.driven;
}

// Commands the same again and again, 10 ms apart.
void command(const ActuatorRig& rig, std::array<double, 3> wanted, int times, double& now_s, RigGuard& guard) {
    for (int i = 0; i < times; ++i) {
        now_s += 0.01;
        watch(rig, now_s, Fault::none, guard);
        take_command(rig, now_s, wanted, guard);
    }
}

}  // namespace

TEST_CASE("rig guard: commands pass within range, rate and total force, and no faster") {
    const ActuatorRig rig = guarded_rig();
    RigGuard guard = make_rig_guard(rig);
    double now_s = 0.0;
    command(rig, {1.0, 0.03, 0.0}, 1, now_s, guard);
    CHECK(guard.value[0] == 0.0);  // the first one starts from rest
    command(rig, {1.0, 0.03, 0.0}, 1, now_s, guard);
    CHECK(guard.value[0] == 1.0);
    CHECK(guard.value[1] == close_to(0.053));  // 500 mm/s for 10 ms
    command(rig, {1.0, 0.03, 0.0}, 10, now_s, guard);
    CHECK(guard.value[1] == 0.03);
    command(rig, {-3.0, 1.0, 1e9}, 50, now_s, guard);
    CHECK(guard.value[0] == 0.0);
    CHECK(guard.value[1] == 0.06);
    CHECK(guard.value[2] == 5000.0);
    CHECK(guard.limited > 0);
    command(rig, {5.0, 0.03, 5000.0}, 50, now_s, guard);
    CHECK(total_N(rig, guard) == close_to(9.0));
    CHECK(total_N(rig, guard) <= 9.0);
    CHECK(guard.value[0] / guard.value[2] == close_to(5.0 / 5000.0));
    CHECK(guard.scaled > 0);
}

TEST_CASE("rig guard: stale input, no number, a fault, F12: all relaxes at once and stays so until it is released") {
    const ActuatorRig rig = guarded_rig();
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                     kEndless = std::numeric_limits<double>::infinity();
    for (int way = 0; way < 7; ++way) {
        CAPTURE(way);
        RigGuard guard = make_rig_guard(rig);
        double now_s = 5.0;
        command(rig, {2.0, 0.05, 1000.0}, 20, now_s, guard);
        CHECK(guard.value[0] == 2.0);
        CHECK(guard.driven);
        Fault wanted = Fault::none;
        if (way == 0) watch(rig, now_s + 0.1001, Fault::none, guard), wanted = Fault::loop_silent;
        if (way == 1)
            take_command(rig, now_s + 0.01, std::array{2.0, kNone, 1000.0}, guard), wanted = Fault::not_a_number;
        if (way == 2)
            take_command(rig, now_s + 0.01, std::array{kEndless, 0.05, 1.0}, guard), wanted = Fault::not_a_number;
        if (way == 3) take_command(rig, now_s + 0.01, std::array{2.0, 0.05}, guard), wanted = Fault::not_a_number;
        if (way == 4) latch(rig, Fault::stopped, guard), wanted = Fault::stopped;
        if (way == 5) watch(rig, now_s + 0.01, Fault::board_error, guard), wanted = Fault::board_error;
        if (way == 6) watch(rig, kNone, Fault::none, guard), wanted = Fault::loop_silent;
        CHECK(guard.fault == wanted);
        CHECK(guard.count[static_cast<std::size_t>(wanted)] == 1);
        CHECK(at_rest(rig, guard));
        command(rig, {2.0, 0.05, 1000.0}, 20, now_s, guard);
        latch(rig, Fault::silence, guard);
        CHECK(at_rest(rig, guard));
        CHECK(guard.fault == wanted);  // the first one
        release(rig, guard);
        CHECK(at_rest(rig, guard));
        command(rig, {2.0, 0.05, 1000.0}, 20, now_s, guard);
        CHECK(guard.fault == Fault::none);
        CHECK(guard.value[0] == 2.0);
    }
    RigGuard quiet = make_rig_guard(rig);
    watch(rig, 1.0, Fault::none, quiet);
    watch(rig, 100.0, Fault::none, quiet);
    CHECK(quiet.fault == Fault::none);  // before the first command nothing is missing
}

TEST_CASE("rig guard: a million random commands leave neither the ranges nor the total force; nothing is allocated") {
    const ActuatorRig rig = guarded_rig();
    constexpr unsigned kSeed = 23;
    CAPTURE(kSeed);
    std::mt19937_64 random(kSeed);
    RigGuard guard = make_rig_guard(rig);
    double now_s = 0.0;
    bool good = true;
    const std::int64_t before = allocations();
    for (int i = 0; i < 1'000'000; ++i) {
        std::array<double, 3> wanted;
        for (double& value : wanted) {
            const std::uint64_t bits = random();  // any bit pattern, or a sensible size
            std::memcpy(&value, &bits, sizeof value);
            if (i % 3 != 0) value = 1e-4 * static_cast<double>(static_cast<std::int16_t>(bits));
        }
        now_s += 1e-6 * static_cast<double>(random() % 30000);
        watch(rig, now_s, Fault::none, guard);
        take_command(rig, now_s, wanted, guard);
        if (i % 5 == 0) release(rig, guard);
        for (std::size_t k = 0; k < 3; ++k)
            good = good && guard.value[k] >= rig.channels[k].lower && guard.value[k] <= rig.channels[k].upper;
        good = good && total_N(rig, guard) <= rig.total_force_N;
    }
    CHECK(good);
    CHECK(allocations() == before);
}
