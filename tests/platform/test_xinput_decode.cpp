#include <cmath>
#include <doctest/doctest.h>

#include "platform/linux/xinput_decode.h"
#include "tests/close_to.h"

using palpa::platform::Axis;
using palpa::platform::Phase;
using palpa::platform::Sample;
using palpa::platform::Tool;
using palpa::platform::XiDevice;
using palpa::platform::XiEvent;
using palpa::platform::XiKind;
using palpa::platform::XiState;

namespace {

constexpr int kPen = 9;
constexpr int kTouch = 10;
constexpr int kMouse = 8;
constexpr int kMaster = 2;

XiDevice pen_device() {
    XiDevice pen;
    pen.id = kPen;
    pen.tool = Tool::pen;
    pen.x = {0, 0.0, 65535.0, 0.0};
    pen.y = {1, 0.0, 65535.0, 0.0};
    pen.pressure = {4, 0.0, 1000.0, 0.0};
    pen.tilt_x = {5, -64.0, 63.0, 57.0};
    pen.tilt_y = {6, -9000.0, 9000.0, 5730.0};  // counts per radian
    return pen;
}

XiDevice touch_device() {
    XiDevice touch;
    touch.id = kTouch;
    touch.tool = Tool::finger;
    touch.x = {0, 100.0, 1379.0, 0.0};  // one count per px
    touch.y = {1, 0.0, 1599.0, 0.0};    // two counts per px
    touch.pressure = {2, 10.0, 266.0, 0.0};
    touch.touch_major = {3, 0.0, 255.0, 0.0};
    touch.touch_minor = {4, 0.0, 255.0, 0.0};
    return touch;
}

XiState new_state() {
    XiState state;
    XiDevice mouse;
    mouse.id = kMouse;
    state.devices = {pen_device(), touch_device(), mouse};
    state.screen_width_px = 1280.0;
    state.screen_height_px = 800.0;
    return state;
}

// An event with a value for each of `axes`, in ascending order; keeps what the event points to.
struct Fake {
    std::vector<unsigned char> mask = std::vector<unsigned char>(2, 0);
    std::vector<double> values;
    XiEvent event;

    Fake(XiKind kind, int device_id, int source_id, std::initializer_list<std::pair<int, double>> axes) {
        event.kind = kind;
        event.device_id = device_id;
        event.source_id = source_id;
        event.detail = kind == XiKind::motion ? 0 : 1;
        event.time_ms = 5000;
        for (const auto& [axis, value] : axes) {
            auto& byte = mask[static_cast<std::size_t>(axis) / 8];
            byte = static_cast<unsigned char>(byte | (1u << (axis % 8)));
            values.push_back(value);
        }
        event.mask = mask;
        event.values = values;
    }
    Fake(const Fake&) = delete;
    Fake& operator=(const Fake&) = delete;
};

std::optional<Sample> decode(const Fake& fake, XiState& state) {
    return palpa::platform::decode(fake.event, 77.0, state);
}

}  // namespace

TEST_CASE("xinput: what a device is") {
    CHECK(palpa::platform::tool_of_device(false, true) == Tool::pen);
    CHECK(palpa::platform::tool_of_device(true, false) == Tool::finger);
    CHECK(palpa::platform::tool_of_device(true, true) == Tool::finger);
    CHECK(palpa::platform::tool_of_device(false, false) == Tool::mouse);
}

TEST_CASE("xinput: axes become px, pressure and degrees") {
    XiState state = new_state();
    Fake fake(XiKind::motion, kPen, kPen, {{0, 32768.0}, {1, 16384.0}, {4, 250.0}, {5, -30.0}, {6, 3000.0}});
    fake.event.origin_x_px = 140.0;
    fake.event.origin_y_px = 50.0;
    fake.event.event_x_px = 1.0;  // old: to be ignored
    const auto sample = decode(fake, state);
    REQUIRE(sample);
    CHECK(sample->tool == Tool::pen);
    CHECK(sample->phase == Phase::hover);
    CHECK(sample->pointer_id == palpa::platform::pen_pointer_id(kPen));
    CHECK(sample->x_px == test::close_to(640.0 - 140.0));
    CHECK(sample->y_px == test::close_to(200.0 - 50.0));
    CHECK(sample->pressure_raw == 250.0);
    CHECK(sample->pressure == test::close_to(0.25));
    CHECK(sample->tilt_x_deg == -30.0);
    CHECK(sample->tilt_y_deg == test::close_to(30.0).epsilon(1e-3));  // 57.3 counts per degree
    CHECK(std::isnan(sample->width_px));
    CHECK(sample->t_host_s == 77.0);
    CHECK(sample->t_device_s == test::close_to(5.0));
}

