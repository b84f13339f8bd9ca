#include <cmath>
#include <doctest/doctest.h>
#include <initializer_list>
#include <vector>

#include "platform/keyboard.h"
#include "tests/close_to.h"

using palpa::platform::Keyboard;
using palpa::platform::Phase;
using palpa::platform::PointerKey;
using palpa::platform::Sample;

namespace {

constexpr double kTick_s = 1.0 / palpa::platform::kHoldGrid_Hz;

Keyboard keyboard_on(double speed_px_per_s = 120.0) {
    Keyboard keyboard;
    set_area({100.0, 50.0, 500.0, 350.0, speed_px_per_s}, keyboard);
    return keyboard;
}

void down(double t_s, PointerKey key, Keyboard& keyboard, std::vector<Sample>& out) {
    hold_keys(t_s, keyboard, out);
    key_down(t_s, key, keyboard, out);
}

void up(double t_s, PointerKey key, Keyboard& keyboard, std::vector<Sample>& out) {
    hold_keys(t_s, keyboard, out);
    key_up(t_s, key, keyboard, out);
}

}  // namespace

TEST_CASE("keyboard: off at the start, and then no key does anything") {
    Keyboard keyboard;
    std::vector<Sample> out;
    CHECK_FALSE(is_on(keyboard));
    for (const PointerKey key : {PointerKey::left, PointerKey::press, PointerKey::harder})
        down(1.0, key, keyboard, out);
    hold_keys(2.0, keyboard, out);
    up(3.0, PointerKey::press, keyboard, out);
    CHECK(out.empty());
    CHECK_FALSE(key_held(keyboard));
}

TEST_CASE("keyboard: the cursor starts in the middle, stays in the area, and stays put when the area grows") {
    Keyboard keyboard = keyboard_on();
    CHECK(keyboard.x_px == 300.0);
    CHECK(keyboard.y_px == 200.0);
    std::vector<Sample> out;
    down(10.0, PointerKey::left, keyboard, out);
    hold_keys(20.0, keyboard, out);
    CHECK(keyboard.x_px == 100.0);
    CHECK(keyboard.y_px == 200.0);
    for (const Sample& sample : out) CHECK(sample.x_px >= 100.0);
    set_area({0.0, 0.0, 1000.0, 1000.0, 120.0}, keyboard);
    CHECK(keyboard.x_px == 100.0);
    set_area({150.0, 0.0, 1000.0, 180.0, 120.0}, keyboard);
    CHECK(keyboard.x_px == 150.0);
    CHECK(keyboard.y_px == 180.0);
}

TEST_CASE("keyboard: after a page that turned it off the cursor is where it was, in another area in the middle") {
    Keyboard keyboard = keyboard_on();
    const KeyboardArea area = keyboard.area;
    std::vector<Sample> out;
    down(10.0, PointerKey::left, keyboard, out);
    hold_keys(10.5, keyboard, out);
    up(10.5, PointerKey::left, keyboard, out);
    const double x_px = keyboard.x_px;
    REQUIRE(x_px < 300.0);
    set_area({}, keyboard);
    set_area({}, keyboard);
    set_area(area, keyboard);
    CHECK(keyboard.x_px == x_px);
    set_area({}, keyboard);
    set_area({0.0, 0.0, 1000.0, 1000.0, 120.0}, keyboard);
    CHECK(keyboard.x_px == 500.0);
}

TEST_CASE("keyboard: an arrow moves the cursor on the grid, hovering, and says where it stopped") {
    Keyboard keyboard = keyboard_on();
    std::vector<Sample> out;
    down(1000.001, PointerKey::right, keyboard, out);
    CHECK(out.empty());  // it has not moved yet
    for (const double now_s : {1000.003, 1000.2, 1000.2, 1000.5}) hold_keys(now_s, keyboard, out);
    up(1000.502, PointerKey::right, keyboard, out);
    REQUIRE(out.size() == 121);  // grid points in (1000.001, 1000.502], and the stop
    for (std::size_t i = 0; i < 120; ++i) {
        CAPTURE(i);
        CHECK(out[i].t_host_s == test::close_to(1000.0 + static_cast<double>(i + 1) * kTick_s).epsilon(1e-12));
        CHECK(out[i].x_px == test::close_to(300.0 + 120.0 * (out[i].t_host_s - 1000.001)).epsilon(1e-9));
    }
    for (const Sample& sample : out) {
        CHECK(sample.phase == Phase::hover);
        CHECK(sample.tool == palpa::platform::Tool::keyboard);
        CHECK(sample.pointer_id == palpa::platform::kKeyboardPointerId);
        CHECK(std::isnan(sample.t_device_s));
        CHECK(sample.pressure == 0.0);
        CHECK(sample.y_px == 200.0);
    }
    CHECK(out[120].x_px == test::close_to(300.0 + 120.0 * 0.501).epsilon(1e-9));
    out.clear();
    hold_keys(1002.0, keyboard, out);
    CHECK(out.empty());
}

