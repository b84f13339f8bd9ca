// The window with real events: a pen, fingers and a mouse of an X server (run it under with-xorg).
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <SDL.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "platform/keyboard.h"
#include "platform/window.h"

using palpa::Phase;
using palpa::Sample;
using palpa::Tool;
using palpa::Window;
using palpa::WindowOptions;

namespace {

struct Row {
    double t_s = 0.0;
    std::string kind;
    int id = 0;
    std::string phase;
    double x_px = 0.0;  // on the screen
    double y_px = 0.0;
    double pressure = 0.0;
};

WindowOptions small_window() {
    WindowOptions options;
    options.width_px = 1000;
    options.height_px = 700;
    options.mouse_hold_s = 1.0;
    return options;
}

std::string write_script(const std::vector<Row>& rows) {
    const auto path = std::filesystem::path(std::getenv("XORG_LOG")).parent_path() / "script.tsv";
    std::ofstream file(path);
    file.precision(12);
    file << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    for (const Row& row : rows) {
        file << row.t_s << '\t' << row.kind << '\t' << row.id << '\t' << row.phase << '\t' << row.x_px << '\t'
             << row.y_px << '\t' << row.pressure << '\n';
    }
    return path.string();
}

// Polls like an application until the script is over and nothing has come for 0.3 s, or has not stopped for 1 s.
std::vector<Sample> play(const std::vector<Row>& rows, Window& window) {
    std::vector<Sample> samples;
    for (int i = 0; i < 20; ++i) window.poll(0.01, samples);  // what appearing brings with it
    samples.clear();

    const std::string command = std::string(PALPA_XORG_PEN) + " " + write_script(rows);
    std::atomic<bool> over = false;
    int status = -1;
    std::thread player([&] {
        status = std::system(command.c_str());
        over = true;
    });
    double last_s = window.now_s();
    double ended_s = last_s;
    while (!over || (window.now_s() - last_s < 0.3 && window.now_s() - ended_s < 1.0)) {
        const std::size_t before = samples.size();
        if (!over) ended_s = window.now_s();
        window.poll(0.016, samples);
        if (samples.size() > before) last_s = window.now_s();
    }
    player.join();
    CHECK(status == 0);
    return samples;
}

std::vector<Sample> of_tool(Tool tool, const std::vector<Sample>& samples) {
    std::vector<Sample> out;
    for (const Sample& sample : samples) {
        if (sample.tool == tool) out.push_back(sample);
    }
    return out;
}

void check_in_order(const std::vector<Sample>& samples) {
    double host_s = 0.0, device_s = 0.0;
    int backwards = 0;
    for (const Sample& sample : samples) {
        backwards += sample.t_host_s < host_s ? 1 : 0;
        host_s = sample.t_host_s;
        if (std::isnan(sample.t_device_s)) continue;
        backwards += sample.t_device_s < device_s ? 1 : 0;
        device_s = sample.t_device_s;
    }
    CHECK(backwards == 0);
}

// Each sample against the row that made it: phase, place to 0.1 px, pressure to half of 1/1000.
void check_against(const std::vector<Row>& rows, const std::vector<Sample>& samples, Window& window) {
    int origin_x = 0, origin_y = 0;
    SDL_GetWindowPosition(window.sdl(), &origin_x, &origin_y);
    CHECK(origin_x > 0);
    REQUIRE(samples.size() == rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CAPTURE(i);
        REQUIRE(name_of(samples[i].phase) == rows[i].phase);
        REQUIRE(std::abs(samples[i].x_px - (rows[i].x_px - origin_x)) < 0.1);
        REQUIRE(std::abs(samples[i].y_px - (rows[i].y_px - origin_y)) < 0.1);
        REQUIRE(std::abs(samples[i].pressure - rows[i].pressure) < 0.5e-3);
    }
}

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
    fingers[402].pressure = fingers[403].pressure =
        0.0;  // what a lifted finger presses with is the driver's matter
    check_against(finger_rows, fingers, window);
    for (std::size_t i = 2; i < fingers.size(); ++i) {
        REQUIRE(fingers[i].pointer_id == fingers[i % 2].pointer_id);
    }
}

TEST_CASE("pen: devices are listed with their range") {
    Window window(small_window());
    int pens = 0, touches = 0, mice = 0;
    for (const palpa::PointerDevice& device : window.devices()) {
        CAPTURE(device.name);
        pens += device.tool == Tool::pen && device.has_pressure && device.pressure_max == 1000.0 ? 1 : 0;
        touches +=
            device.tool == Tool::finger && device.has_pressure && device.pressure_max == 2047.0 ? 1 : 0;
        mice += device.tool == Tool::mouse && !device.has_pressure ? 1 : 0;
    }
    CHECK(pens == 1);
    CHECK(touches == 1);
    CHECK(mice == 1);
}

