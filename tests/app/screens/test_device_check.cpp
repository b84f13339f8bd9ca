#include <cmath>
#include <doctest/doctest.h>
#include <memory>
#include <random>

#include "app/screens/device_check.h"
#include "tests/close_to.h"
#include "tests/scene/allocations.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::app;
using namespace palpa::test;

namespace {

Sample pen(double t_s, Phase phase, double pressure) {
    Sample sample;
    sample.t_host_s = t_s;
    sample.tool = Tool::pen;
    sample.pointer_id = -4;
    sample.phase = phase;
    sample.pressure = pressure;
    return sample;
}

}  // namespace

TEST_CASE("device check: rate, median and worst gap of a pen at 133 Hz with one sample missing") {
    auto check = std::make_unique<DeviceCheck>();
    for (int i = 0; i < 400; ++i) {
        if (i == 200) continue;
        observe(pen(100.0 + i / 133.0, i < 50 ? Phase::hover : i == 50 ? Phase::down : Phase::move, 0.5), *check);
    }
    const ToolCheck& tool = of_tool(Tool::pen, *check);
    CHECK(tool.samples == 399);
    CHECK(tool.touching == 349);
    CHECK(rate_Hz(tool) == close_to(398.0 / (399.0 / 133.0)).epsilon(1e-9));
    CHECK(median_gap_s(tool) == close_to(1.0 / 133.0).epsilon(0.03));
    CHECK(worst_gap_s(tool) == close_to(2.0 / 133.0).epsilon(1e-6));
    CHECK(of_tool(Tool::finger, *check).samples == 0);
    CHECK(std::isnan(rate_Hz(of_tool(Tool::finger, *check))));
}

TEST_CASE("device check: a few samples far apart tell no rate, although two of them came together") {
    auto check = std::make_unique<DeviceCheck>();
    observe(pen(100.0, Phase::hover, 0.0), *check);
    for (const double t_s : {100.0, 100.3, 100.7, 101.1}) observe(pen(t_s, Phase::down, 0.5), *check);
    const ToolCheck& tool = of_tool(Tool::pen, *check);
    CHECK_FALSE(knows_gaps(tool));
    CHECK(std::isnan(rate_Hz(tool)));
    CHECK(std::isnan(worst_gap_s(tool)));
    const files::Json json = check_json(*check);
    CHECK(json["pen"]["rate_Hz"].is_null());
    CHECK(json["pen"]["gap_ms"]["worst"].is_null());
}

TEST_CASE("device check: a rest is not part of the rate, and host times in a burst give way to the device's own") {
    auto check = std::make_unique<DeviceCheck>();
    for (int i = 0; i < 200; ++i) {
        const double t_s = i / 100.0 + (i >= 100 ? 5.0 : 0.0);
        Sample sample =
            pen(std::ceil(t_s * 10.0) / 10.0, i == 0 ? Phase::down : Phase::move, 0.5);  // 10 frames a second
        sample.t_device_s = 77.0 + t_s;
        observe(sample, *check);
    }
    const ToolCheck& tool = of_tool(Tool::pen, *check);
    CHECK(rate_Hz(tool) == close_to(100.0).epsilon(1e-6));
    CHECK(worst_gap_s(tool) == close_to(0.01).epsilon(1e-6));
}

TEST_CASE("device check: how many samples come at a time, and how late") {
    auto check = std::make_unique<DeviceCheck>();
    CHECK(std::isnan(median_delay_s(of_tool(Tool::pen, *check))));
    CHECK(std::isnan(samples_per_delivery(of_tool(Tool::pen, *check))));
    for (int i = 0; i < 400; ++i) {  // 240 Hz, handed over four at a time with the last of them
        Sample sample = pen(10.0 + (i / 4 * 4 + 3) / 240.0 + 2e-3, Phase::move, 0.4);
        sample.t_device_s = 10.0 + i / 240.0;
        observe(sample, *check);
    }
    const ToolCheck& tool = of_tool(Tool::pen, *check);
    CHECK(samples_per_delivery(tool) == 4.0);
    CHECK(median_delay_s(tool) > 2e-3);
    CHECK(median_delay_s(tool) < 2e-3 + 3.0 / 240.0);
    CHECK(check_json(*check)["pen"]["samples_per_delivery"] == 4.0);
    Sample other = pen(20.0, Phase::move, 0.4);
    other.t_device_s = 1e6;  // a clock of its own
    auto alone = std::make_unique<DeviceCheck>();
    observe(other, *alone);
    CHECK(std::isnan(median_delay_s(of_tool(Tool::pen, *alone))));
    CHECK(check_json(*alone)["pen"]["delay_ms"].is_null());
}

TEST_CASE("device check: fingers count together, each with its own gaps") {
    auto check = std::make_unique<DeviceCheck>();
    for (int i = 0; i < 300; ++i) {
        for (const std::int64_t id : {11, 12, 13}) {
            Sample sample =
                pen(0.01 * i + 0.001 * static_cast<double>(id), i == 0 ? Phase::down : Phase::move, 0.001 * i);
            sample.tool = Tool::finger;
            sample.pointer_id = id;
            sample.width_px = 9.0;
            sample.x_px = static_cast<double>(id);
            observe(sample, *check);
        }
    }
    const ToolCheck& tool = of_tool(Tool::finger, *check);
    CHECK(tool.samples == 900);
    CHECK(rate_Hz(tool) == close_to(100.0).epsilon(1e-9));
    CHECK(worst_gap_s(tool) == close_to(0.01).epsilon(1e-6));
    CHECK(tool.contact_size);
    CHECK_FALSE(tool.tilt);
    CHECK(tool.x_px.lowest == 11.0);
    CHECK(tool.x_px.highest == 13.0);
}

