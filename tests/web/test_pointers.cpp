// The browser's events as samples (platform/web/pointers.h), without a browser.

#include <cmath>
#include <doctest/doctest.h>

#include "platform/web/pointers.h"

using namespace palpa;
using namespace palpa::platform;

namespace {

using Kind = BrowserPointer::Kind;

BrowserPointer event(Tool tool, Kind kind, double x_px, int buttons, std::int64_t id = 5) {
    BrowserPointer out;
    out.tool = tool;
    out.kind = kind;
    out.pointer_id = id;
    out.x_px = x_px;
    out.y_px = 100.0;
    out.pressure = buttons != 0 ? 0.4 : 0.0;
    out.width_px = out.height_px = tool == Tool::finger ? 12.0 : 1.0;
    out.time_s = 1.0;
    out.buttons = buttons;
    return out;
}

std::vector<Phase> phases(const Pointers& pointers) {
    std::vector<Phase> out;
    for (const Sample& sample : pointers.pending) out.push_back(sample.phase);
    return out;
}

// Everything left of 200 px is a panel; counts what it hears.
struct Panel {
    int downs = 0;
    int ups_on_it = 0;
    static bool filter(const WindowEvent& event, void* user) {
        auto& panel = *static_cast<Panel*>(user);
        const bool on_it = event.x_px >= 0.0 && event.x_px < 200.0;
        using K = WindowEvent::Kind;
        panel.downs += on_it && (event.kind == K::button_down || event.kind == K::finger_down) ? 1 : 0;
        panel.ups_on_it += on_it && (event.kind == K::button_up || event.kind == K::finger_up) ? 1 : 0;
        return on_it && event.kind != K::pointer_move && event.kind != K::finger_move;
    }
};

}  // namespace

TEST_CASE("browser: a pen hovers, presses, moves and lifts; its side button alone presses nothing") {
    Pointers pointers;
    receive(event(Tool::pen, Kind::move, 300.0, 0), 1.0, pointers);
    receive(event(Tool::pen, Kind::down, 300.0, 2), 1.0, pointers);
    receive(event(Tool::pen, Kind::move, 301.0, 3), 1.0, pointers);
    receive(event(Tool::pen, Kind::move, 302.0, 1), 1.0, pointers);
    receive(event(Tool::pen, Kind::up, 302.0, 0), 1.0, pointers);
    CHECK(phases(pointers) == std::vector<Phase>{Phase::hover, Phase::hover, Phase::down, Phase::move, Phase::up});
    CHECK(pointers.pending[2].pointer_id < 0);
    CHECK(pointers.pending[2].pressure == 0.4);
    CHECK(pointers.pending[2].t_device_s == 1.0);
    CHECK(std::isnan(pointers.pending[2].width_px));  // 1 CSS px is no contact size
}

TEST_CASE("browser: fingers are told apart, have a size, and none moves that was not put down") {
    Pointers pointers;
    receive(event(Tool::finger, Kind::move, 300.0, 1, 9), 1.0, pointers);
    CHECK(pointers.pending.empty());
    receive(event(Tool::finger, Kind::down, 300.0, 1, 9), 1.0, pointers);
    receive(event(Tool::finger, Kind::down, 400.0, 1, 10), 1.0, pointers);
    receive(event(Tool::finger, Kind::cancel, 300.0, 0, 9), 1.0, pointers);
    receive(event(Tool::finger, Kind::move, 401.0, 1, 10), 1.0, pointers);
    CHECK(phases(pointers) == std::vector<Phase>{Phase::down, Phase::down, Phase::cancel, Phase::move});
    CHECK(pointers.pending[0].pointer_id != pointers.pending[1].pointer_id);
    CHECK(pointers.pending[0].pointer_id > 0);
    CHECK(pointers.pending[3].width_px == 12.0);
}

TEST_CASE("browser: a panel keeps a press that starts on it; a cancelled one presses none of its buttons") {
    Pointers pointers;
    Panel panel;
    pointers.filter = &Panel::filter;
    pointers.filter_user = &panel;
    for (const Tool tool : {Tool::pen, Tool::finger, Tool::mouse}) {
        receive(event(tool, Kind::down, 50.0, 1), 1.0, pointers);
        receive(event(tool, Kind::move, 300.0, 1), 1.0, pointers);
        receive(event(tool, Kind::up, 300.0, 0), 1.0, pointers);
        receive(event(tool, Kind::down, 50.0, 1), 1.0, pointers);
        receive(event(tool, Kind::cancel, 50.0, 0), 1.0, pointers);
    }
    CHECK(pointers.pending.empty());
    CHECK(panel.downs == 6);
    CHECK(panel.ups_on_it == 0);
}

TEST_CASE("browser: losing the focus cancels what presses, and its end is not heard") {
    Pointers pointers;
    receive(event(Tool::pen, Kind::down, 300.0, 1), 1.0, pointers);
    receive(event(Tool::mouse, Kind::down, 300.0, 1), 1.0, pointers);
    release_all(1.0, pointers);
    receive(event(Tool::pen, Kind::up, 300.0, 0), 1.0, pointers);
    receive(event(Tool::mouse, Kind::up, 300.0, 0), 1.0, pointers);
    const std::vector<Phase> found = phases(pointers);
    REQUIRE(found.size() >= 4);
    CHECK(found[0] == Phase::down);
    CHECK(found[1] == Phase::down);
    CHECK(found[2] == Phase::cancel);
    CHECK(found[3] == Phase::cancel);
    for (std::size_t i = 4; i < found.size(); ++i) CHECK(found[i] == Phase::hover);  // a mouse that goes on hovering
}

TEST_CASE("browser: keys press, unless a panel has them; a held button makes samples on the grid") {
    Pointers pointers;
    set_keyboard_area(1.0, {0.0, 0.0, 100.0, 100.0, 50.0}, pointers);
    WindowEvent key;
    key.kind = WindowEvent::Kind::key_down;
    key.key = key::space;
    receive_key(key, 1.0, pointers);
    hold(1.5, pointers);
    key.kind = WindowEvent::Kind::key_up;
    receive_key(key, 1.5, pointers);
    CHECK(pointers.pending.size() >= 120);
    CHECK(pointers.pending.front().phase == Phase::down);
    CHECK(pointers.pending.back().phase == Phase::up);
    CHECK(pointers.pending[100].pressure > pointers.pending[50].pressure);
}