TEST_CASE("xinput: an axis that an event leaves out keeps its value") {
    XiState state = new_state();
    decode(Fake(XiKind::motion, kPen, kPen, {{0, 32768.0}, {1, 16384.0}, {4, 250.0}}), state);
    const auto sample = decode(Fake(XiKind::motion, kPen, kPen, {{1, 32768.0}}), state);
    REQUIRE(sample);
    CHECK(sample->x_px == test::close_to(640.0));
    CHECK(sample->y_px == test::close_to(400.0));
    CHECK(sample->pressure == test::close_to(0.25));
}

TEST_CASE("xinput: axes between two that are there do not shift values") {
    XiState state = new_state();
    // axes 2, 3 (scrolling) and 9 (second byte) mean nothing to us
    const auto sample =
        decode(Fake(XiKind::motion, kPen, kPen, {{0, 0.0}, {1, 0.0}, {2, 7.0}, {3, 7.0}, {4, 500.0}, {9, 7.0}}), state);
    REQUIRE(sample);
    CHECK(sample->pressure == test::close_to(0.5));
}

TEST_CASE("xinput: what a device does not have is missing") {
    XiState state = new_state();
    state.devices[0].pressure = {};
    state.devices[0].tilt_x = {};
    const auto sample = decode(Fake(XiKind::motion, kPen, kPen, {{0, 0.0}, {1, 0.0}, {4, 9.0}, {5, 9.0}}), state);
    REQUIRE(sample);
    CHECK(std::isnan(sample->pressure));
    CHECK(std::isnan(sample->pressure_raw));
    CHECK(std::isnan(sample->tilt_x_deg));
}

TEST_CASE("xinput: before the first value, pressure is missing and the place is the event's") {
    XiState state = new_state();
    Fake fake(XiKind::motion, kPen, kPen, {});
    fake.event.event_x_px = 12.5;
    fake.event.event_y_px = 13.5;
    const auto sample = decode(fake, state);
    REQUIRE(sample);
    CHECK(std::isnan(sample->pressure));
    CHECK(sample->x_px == 12.5);
    CHECK(sample->y_px == 13.5);
}

TEST_CASE("xinput: a mask longer than the values is survived") {
    XiState state = new_state();
    Fake fake(XiKind::motion, kPen, kPen, {{0, 32768.0}, {1, 32768.0}, {4, 100.0}});
    fake.event.values = fake.event.values.first(2);
    const auto sample = decode(fake, state);
    REQUIRE(sample);
    CHECK(sample->x_px == test::close_to(640.0));
    CHECK(std::isnan(sample->pressure));
}

TEST_CASE("xinput: an axis without a range gives no pressure, not a division by zero") {
    XiState state = new_state();
    state.devices[0].pressure = {4, 0.0, 0.0, 0.0};
    const auto sample = decode(Fake(XiKind::motion, kPen, kPen, {{0, 0.0}, {1, 0.0}, {4, 3.0}}), state);
    CHECK(std::isnan(sample->pressure));
    CHECK(sample->pressure_raw == 3.0);
}

TEST_CASE("xinput: only the pen's own events count") {
    XiState state = new_state();
    CHECK_FALSE(decode(Fake(XiKind::motion, kMaster, kPen, {{0, 1.0}, {1, 1.0}, {4, 1.0}}), state));
    CHECK_FALSE(decode(Fake(XiKind::press, kMaster, kPen, {}), state));
    CHECK_FALSE(decode(Fake(XiKind::motion, kMouse, kMouse, {{0, 1.0}, {1, 1.0}}), state));
    CHECK_FALSE(decode(Fake(XiKind::motion, kTouch, kTouch, {{0, 1.0}, {1, 1.0}}), state));
    CHECK_FALSE(decode(Fake(XiKind::motion, 55, 55, {{0, 1.0}}), state));
}