TEST_CASE("mouse: devices that come and go are noticed") {
    Window window(small_window());
    std::vector<Sample> samples;
    const auto count_after = [&](const char* command) {
        REQUIRE(std::system(command) == 0);
        const double start_s = window.now_s();
        while (window.now_s() - start_s < 0.3) window.poll(0.05, samples);
        return window.devices().size();
    };
    const std::string player = PALPA_XORG_PEN;
    const std::size_t all = window.devices().size();
    CHECK(count_after((player + " --disable touch").c_str()) == all - 1);
    CHECK(count_after((player + " --enable touch").c_str()) == all);
}

TEST_CASE("unplugged: a pen that goes while it presses ends its press") {
    Window window(small_window());
    std::vector<Row> rows;
    for (int i = 0; i < 20; ++i) {
        const char* phase = i < 5 ? "hover" : i == 5 ? "down" : "move";
        rows.push_back({i / 100.0, "pen", 0, phase, 500.0 + i, 400.0, i < 5 ? 0.0 : 0.5});
    }
    std::vector<Sample> samples = of_tool(Tool::pen, play(rows, window));
    REQUIRE(samples.size() == 20);
    CHECK(samples.back().phase == Phase::move);

    samples.clear();
    REQUIRE(std::system(PALPA_XORG_PEN " --disable pen") == 0);
    const double start_s = window.now_s();
    while (window.now_s() - start_s < 0.3) window.poll(0.05, samples);
    REQUIRE(samples.size() == 1);
    const bool ended = samples[0].phase == Phase::up || samples[0].phase == Phase::cancel;
    CHECK(ended);
    MESSAGE("it ended with ", std::string(name_of(samples[0].phase)));
}

TEST_CASE("plugging: a pen that goes and comes again costs the fingers no sample") {
    Window window(small_window());
    const auto pens = [&] {
        int count = 0;
        for (const palpa::PointerDevice& device : window.devices()) count += device.tool == Tool::pen ? 1 : 0;
        return count;
    };
    std::vector<Row> rows;
    for (int i = 0; i < 400; ++i) {  // 2 s at 200 Hz
        const char* phase = i == 0 ? "down" : i == 399 ? "up" : "move";
        rows.push_back({0.005 * i, "touch", 1, phase, 400.0 + i, 500.0, i == 399 ? 0.0 : std::round(2.047 * i) / 2047.0});
    }
    std::atomic<bool> over = false;
    std::thread hand([&] {
        const auto run = [](const char* what) { CHECK(std::system(what) == 0); };
        for (const char* what : {PALPA_XORG_PEN " --disable pen", PALPA_XORG_PEN " --enable pen", PALPA_XORG_PEN " --disable pen"}) {
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
            run(what);
        }
        over = true;
    });
    CHECK(pens() == 1);
    std::vector<Sample> samples = play(rows, window);
    hand.join();
    CHECK(over);
    window.poll(0.05, samples);
    CHECK(pens() == 0);
    std::vector<Sample> fingers = of_tool(Tool::finger, samples);
    REQUIRE(fingers.size() == rows.size());
    fingers.back().pressure = 0.0;
    check_against(rows, fingers, window);

    REQUIRE(std::system(PALPA_XORG_PEN " --enable pen") == 0);
    const double start_s = window.now_s();
    while (window.now_s() - start_s < 0.3) window.poll(0.05, samples);
    CHECK(pens() == 1);
    for (const palpa::PointerDevice& device : window.devices()) {
        CAPTURE(device.name);
        if (device.tool == Tool::pen) CHECK(device.levels == 1001);
        if (device.tool == Tool::finger) CHECK(device.levels == 2048);
        if (device.tool == Tool::mouse) CHECK(device.levels == 0);
        CHECK_FALSE(device.has_tilt);
        CHECK_FALSE(device.axes.empty());
    }
}

