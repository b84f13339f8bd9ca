// The keyboard as a pointer, with real key events (run it under with-xorg).
#include <SDL.h>
#include <algorithm>
#include <doctest/doctest.h>
#include <string>
#include <vector>

#include "platform/keyboard.h"
#include "tests/close_to.h"
#include "tests/platform/e2e_scripts.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::xorg;
using namespace palpa::test;

TEST_CASE("keyboard: arrows, Space and Page Up press; keys that a panel takes do not; losing the focus cancels") {
    Window window(small_window());
    window.set_keyboard(200.0, 100.0, 800.0, 600.0, 240.0);
    constexpr int kSpace = 65, kRight = 102, kDown = 104, kPageUp = 99, kTab = 23, kShift = 50;
    struct Panel {
        bool has_focus = false;
        int tabs = 0;
    } panel;
    window.set_event_filter(
        [](const WindowEvent& event, void* user) {
            auto& it = *static_cast<Panel*>(user);
            if (event.kind != WindowEvent::Kind::key_down) return false;
            if (event.key == key::tab && !event.repeat) {
                ++it.tabs;
                it.has_focus = !it.has_focus;
                return true;
            }
            return it.has_focus;
        },
        &panel);
    std::vector<Row> rows;
    const auto key = [&](double t_s, int code, const char* phase) {
        rows.push_back({t_s, "key", code, phase, 0.0, 0.0, 0.0});
    };
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
        CHECK(sample.pointer_id == palpa::platform::kKeyboardPointerId);
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
    CHECK(ups[0].y_px - 350.0 > 0.8 * 0.5 * 240.0 * palpa::platform::kSlowShare);
    CHECK(ups[0].y_px - 350.0 < 1.5 * 0.5 * 240.0 * palpa::platform::kSlowShare);
    CHECK(downs[0].pressure == 0.0);
    double hardest = 0.0;
    for (const Sample& sample : samples) {
        if (sample.phase == Phase::move && sample.t_host_s < ups[0].t_host_s)
            hardest = std::max(hardest, sample.pressure);
    }
    CHECK(hardest > 0.9);  // held for 1 s of 1 s
    CHECK(downs[1].pressure == close_to(0.2));
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
