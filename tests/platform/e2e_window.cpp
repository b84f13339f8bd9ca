// The window with real events: a pen, fingers and a mouse of an X server (run it under with-xorg).
#include <SDL.h>
#include <cmath>
#include <doctest/doctest.h>
#include <string>
#include <vector>

#include "platform/held_pressure.h"
#include "tests/close_to.h"
#include "tests/platform/e2e_scripts.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::xorg;
using namespace palpa::test;

namespace {

std::vector<Row> pen_at_1000_Hz() {
    std::vector<Row> rows;
    for (int i = 0; i < 3000; ++i) {
        const double t = i / 1000.0;
        const double pressure = i < 500 || i >= 2900 ? 0.0 : std::round(1000.0 * (i - 499) / 2401.0) / 1000.0;
        const char* phase = i == 500 ? "down" : i > 500 && i < 2900 ? "move" : i == 2900 ? "up" : "hover";
        rows.push_back({t, "pen", 0, phase, 300.0 + 200.3 * t, 200.0 + 110.7 * t, pressure});
    }
    return rows;
}

std::vector<Row> two_fingers() {
    std::vector<Row> rows;
    const auto add = [&](double t_s, int id, const char* phase, double pressure) {
        rows.push_back({t_s, "touch", id, phase, 300.0 + 300.0 * id + 50.0 * (t_s - 3.2), 400.0 + 20.0 * id,
                        std::round(pressure * 2047.0) / 2047.0});
    };
    add(3.2, 1, "down", 0.1);
    add(3.25, 2, "down", 0.9);
    for (int i = 1; i <= 200; ++i) {
        const double t_s = 3.25 + i / 200.0;
        add(t_s, 1, "move", 0.1 + 0.8 * i / 200.0);
        add(t_s, 2, "move", 0.9 - 0.8 * i / 200.0);
    }
    add(4.3, 1, "up", 0.0);
    add(4.3, 2, "up", 0.0);
    return rows;
}

}  // namespace

TEST_CASE("pen: 3 s at 1000 Hz and two fingers arrive complete") {
    Window window(small_window());
    CHECK(window.input_note().empty());
    const std::vector<Row> pen_rows = pen_at_1000_Hz();
    const std::vector<Row> finger_rows = two_fingers();
    std::vector<Row> rows = pen_rows;
    rows.insert(rows.end(), finger_rows.begin(), finger_rows.end());
    const std::vector<Sample> samples = play(rows, window);

    check_in_order(samples);
    CHECK(of_tool(Tool::mouse, samples).empty());
    const std::vector<Sample> pen = of_tool(Tool::pen, samples);
    check_against(pen_rows, pen, window);
    const double span_s = pen.back().t_device_s - pen.front().t_device_s;
    MESSAGE(pen.size(), " pen samples in ", span_s, " s of the server's clock; first arrived ",
            1e3 * (pen.front().t_host_s - pen.front().t_device_s), " ms after it by the host's clock");

    std::vector<Sample> fingers = of_tool(Tool::finger, samples);
    REQUIRE(fingers.size() == finger_rows.size());
    CHECK(fingers[0].pointer_id != fingers[1].pointer_id);
    fingers[402].pressure = fingers[403].pressure = 0.0;  // what a lifted finger presses with is the driver's matter
    check_against(finger_rows, fingers, window);
    for (std::size_t i = 2; i < fingers.size(); ++i) {
        REQUIRE(fingers[i].pointer_id == fingers[i % 2].pointer_id);
    }
}

TEST_CASE("pen: devices are listed with their range") {
    Window window(small_window());
    int pens = 0, touches = 0, mice = 0;
    for (const palpa::platform::PointerDevice& device : window.devices()) {
        CAPTURE(device.name);
        pens += device.tool == Tool::pen && device.has_pressure && device.pressure_max == 1000.0 ? 1 : 0;
        touches += device.tool == Tool::finger && device.has_pressure && device.pressure_max == 2047.0 ? 1 : 0;
        mice += device.tool == Tool::mouse && !device.has_pressure ? 1 : 0;
    }
    CHECK(pens == 1);
    CHECK(touches == 1);
    CHECK(mice == 1);
}