TEST_CASE("device check: more pointers than there is room for are still counted") {
    auto check = std::make_unique<DeviceCheck>();
    for (int i = 0; i < 100; ++i) {
        for (std::int64_t id = 1; id <= 2; ++id) {
            Sample sample = pen(0.01 * i, Phase::move, 0.5);
            sample.tool = Tool::finger;
            sample.pointer_id = 1000 * id + i / 2;  // 50 touches each that never said they ended
            observe(sample, *check);
        }
    }
    CHECK(of_tool(Tool::finger, *check).samples == 200);
    CHECK(of_tool(Tool::finger, *check).gap_count == 100);
}

TEST_CASE("device check: pressure range and distinct values, by counts and without them") {
    for (const bool counts : {true, false}) {
        CAPTURE(counts);
        auto check = std::make_unique<DeviceCheck>();
        for (int i = 0; i < 3000; ++i) {
            const double raw = 100 + (i * 7) % 2000;
            Sample sample = pen(0.002 * i, i == 0 ? Phase::down : Phase::move, raw / 8191.0);
            if (counts) sample.pressure_raw = raw;
            observe(sample, *check);
        }
        observe(pen(7.0, Phase::up, 0.0), *check);  // what a lifted pen says does not count
        const ToolCheck& tool = of_tool(Tool::pen, *check);
        CHECK(distinct_pressures(tool) == 2000);
        CHECK(tool.pressure.lowest == 100.0 / 8191.0);
        CHECK(tool.pressure.highest == 2099.0 / 8191.0);
        CHECK(std::isnan(tool.pressure_raw.lowest) == !counts);
        CHECK(pressure_kind(check->pressure, Tool::pen) == PressureKind::varies);
    }
}

TEST_CASE("device check: a clock that runs 120 ppm fast is found within its error, under delays of 0 to 4 ms") {
    for (const double ppm : {120.0, -35.0, 0.0}) {
        CAPTURE(ppm);
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> delay_s(0.0, 0.004);
        auto check = std::make_unique<DeviceCheck>();
        CHECK(std::isnan(clock_drift(of_tool(Tool::pen, *check)).ppm));
        for (int i = 0; i < 240 * 60; ++i) {
            const double true_s = 5000.0 + i / 240.0;
            Sample sample = pen(true_s + delay_s(random), Phase::hover, 0.0);
            sample.t_device_s = 31.0 + true_s * (1.0 + 1e-6 * ppm);
            observe(sample, *check);
        }
        const ClockDrift drift = clock_drift(of_tool(Tool::pen, *check));
        // of a line through n points: sigma / (T sqrt(n / 12)); the least of 60 uniform delays scatters by 1/61.5 of their range
        const double expected_error_ppm = 1e6 * 0.004 / 61.5 / (60.0 * std::sqrt(240.0 / 12.0));
        CHECK(drift.standard_error_ppm == close_to(expected_error_ppm).epsilon(0.2));
        CHECK(std::abs(drift.ppm - ppm) < 4.0 * expected_error_ppm);
    }
}

TEST_CASE("device check: a computer that is busy in half of the check does not seem to be a clock that drifts") {
    auto check = std::make_unique<DeviceCheck>();
    MESSAGE("seed 11");
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> delay_s(0.0, 0.002);
    for (int i = 0; i < 100 * 20; ++i) {
        const double true_s = 0.01 * i;
        const double stalled_s = true_s > 10.0 ? 0.2 - std::fmod(true_s, 0.2) : 0.0;  // samples wait until it goes on
        Sample sample = pen(true_s + stalled_s + delay_s(random), Phase::hover, 0.0);
        sample.t_device_s = true_s;
        observe(sample, *check);
    }
    const ClockDrift drift = clock_drift(of_tool(Tool::pen, *check));
    CHECK(std::abs(drift.ppm) < 500.0);  // the mean delays, 100 ms longer in the second half, would tell 7500
}

TEST_CASE("device check: without delays the drift is exact, from few samples too") {
    auto check = std::make_unique<DeviceCheck>();
    for (int i = 0; i < 30; ++i) {
        Sample sample = pen(0.2 * i, Phase::hover, 0.0);
        sample.t_device_s = 0.2 * i * (1.0 - 1e-3);
        observe(sample, *check);
    }
    const ClockDrift drift = clock_drift(of_tool(Tool::pen, *check));
    CHECK(drift.ppm == close_to(-1000.0).epsilon(1e-9));
    CHECK(drift.standard_error_ppm < 1e-3);
}

TEST_CASE("device check: no drift from too little") {
    auto check = std::make_unique<DeviceCheck>();
    for (int i = 0; i < 600; ++i) {  // 3 s
        Sample sample = pen(0.005 * i, Phase::hover, 0.0);
        sample.t_device_s = 0.005 * i;
        observe(sample, *check);
    }
    CHECK(std::isnan(clock_drift(of_tool(Tool::pen, *check)).ppm));
    const ToolCheck without_clock{};
    CHECK(std::isnan(clock_drift(without_clock).ppm));
}

TEST_CASE("device check: observing allocates nothing") {
    auto check = std::make_unique<DeviceCheck>();
    const auto before = test::allocations();
    for (int i = 0; i < 1000; ++i) observe(pen(0.001 * i, Phase::move, 0.001 * i), *check);
    const ClockDrift drift = clock_drift(of_tool(Tool::pen, *check));
    CHECK(std::isnan(drift.ppm));
    CHECK(distinct_pressures(of_tool(Tool::pen, *check)) == 1000);
    CHECK(test::allocations() == before);
}
