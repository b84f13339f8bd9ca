#include <cmath>
#include <doctest/doctest.h>

#include "platform/mouse.h"
#include "tests/close_to.h"

using palpa::platform::Mouse;
using palpa::platform::Phase;
using palpa::platform::Sample;

namespace {

constexpr double kHoldTick_s = 1.0 / palpa::platform::kHoldGrid_Hz;
constexpr double kRounding = 1e-9;  // of sums of seconds near 1000

}  // namespace

TEST_CASE("mouse pressure: rises with time from 0 to 1 and stays there") {
    Mouse mouse;
    mouse.button.hold_s = 2.0;
    std::vector<Sample> out;
    CHECK(palpa::platform::pressure_at(mouse.button, 1000.0) == 0.0);
    palpa::platform::press_mouse(1000.0, 5.0, mouse, out);
    for (const auto& [after_s, pressure] : {std::pair{0.0, 0.0}, {0.5, 0.25}, {1.0, 0.5}, {2.0, 1.0}, {9.0, 1.0}}) {
        CAPTURE(after_s);
        CHECK(palpa::platform::pressure_at(mouse.button, 1000.0 + after_s) ==
              test::close_to(pressure).epsilon(kRounding));
    }
    palpa::platform::release_mouse(1003.0, 8.0, mouse, out);
    CHECK(palpa::platform::pressure_at(mouse.button, 1004.0) == 0.0);
    REQUIRE(out.size() == 2);
    CHECK(out[0].phase == Phase::down);
    CHECK(out[0].t_device_s == 5.0);
    CHECK(out[0].pressure == 0.0);
    CHECK(out[1].phase == Phase::up);
    CHECK(out[1].pressure == 0.0);
}

TEST_CASE("mouse pressure: a hold time of zero is full pressure at once") {
    Mouse mouse;
    mouse.button.hold_s = 0.0;
    std::vector<Sample> out;
    palpa::platform::press_mouse(1.0, 1.0, mouse, out);
    CHECK(out[0].pressure == 1.0);
}

TEST_CASE("mouse pressure: a still button gives one sample per grid point, on the grid") {
    Mouse mouse;
    std::vector<Sample> out;
    palpa::platform::press_mouse(1000.001, 0.0, mouse, out);
    out.clear();
    for (const double now_s : {1000.002, 1000.1, 1000.1, 1000.35, 1001.001})
        palpa::platform::hold_mouse(now_s, mouse, out);
    REQUIRE(out.size() == 240);  // grid points in (1000.001, 1001.001]
    for (std::size_t i = 0; i < out.size(); ++i) {
        CAPTURE(i);
        CHECK(out[i].t_host_s == test::close_to(1000.0 + static_cast<double>(i + 1) * kHoldTick_s).epsilon(1e-12));
        CHECK(out[i].phase == Phase::move);
        CHECK(out[i].pressure == test::close_to((out[i].t_host_s - 1000.001) / 2.0).epsilon(kRounding));
        CHECK(std::isnan(out[i].t_device_s));
    }
}

TEST_CASE("mouse pressure: how often it is polled makes no difference") {
    std::vector<Sample> often, seldom;
    for (std::vector<Sample>* out : {&often, &seldom}) {
        Mouse mouse;
        palpa::platform::press_mouse(3.0, 0.0, mouse, *out);
        const int polls = out == &often ? 1000 : 3;
        for (int i = 1; i <= polls; ++i) palpa::platform::hold_mouse(3.0 + 1.5 * i / polls, mouse, *out);
    }
    REQUIRE(often.size() == seldom.size());
    for (std::size_t i = 0; i < often.size(); ++i) {
        CHECK(often[i].t_host_s == seldom[i].t_host_s);
        CHECK(often[i].pressure == seldom[i].pressure);
    }
}

TEST_CASE("mouse pressure: no samples from a button that is up") {
    Mouse mouse;
    std::vector<Sample> out;
    palpa::platform::hold_mouse(5.0, mouse, out);
    CHECK(out.empty());
    palpa::platform::move_mouse(5.1, 0.1, 30.0, 40.0, mouse, out);
    REQUIRE(out.size() == 1);
    CHECK(out[0].phase == Phase::hover);
    CHECK(out[0].x_px == 30.0);
    CHECK(out[0].y_px == 40.0);
    CHECK(out[0].pressure == 0.0);
    palpa::platform::release_mouse(5.2, 0.2, mouse, out);  // its press was cancelled
    CHECK(out.size() == 1);
}

TEST_CASE("mouse pressure: the wheel during a press takes over where holding has got to") {
    Mouse mouse;
    std::vector<Sample> out;
    palpa::platform::press_mouse(10.0, 0.0, mouse, out);
    palpa::platform::turn_wheel(11.0, 1.0, 2.0, mouse, out);
    REQUIRE(out.size() == 2);
    CHECK(out[1].phase == Phase::move);
    CHECK(out[1].pressure == test::close_to(0.6));
    CHECK(palpa::platform::pressure_at(mouse.button, 20.0) == test::close_to(0.6));  // time counts no more
    palpa::platform::turn_wheel(21.0, 2.0, -100.0, mouse, out);
    CHECK(out[2].pressure == 0.0);
    CHECK(palpa::platform::pressure_at(mouse.button, 30.0) == 0.0);
    palpa::platform::turn_wheel(31.0, 2.0, 100.0, mouse, out);
    CHECK(out[3].pressure == 1.0);
}

TEST_CASE("mouse pressure: the wheel before a press sets it, and turned to zero gives time back") {
    Mouse mouse;
    std::vector<Sample> out;
    palpa::platform::turn_wheel(1.0, 0.0, 4.0, mouse, out);
    CHECK(out.empty());
    palpa::platform::press_mouse(2.0, 0.0, mouse, out);
    CHECK(out[0].pressure == test::close_to(0.2));
    CHECK(palpa::platform::pressure_at(mouse.button, 5.0) == test::close_to(0.2));
    palpa::platform::release_mouse(6.0, 0.0, mouse, out);
    palpa::platform::turn_wheel(7.0, 0.0, -4.0, mouse, out);
    palpa::platform::press_mouse(8.0, 0.0, mouse, out);
    CHECK(palpa::platform::pressure_at(mouse.button, 9.0) == test::close_to(0.5));
}