TEST_CASE("keyboard: arrows, Space and Page Up press; keys that a panel takes do not; losing the focus cancels") {
    Window window(small_window());
    window.set_keyboard(200.0, 100.0, 800.0, 600.0, 240.0);
    constexpr int kSpace = 65, kRight = 102, kDown = 104, kPageUp = 99, kTab = 23, kShift = 50;
    struct Panel {
        bool has_focus = false;
        int tabs = 0;
    } panel;
    window.set_event_filter(
        [](const SDL_Event& event, void* user) {
            auto& it = *static_cast<Panel*>(user);
            if (event.type != SDL_KEYDOWN) return false;
            if (event.key.keysym.sym == SDLK_TAB && event.key.repeat == 0) {
                ++it.tabs;
                it.has_focus = !it.has_focus;
                return true;
            }
            return it.has_focus;
        },
        &panel);
    std::vector<Row> rows;
    const auto key = [&](double t_s, int code, const char* phase) { rows.push_back({t_s, "key", code, phase, 0.0, 0.0, 0.0}); };
    const auto tap = [&](double t_s, int code) {
        key(t_s, code, "down");
        key(t_s + 0.02, code, "up");
    };
    key(0.1, kRight, "down");
    key(0.6, kRight, "up");
    key(0.7, kSpace, "down");  // held long enough for the server to repeat it
    key(1.0, kShift, "down");
    key(1.1, kDown, "down");
    key(1.6, kDown, "up");
    key(1.65, kShift, "up");
    key(1.7, kSpace, "up");
    for (int i = 0; i < 4; ++i) tap(1.8 + 0.05 * i, kPageUp);
    tap(2.1, kSpace);
    tap(2.2, kTab);  // the panel's turn
    tap(2.3, kSpace);
    key(2.4, kRight, "down");
    key(2.5, kRight, "up");
    tap(2.6, kTab);
    key(2.7, kRight, "down");
    key(2.75, kSpace, "down");
    std::vector<Sample> samples = play(rows, window);

    CHECK(panel.tabs == 2);
    check_in_order(samples);
    std::vector<Sample> downs, ups;
    int early_hovers = 0;
    for (const Sample& sample : of_tool(Tool::keyboard, samples)) {
        CHECK(sample.pointer_id == palpa::kKeyboardPointerId);
        if (sample.phase == Phase::down) downs.push_back(sample);
        if (sample.phase == Phase::up) ups.push_back(sample);
        early_hovers += sample.phase == Phase::hover && downs.empty() ? 1 : 0;
    }
    REQUIRE(downs.size() == 3);
    REQUIRE(ups.size() == 2);
    CHECK(early_hovers > 100);  // 0.5 s on the grid
    const double right_px = downs[0].x_px - 500.0;
    CHECK(right_px > 100.0);
    CHECK(right_px < 160.0);
    CHECK(downs[0].y_px == 350.0);
    CHECK(ups[0].y_px - 350.0 > 0.8 * 0.5 * 240.0 * palpa::kSlowShare);
    CHECK(ups[0].y_px - 350.0 < 1.5 * 0.5 * 240.0 * palpa::kSlowShare);
    CHECK(downs[0].pressure == 0.0);
    double hardest = 0.0;
    for (const Sample& sample : samples) {
        if (sample.phase == Phase::move && sample.t_host_s < ups[0].t_host_s) hardest = std::max(hardest, sample.pressure);
    }
    CHECK(hardest > 0.9);  // held for 1 s of 1 s
    CHECK(downs[1].pressure == doctest::Approx(0.2));
    CHECK(downs[1].x_px == downs[0].x_px);
    CHECK(downs[2].x_px > downs[1].x_px);  // Space and arrow of the panel's turn did nothing

    samples.clear();
    SDL_HideWindow(window.sdl());
    const double start_s = window.now_s();
    while (window.now_s() - start_s < 0.6) window.poll(0.05, samples);
    REQUIRE_FALSE(samples.empty());
    const double ended_s = samples.back().t_host_s;
    int cancels = 0, others = 0;
    for (const Sample& sample : samples) {
        if (sample.phase == Phase::move || sample.phase == Phase::hover) continue;
        (sample.phase == Phase::cancel ? cancels : others) += 1;
    }
    CHECK(cancels == 1);
    CHECK(others == 0);
    while (window.now_s() - start_s < 0.8) window.poll(0.05, samples);
    CHECK(samples.back().t_host_s == ended_s);  // and nothing is held
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
        [](const SDL_Event& event, void* user) {
            auto& it = *static_cast<Panel*>(user);
            if (event.type == SDL_MOUSEBUTTONDOWN) {
                it.button_downs += event.button.which != SDL_TOUCH_MOUSEID ? 1 : 0;
                return event.button.x < it.right_px;
            }
            it.finger_downs += event.type == SDL_FINGERDOWN ? 1 : 0;
            return event.type == SDL_FINGERDOWN &&
                   static_cast<double>(event.tfinger.x) * 1000.0 < it.right_px;
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
        CHECK(presses.front().x_px == doctest::Approx(400.0).epsilon(1e-3));
        CHECK(presses.back().phase == Phase::up);
    }
}

TEST_CASE("mouse: every motion, pressure by holding and by wheel") {
    Window window(small_window());
    int origin_x = 0, origin_y = 0;
    SDL_GetWindowPosition(window.sdl(), &origin_x, &origin_y);
    std::vector<Row> rows;
    const auto add = [&](double t_s, const char* phase, int x_px, double notches = 0.0) {
        rows.push_back(
            {t_s, "mouse", 0, phase, static_cast<double>(origin_x + x_px), origin_y + 350.0, notches});
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
    CHECK(std::abs(static_cast<double>(held.size()) - held_s * palpa::kHoldGrid_Hz) <= 2.0);
    CHECK(downs[0].pressure == 0.0);
    const double by_time = (moves[99].t_host_s - downs[0].t_host_s) / 1.0;
    CHECK(moves[99].pressure == doctest::Approx(by_time).epsilon(1e-9));
    CHECK(by_time > 0.15);
    CHECK(downs[1].pressure == doctest::Approx(0.3));
    CHECK(moves[101].pressure == doctest::Approx(0.2));
    CHECK(window.mouse_pressure() == doctest::Approx(0.2));
}