TEST_CASE("xinput: phases of a pen") {
    XiState state = new_state();
    const auto phase = [&](XiKind kind, int button, bool tip_held) {
        Fake fake(kind, kPen, kPen, {{0, 1.0}, {1, 1.0}, {4, 1.0}});
        fake.event.detail = button;
        fake.event.tip_held = tip_held;
        const auto sample = decode(fake, state);
        return sample ? std::optional(sample->phase) : std::nullopt;
    };
    CHECK(phase(XiKind::motion, 0, false) == Phase::hover);
    CHECK(phase(XiKind::press, 1, false) == Phase::down);
    CHECK(phase(XiKind::motion, 0, true) == Phase::move);
    CHECK_FALSE(phase(XiKind::press, 2, true));  // side button
    CHECK(phase(XiKind::motion, 0, true) == Phase::move);
    CHECK_FALSE(phase(XiKind::release, 2, true));
    CHECK(phase(XiKind::release, 1, true) == Phase::up);
    CHECK(phase(XiKind::motion, 0, false) == Phase::hover);
    CHECK_FALSE(phase(XiKind::release, 1, true));  // its press was outside the window
    CHECK(phase(XiKind::motion, 0, true) == Phase::hover);
    CHECK(phase(XiKind::press, 1, false) == Phase::down);
    CHECK(phase(XiKind::motion, 0, false) == Phase::cancel);  // another program got the release
    CHECK(phase(XiKind::motion, 0, false) == Phase::hover);
}

TEST_CASE("xinput: two fingers keep their own values") {
    XiState state = new_state();
    const auto touch = [&](XiKind kind, int id, std::initializer_list<std::pair<int, double>> axes) {
        Fake fake(kind, kMaster, kTouch, axes);
        fake.event.detail = id;
        return decode(fake, state);
    };
    const auto first = touch(XiKind::touch_begin, 1, {{0, 200.0}, {1, 300.0}, {2, 74.0}, {3, 40.0}, {4, 30.0}});
    REQUIRE(first);
    CHECK(first->tool == Tool::finger);
    CHECK(first->phase == Phase::down);
    CHECK(first->pointer_id == 1);
    CHECK(first->x_px == test::close_to(100.0));
    CHECK(first->y_px == test::close_to(150.0));
    CHECK(first->pressure == test::close_to(0.25));
    CHECK(first->width_px == test::close_to(40.0));
    CHECK(first->height_px == test::close_to(15.0));

    const auto second = touch(XiKind::touch_begin, 2, {{0, 500.0}, {1, 500.0}});
    REQUIRE(second);
    CHECK(std::isnan(second->pressure));  // not the first finger's
    const auto moved = touch(XiKind::touch_update, 1, {{2, 138.0}});
    REQUIRE(moved);
    CHECK(moved->phase == Phase::move);
    CHECK(moved->pressure == test::close_to(0.5));
    CHECK(moved->x_px == test::close_to(100.0));
    CHECK(touch(XiKind::touch_end, 1, {})->phase == Phase::up);
    CHECK_FALSE(touch(XiKind::touch_update, 1, {{2, 10.0}}));
    CHECK(state.touches.size() == 1);
}

TEST_CASE("xinput: a touch screen without a minor axis reports circles") {
    XiState state = new_state();
    state.devices[1].touch_minor = {};
    const auto sample = decode(Fake(XiKind::touch_begin, kMaster, kTouch, {{0, 200.0}, {1, 300.0}, {3, 40.0}}), state);
    CHECK(sample->width_px == test::close_to(40.0));
    CHECK(sample->height_px == test::close_to(20.0));  // two counts per px that way
}

TEST_CASE("xinput: the server's clock goes on over a wrap") {
    XiState state = new_state();
    Fake before(XiKind::motion, kPen, kPen, {{0, 1.0}, {1, 1.0}});
    before.event.time_ms = 4294967290u;
    Fake after(XiKind::motion, kPen, kPen, {{0, 2.0}, {1, 1.0}});
    after.event.time_ms = 4;
    const double first_s = decode(before, state)->t_device_s;
    CHECK(decode(after, state)->t_device_s - first_s == test::close_to(0.010));
}

TEST_CASE("xinput: pointers of an unplugged device are told") {
    XiState state = new_state();
    decode(Fake(XiKind::press, kPen, kPen, {{0, 1.0}, {1, 1.0}}), state);
    Fake finger(XiKind::touch_begin, kMaster, kTouch, {{0, 1.0}, {1, 1.0}});
    finger.event.detail = 6;
    decode(finger, state);
    CHECK(palpa::platform::replace_devices(state.devices, state).empty());
    const auto gone = palpa::platform::replace_devices({touch_device()}, state);
    CHECK(gone == std::vector<std::int64_t>{palpa::platform::pen_pointer_id(kPen)});
    CHECK(palpa::platform::replace_devices({}, state) == std::vector<std::int64_t>{6});
    CHECK(state.touches.empty());
}
