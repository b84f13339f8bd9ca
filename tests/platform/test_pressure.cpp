#include <cmath>
#include <doctest/doctest.h>
#include <initializer_list>
#include <vector>

#include "platform/pressure.h"
#include "tests/scene/allocations.h"

using namespace palpa;
using namespace palpa::platform;

namespace {

// One press of `n` samples at 100 Hz; `pressure_of(i)` is the pressure of the i-th.
template <class PressureOf>
void press(double from_s, int n, Tool tool, PressureOf&& pressure_of, PressureWatch& seen) {
    Sample sample;
    sample.tool = tool;
    for (int i = 0; i < n; ++i) {
        sample.t_host_s = from_s + 0.01 * i;
        sample.phase = i == 0 ? Phase::down : Phase::move;
        sample.pressure = pressure_of(i);
        watch(sample, seen);
    }
    sample.phase = Phase::up;
    sample.pressure = 0.0;
    watch(sample, seen);
    sample.phase = Phase::hover;
    watch(sample, seen);
}

}  // namespace

TEST_CASE("pressure: a value that never changes is no sensor, whatever the value") {
    for (const double value : {0.0, 0.5, 1.0, 0.25, 1.5}) {
        CAPTURE(value);
        PressureWatch seen;
        CHECK(pressure_kind(seen, Tool::pen) == PressureKind::unknown);
        press(
            10.0, 100, Tool::pen, [&](int) { return value; }, seen);
        CHECK(pressure_kind(seen, Tool::pen) == PressureKind::constant);
        CHECK(constant_pressure(seen, Tool::pen) == value);
        CHECK(pressure_kind(seen, Tool::finger) == PressureKind::unknown);
    }
}

TEST_CASE("pressure: too short, or too few samples, is no verdict") {
    const auto half = [](int) { return 0.5; };
    PressureWatch shortly;
    for (int i = 0; i < 4; ++i) press(i, 10, Tool::pen, half, shortly);  // 36 samples, 0.36 s of touch in 3 s
    CHECK(pressure_kind(shortly, Tool::pen) == PressureKind::unknown);
    CHECK(std::isnan(constant_pressure(shortly, Tool::pen)));
    for (int i = 4; i < 6; ++i) press(i, 10, Tool::pen, half, shortly);  // 0.54 s
    CHECK(pressure_kind(shortly, Tool::pen) == PressureKind::constant);

    PressureWatch few;
    Sample sample;
    for (int i = 0; i < 30; ++i) {  // 10 Hz
        sample.t_host_s = 0.1 * i;
        sample.phase = i == 0 ? Phase::down : Phase::move;
        sample.tool = Tool::pen;
        sample.pressure = 0.5;
        watch(sample, few);
    }
    CHECK(pressure_kind(few, Tool::pen) == PressureKind::unknown);
    sample.t_host_s = 3.0;
    watch(sample, few);
    CHECK(pressure_kind(few, Tool::pen) == PressureKind::constant);
}

TEST_CASE("pressure: a later change corrects the verdict, and stays") {
    PressureWatch seen;
    press(
        0.0, 100, Tool::finger, [](int) { return 1.0; }, seen);
    CHECK(pressure_kind(seen, Tool::finger) == PressureKind::constant);
    press(
        2.0, 3, Tool::finger, [](int i) { return i == 2 ? 0.99 : 1.0; }, seen);
    CHECK(pressure_kind(seen, Tool::finger) == PressureKind::varies);
    press(
        3.0, 100, Tool::finger, [](int) { return 1.0; }, seen);
    CHECK(pressure_kind(seen, Tool::finger) == PressureKind::varies);
}

TEST_CASE("pressure: the first sample of a press, hovering and lifting say nothing") {
    PressureWatch seen;
    press(
        0.0, 100, Tool::pen, [](int i) { return i == 0 ? 1.0 : 0.5; }, seen);
    CHECK(pressure_kind(seen, Tool::pen) == PressureKind::constant);
    CHECK(constant_pressure(seen, Tool::pen) == 0.5);
}

TEST_CASE("pressure: missing until there is some") {
    PressureWatch seen;
    press(
        0.0, 1, Tool::finger, [](int) { return kMissing; }, seen);
    CHECK(pressure_kind(seen, Tool::finger) == PressureKind::missing);
    press(
        1.0, 5, Tool::finger, [](int i) { return 0.1 * i; }, seen);
    CHECK(pressure_kind(seen, Tool::finger) == PressureKind::varies);
}

TEST_CASE("pressure: watching allocates nothing") {
    PressureWatch seen;
    const auto before = test::allocations();
    press(
        0.0, 100, Tool::pen, [](int i) { return 0.01 * i; }, seen);
    CHECK(pressure_kind(seen, Tool::pen) == PressureKind::varies);
    CHECK(test::allocations() == before);
}