TEST_CASE("panel: presses that start on it reach no tissue, and it hears of each once") {
    Window window(small_window());
    int origin_x = 0, origin_y = 0;
    SDL_GetWindowPosition(window.sdl(), &origin_x, &origin_y);
    struct Panel {
        double right_px;
        int button_downs = 0;
        int finger_downs = 0;
    } panel{200.0};
    window.set_event_filter(
        [](const WindowEvent& event, void* user) {
            auto& it = *static_cast<Panel*>(user);
            const bool finger = event.kind == WindowEvent::Kind::finger_down;
            const bool button = event.kind == WindowEvent::Kind::button_down;
            it.button_downs += button && !event.made_from_touch ? 1 : 0;
            it.finger_downs += finger ? 1 : 0;
            return (button || finger) && event.x_px < it.right_px;
        },
        &panel);

    std::vector<Row> rows;
    double t_s = 0.0;
    const auto stroke = [&](const char* kind, int id, double from_px, double to_px) {
        const auto add = [&](const char* phase, double x_px) {
            rows.push_back({t_s += 0.01, kind, id, phase, origin_x + x_px, origin_y + 300.0, 0.5});
        };
        if (std::string(kind) == "pen") add("hover", from_px);
        add("down", from_px);
        for (int i = 1; i <= 10; ++i) add("move", from_px + (to_px - from_px) * i / 10.0);
        add("up", to_px);
    };
    stroke("pen", 0, 100.0, 400.0);
    stroke("pen", 0, 400.0, 100.0);
    stroke("touch", 1, 100.0, 400.0);
    stroke("touch", 2, 400.0, 100.0);
    const std::vector<Sample> samples = play(rows, window);

    CHECK(panel.button_downs == 2);
    CHECK(panel.finger_downs == 2);
    CHECK(of_tool(Tool::mouse, samples).empty());
    for (const Tool tool : {Tool::pen, Tool::finger}) {
        CAPTURE(name_of(tool));
        std::vector<Sample> presses;
        for (const Sample& sample : of_tool(tool, samples)) {
            if (sample.phase != Phase::hover) presses.push_back(sample);
        }
        REQUIRE(presses.size() == 12);
        CHECK(presses.front().phase == Phase::down);
        CHECK(presses.front().x_px == close_to(400.0).epsilon(1e-3));
        CHECK(presses.back().phase == Phase::up);
    }
}

TEST_CASE("mouse: every motion, pressure by holding and by wheel") {
    Window window(small_window());
    int origin_x = 0, origin_y = 0;
    SDL_GetWindowPosition(window.sdl(), &origin_x, &origin_y);
    std::vector<Row> rows;
    const auto add = [&](double t_s, const char* phase, int x_px, double notches = 0.0) {
        rows.push_back({t_s, "mouse", 0, phase, static_cast<double>(origin_x + x_px), origin_y + 350.0, notches});
    };
    for (int i = 0; i < 500; ++i) add(i / 1000.0, "hover", 100 + i);  // 1000 Hz
    add(0.6, "down", 599);
    for (int i = 0; i < 100; ++i) add(0.7 + i / 1000.0, "move", 600 + i);
    add(1.1, "up", 699);
    add(1.3, "wheel", 699, 6.0);
    add(1.4, "down", 699);
    add(1.6, "wheel", 699, -2.0);
    add(1.7, "up", 699);
    const std::vector<Sample> samples = play(rows, window);

    CHECK(of_tool(Tool::mouse, samples).size() == samples.size());
    check_in_order(samples);
    std::vector<Sample> hovers, downs, ups, held, moves;
    for (const Sample& sample : samples) {
        if (sample.phase == Phase::hover) hovers.push_back(sample);
        if (sample.phase == Phase::down) downs.push_back(sample);
        if (sample.phase == Phase::up) ups.push_back(sample);
        if (sample.phase == Phase::move) (std::isnan(sample.t_device_s) ? held : moves).push_back(sample);
    }
    // the push into the corner leaves the window, of which SDL tells as a motion to its edge
    std::erase_if(hovers, [](const Sample& sample) { return sample.x_px == 0.0; });
    REQUIRE(hovers.size() == 500);
    for (std::size_t i = 0; i < hovers.size(); ++i) CHECK(hovers[i].x_px == 100.0 + static_cast<double>(i));
    REQUIRE(moves.size() == 102);  // 100 motions, 2 notches
    for (std::size_t i = 0; i < 100; ++i) CHECK(moves[i].x_px == 600.0 + static_cast<double>(i));
    REQUIRE(downs.size() == 2);
    REQUIRE(ups.size() == 2);

    // one per grid point between each down and its up, as they arrived
    double held_s = 0.0;
    for (std::size_t i = 0; i < 2; ++i) held_s += ups[i].t_host_s - downs[i].t_host_s;
    CHECK(std::abs(static_cast<double>(held.size()) - held_s * palpa::platform::kHoldGrid_Hz) <= 2.0);
    CHECK(downs[0].pressure == 0.0);
    const double by_time = (moves[99].t_host_s - downs[0].t_host_s) / 1.0;
    CHECK(moves[99].pressure == close_to(by_time).epsilon(1e-9));
    CHECK(by_time > 0.15);
    CHECK(downs[1].pressure == close_to(0.3));
    CHECK(moves[101].pressure == close_to(0.2));
    CHECK(window.mouse_pressure() == close_to(0.2));
}
