#include "platform/keyboard.h"

#include <algorithm>
#include <cmath>

namespace palpa::platform {
namespace {

Sample keyboard_sample(const Keyboard& keyboard, double t_host_s, Phase phase) {
    Sample sample;
    sample.t_host_s = t_host_s;
    sample.pointer_id = kKeyboardPointerId;
    sample.tool = Tool::keyboard;
    sample.phase = phase;
    sample.x_px = keyboard.x_px;
    sample.y_px = keyboard.y_px;
    sample.pressure = keyboard.button.down ? pressure_at(keyboard.button, t_host_s) : 0.0;
    return sample;
}

Phase resting_phase(const Keyboard& keyboard) { return keyboard.button.down ? Phase::move : Phase::hover; }

void keep_inside(Keyboard& keyboard) {
    keyboard.x_px = std::clamp(keyboard.x_px, keyboard.area.x0_px, keyboard.area.x1_px);
    keyboard.y_px = std::clamp(keyboard.y_px, keyboard.area.y0_px, keyboard.area.y1_px);
}

// Moves the cursor to its place at `t_host_s`. Two arrows at once are no faster than one.
void move_cursor(double t_host_s, Keyboard& keyboard) {
    if (t_host_s <= keyboard.moved_s) return;
    const double x = static_cast<double>(keyboard.held[1]) - static_cast<double>(keyboard.held[0]);
    const double y = static_cast<double>(keyboard.held[3]) - static_cast<double>(keyboard.held[2]);
    const double length = std::max(1.0, std::hypot(x, y));
    const double speed_px_per_s = keyboard.area.speed_px_per_s * (keyboard.slow ? kSlowShare : 1.0);
    const double way_px = speed_px_per_s / length * (t_host_s - keyboard.moved_s);
    keyboard.x_px += x * way_px;
    keyboard.y_px += y * way_px;
    keyboard.moved_s = t_host_s;
    keep_inside(keyboard);
}

void begin_to_hold(double t_host_s, Keyboard& keyboard) {
    if (!key_held(keyboard)) keyboard.last_tick = last_grid_point(t_host_s);
    move_cursor(t_host_s, keyboard);
}

bool same_place(const KeyboardArea& a, const KeyboardArea& b) {
    return a.x0_px == b.x0_px && a.y0_px == b.y0_px && a.x1_px == b.x1_px && a.y1_px == b.y1_px;
}

bool is_arrow(PointerKey key) { return key <= PointerKey::down; }

}  // namespace

bool is_on(const Keyboard& keyboard) {
    return keyboard.area.x1_px > keyboard.area.x0_px && keyboard.area.y1_px > keyboard.area.y0_px;
}

bool key_held(const Keyboard& keyboard) {
    return keyboard.button.down ||
           std::any_of(keyboard.held.begin(), keyboard.held.end(), [](bool held) { return held; });
}

void set_area(const KeyboardArea& area, Keyboard& keyboard) {
    const bool was_on = is_on(keyboard);
    if (was_on) keyboard.left = keyboard.area;
    keyboard.area = area;
    if (!is_on(keyboard)) return release_keys(keyboard);
    if (!was_on && !same_place(area, keyboard.left)) {
        keyboard.x_px = 0.5 * (area.x0_px + area.x1_px);
        keyboard.y_px = 0.5 * (area.y0_px + area.y1_px);
    }
    keep_inside(keyboard);
}

void hold_keys(double t_host_s, Keyboard& keyboard, std::vector<Sample>& out) {
    if (!key_held(keyboard)) return;
    const std::int64_t now = last_grid_point(t_host_s);
    for (std::int64_t tick = first_grid_point(keyboard.last_tick, now); tick <= now; ++tick) {
        move_cursor(grid_time_s(tick), keyboard);
        out.push_back(keyboard_sample(keyboard, grid_time_s(tick), resting_phase(keyboard)));
        keyboard.last_tick = tick;
    }
}

void hold_mouse_and_keys(double t_host_s, Mouse& mouse, Keyboard& keyboard, std::vector<Sample>& out) {
    hold_mouse(t_host_s, mouse, out);
    if (!key_held(keyboard)) return;
    hold_keys(t_host_s, keyboard, out);
    // both may be held: two runs of grid points, each in order
    std::stable_sort(out.begin(), out.end(), [](const Sample& a, const Sample& b) { return a.t_host_s < b.t_host_s; });
}

void key_down(double t_host_s, PointerKey key, Keyboard& keyboard, std::vector<Sample>& out) {
    if (!is_on(keyboard)) return;
    if (is_arrow(key)) {
        begin_to_hold(t_host_s, keyboard);
        keyboard.held[static_cast<std::size_t>(key)] = true;
    } else if (key == PointerKey::press) {
        if (keyboard.button.down) return;
        begin_to_hold(t_host_s, keyboard);
        keyboard.button.down = true;
        keyboard.button.down_s = t_host_s;
        out.push_back(keyboard_sample(keyboard, t_host_s, Phase::down));
    } else {
        turn_level(t_host_s, key == PointerKey::harder ? 1.0 : -1.0, keyboard.button);
        if (!keyboard.button.down) return;
        move_cursor(t_host_s, keyboard);
        out.push_back(keyboard_sample(keyboard, t_host_s, Phase::move));
    }
}

void key_up(double t_host_s, PointerKey key, Keyboard& keyboard, std::vector<Sample>& out) {
    if (is_arrow(key)) {
        bool& held = keyboard.held[static_cast<std::size_t>(key)];
        if (!held) return;
        move_cursor(t_host_s, keyboard);
        held = false;
        out.push_back(keyboard_sample(keyboard, t_host_s, resting_phase(keyboard)));
    } else if (key == PointerKey::press && keyboard.button.down) {
        move_cursor(t_host_s, keyboard);
        keyboard.button.down = false;
        out.push_back(keyboard_sample(keyboard, t_host_s, Phase::up));
    }
}

void set_slow(double t_host_s, bool slow, Keyboard& keyboard) {
    if (key_held(keyboard)) move_cursor(t_host_s, keyboard);
    keyboard.slow = slow;
}

void release_keys(Keyboard& keyboard) {
    keyboard.held.fill(false);
    keyboard.button.down = false;
}

}  // namespace palpa::platform
