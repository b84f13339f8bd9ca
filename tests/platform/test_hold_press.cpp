#include <cmath>
#include <doctest/doctest.h>
#include <initializer_list>
#include <vector>

#include "platform/held_pressure.h"
#include "platform/hold_press.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::test;

namespace {

Sample at(double t_s, Phase phase, std::int64_t pointer_id = 5, Tool tool = Tool::finger) {
    Sample sample;
    sample.t_host_s = t_s;
    sample.t_device_s = 0.5 * t_s;
    sample.pointer_id = pointer_id;
    sample.tool = tool;
    sample.phase = phase;
    sample.x_px = 10.0 * t_s;
    sample.pressure = 1.0;
    sample.pressure_raw = 77.0;
    return sample;
}

// As a window would: what came since the last poll, every `poll_s`.
std::vector<Sample> polled(const std::vector<Sample>& all, double until_s, double poll_s, HoldPress& hold) {
    std::vector<Sample> out, fresh;
    std::size_t next = 0;
    const int polls = static_cast<int>(std::ceil(until_s / poll_s));
    for (int i = 1; i <= polls; ++i) {
        const double now_s = std::min(until_s, i * poll_s);
        fresh.clear();
        while (next < all.size() && all[next].t_host_s <= now_s) fresh.push_back(all[next++]);
        press_by_hold(now_s, hold, fresh);
        out.insert(out.end(), fresh.begin(), fresh.end());
    }
    return out;
}

HoldPress holding(bool pen, bool finger) {
    HoldPress hold;
    hold.pen = pen;
    hold.finger = finger;
    return hold;
}

}  // namespace

TEST_CASE("hold press: a still finger presses harder on the grid, its raw value stays the device's") {
    HoldPress hold = holding(false, true);
    std::vector<Sample> out = polled({at(1.001, Phase::down), at(2.001, Phase::up)}, 3.0, 0.016, hold);
    REQUIRE(out.size() == 241);  // down, 239 grid points a whole step after it, up
    CHECK(out.front().phase == Phase::down);
    CHECK(out.front().pressure == 0.0);
    CHECK(out.back().phase == Phase::up);
    CHECK(out.back().pressure == 1.0);  // as it came
    for (std::size_t i = 1; i + 1 < out.size(); ++i) {
        CAPTURE(i);
        CHECK(out[i].phase == Phase::move);
        CHECK(out[i].t_host_s == grid_time_s(240 + static_cast<std::int64_t>(i) + 1));
        CHECK(out[i].pressure == close_to((out[i].t_host_s - 1.001) / 2.0).epsilon(1e-9));
        CHECK(out[i].pressure_raw == 77.0);
        CHECK(out[i].x_px == close_to(10.01));
        CHECK(std::isnan(out[i].t_device_s));
    }
}

TEST_CASE("hold press: a device that keeps sending gets no samples added") {
    HoldPress hold = holding(true, false);
    std::vector<Sample> moving{at(1.0, Phase::down, -3, Tool::pen)};
    for (int i = 1; i < 500; ++i) moving.push_back(at(1.0 + 0.002 * i, Phase::move, -3, Tool::pen));
    const std::vector<Sample> out = polled(moving, 1.998, 0.016, hold);
    REQUIRE(out.size() == 500);
    for (std::size_t i = 0; i < out.size(); ++i) {
        CHECK(out[i].t_device_s == moving[i].t_device_s);
        CHECK(out[i].pressure == close_to(0.001 * static_cast<double>(i)).epsilon(1e-9));
    }
}

TEST_CASE("hold press: two fingers and a pen, in order of time, however often it is polled") {
    std::vector<Sample> all{at(1.0, Phase::hover, -3, Tool::pen),
                            at(1.1, Phase::down, 7),
                            at(1.2, Phase::down, 8),
                            at(1.25, Phase::down, -3, Tool::pen),
                            at(1.3, Phase::move, 7),
                            at(1.5, Phase::up, 8),
                            at(1.6, Phase::cancel, 7),
                            at(1.9, Phase::up, -3, Tool::pen)};
    HoldPress often_hold = holding(false, true), seldom_hold = holding(false, true);
    const std::vector<Sample> often = polled(all, 2.0, 0.001, often_hold);
    const std::vector<Sample> seldom = polled(all, 2.0, 1.0, seldom_hold);
    REQUIRE(often.size() == seldom.size());
    int of_finger[2] = {0, 0};
    for (std::size_t i = 0; i < often.size(); ++i) {
        CAPTURE(i);
        CHECK(often[i].t_host_s == seldom[i].t_host_s);
        CHECK(often[i].pressure == seldom[i].pressure);
        if (i > 0) CHECK(often[i].t_host_s >= often[i - 1].t_host_s);
        if (often[i].tool == Tool::pen) CHECK(often[i].pressure == 1.0);  // not chosen
        if (often[i].tool == Tool::finger) ++of_finger[often[i].pointer_id - 7];
    }
    CHECK(of_finger[0] == close_to(0.5 * 240).epsilon(0.03));
    CHECK(of_finger[1] == close_to(0.3 * 240).epsilon(0.03));
}

TEST_CASE("hold press: a press begins anew, a hold time of zero is full at once, rows of the program pass") {
    HoldPress hold = holding(false, true);
    hold.hold_s = 0.0;
    std::vector<Sample> samples{at(1.0, Phase::down), at(1.001, Phase::up)};
    Sample mark = at(1.001, Phase::ui);
    mark.action = Action::mark;
    samples.push_back(mark);
    press_by_hold(1.002, hold, samples);
    REQUIRE(samples.size() == 3);
    CHECK(samples[0].pressure == 1.0);
    CHECK(samples[2].action == Action::mark);

    hold.hold_s = 2.0;
    samples = {at(5.0, Phase::down), at(6.0, Phase::move), at(6.0, Phase::down), at(7.0, Phase::move)};
    press_by_hold(7.0, hold, samples);
    CHECK(samples.back().pressure == 0.5);  // counted from the second down
}

TEST_CASE("hold press: turned off in the middle of a press, samples pass as they come") {
    HoldPress hold = holding(false, true);
    std::vector<Sample> samples{at(1.0, Phase::down)};
    press_by_hold(1.5, hold, samples);
    CHECK(samples.size() > 100);
    hold.finger = false;
    samples = {at(2.0, Phase::move)};
    press_by_hold(2.5, hold, samples);
    REQUIRE(samples.size() == 1);
    CHECK(samples[0].pressure == 1.0);
}