TEST_CASE("keyboard: two arrows are as fast as one, Shift is slower, opposite arrows cancel") {
    struct Case {
        std::vector<PointerKey> keys;
        bool slow;
        double dx_px, dy_px;  // in a second
    };
    const double diagonal = 120.0 / std::sqrt(2.0);
    for (const Case& c : {Case{{PointerKey::right, PointerKey::up}, false, diagonal, -diagonal},
                          Case{{PointerKey::down}, true, 0.0, 120.0 * palpa::platform::kSlowShare},
                          Case{{PointerKey::left, PointerKey::right}, false, 0.0, 0.0}}) {
        Keyboard keyboard = keyboard_on();
        std::vector<Sample> out;
        set_slow(0.5, c.slow, keyboard);
        for (const PointerKey key : c.keys) down(1.0, key, keyboard, out);
        hold_keys(2.0, keyboard, out);
        CHECK(keyboard.x_px == test::close_to(300.0 + c.dx_px).epsilon(1e-9));
        CHECK(keyboard.y_px == test::close_to(200.0 + c.dy_px).epsilon(1e-9));
    }
    Keyboard keyboard = keyboard_on();
    std::vector<Sample> out;
    down(1.0, PointerKey::right, keyboard, out);
    hold_keys(1.5, keyboard, out);
    set_slow(1.5, true, keyboard);  // in the middle of the way, from there on
    hold_keys(2.0, keyboard, out);
    CHECK(keyboard.x_px == test::close_to(300.0 + 60.0 + 60.0 * palpa::platform::kSlowShare).epsilon(1e-9));
}

TEST_CASE("keyboard: a held press key presses harder, repeats count once, the cursor may move meanwhile") {
    Keyboard keyboard = keyboard_on();
    std::vector<Sample> out;
    down(5.0, PointerKey::press, keyboard, out);
    down(5.2, PointerKey::press, keyboard, out);
    down(5.5, PointerKey::down, keyboard, out);
    up(5.75, PointerKey::down, keyboard, out);
    up(6.0, PointerKey::press, keyboard, out);
    up(6.1, PointerKey::press, keyboard, out);
    REQUIRE(out.size() == 1 + 240 + 1 + 1);  // down, grid, the arrow let go, up
    CHECK(out.front().phase == Phase::down);
    CHECK(out.front().pressure == 0.0);
    CHECK(out.back().phase == Phase::up);
    CHECK(out.back().pressure == 0.0);
    for (std::size_t i = 1; i + 1 < out.size(); ++i) {
        CAPTURE(i);
        CHECK(out[i].phase == Phase::move);
        CHECK(out[i].pressure == test::close_to((out[i].t_host_s - 5.0) / 2.0).epsilon(1e-9));
        CHECK(out[i].t_host_s >= out[i - 1].t_host_s);
    }
    CHECK(out.back().y_px == test::close_to(200.0 + 0.25 * 120.0).epsilon(1e-9));
}

TEST_CASE("keyboard: the level keys work as a wheel does") {
    Keyboard keyboard = keyboard_on();
    std::vector<Sample> out;
    for (int i = 0; i < 4; ++i) down(1.0, PointerKey::harder, keyboard, out);
    CHECK(out.empty());
    down(2.0, PointerKey::press, keyboard, out);
    CHECK(out.back().pressure == test::close_to(4 * palpa::platform::kLevelStep));
    down(2.5, PointerKey::softer, keyboard, out);
    CHECK(out.back().phase == Phase::move);
    CHECK(out.back().pressure == test::close_to(3 * palpa::platform::kLevelStep));
    CHECK(out.back().t_host_s == 2.5);
}

TEST_CASE("keyboard: letting all keys go leaves nothing held, turning it off too") {
    for (const bool off : {false, true}) {
        Keyboard keyboard = keyboard_on();
        std::vector<Sample> out;
        down(1.0, PointerKey::press, keyboard, out);
        down(1.0, PointerKey::left, keyboard, out);
        CHECK(key_held(keyboard));
        if (off) set_area({}, keyboard);
        if (!off) release_keys(keyboard);
        out.clear();
        up(2.0, PointerKey::press, keyboard, out);
        up(2.0, PointerKey::left, keyboard, out);
        CHECK(out.empty());
        CHECK_FALSE(key_held(keyboard));
    }
}

TEST_CASE("keyboard: how often it is polled makes no difference") {
    std::vector<Sample> often, seldom;
    for (std::vector<Sample>* out : {&often, &seldom}) {
        Keyboard keyboard = keyboard_on();
        down(3.0, PointerKey::right, keyboard, *out);
        const int polls = out == &often ? 1000 : 3;
        for (int i = 1; i <= polls; ++i) hold_keys(3.0 + 1.5 * i / polls, keyboard, *out);
    }
    REQUIRE(often.size() == seldom.size());
    for (std::size_t i = 0; i < often.size(); ++i) {
        CHECK(often[i].t_host_s == seldom[i].t_host_s);
        CHECK(often[i].x_px == seldom[i].x_px);
    }
}
