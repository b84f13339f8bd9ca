#include "platform/web/pointers.h"

#include <algorithm>
#include <optional>

namespace palpa::platform {
namespace {

constexpr double kNowhere_px = -1e6;
constexpr int kTip = 1;
constexpr int kOtherEnd = 32;

bool ask_filter(const WindowEvent& event, const Pointers& pointers) {
    return pointers.filter != nullptr && pointers.filter(event, pointers.filter_user);
}

PressOwner owner_if(bool on_panel) { return on_panel ? PressOwner::panel : PressOwner::tissue; }

void admit_made(PressOwner down_owner, Pointers& pointers) {
    for (const Sample& sample : pointers.made) admit(sample, down_owner, pointers.presses, pointers.pending);
    pointers.made.clear();
}

WindowEvent for_panels(WindowEvent::Kind kind, double x_px, double y_px, std::int64_t finger_id = 0) {
    WindowEvent event;
    event.kind = kind;
    event.x_px = x_px;
    event.y_px = y_px;
    event.finger_id = finger_id;
    return event;
}

// Fingers count from 1, pens down from -2 (platform/mouse.h).
std::int64_t number_of(const BrowserPointer& event) {
    return event.tool == Tool::pen ? -2 - event.pointer_id : 1 + event.pointer_id;
}

// Returns the contact size, or NaN: a browser that does not know it reports 1 CSS px or 0.
double size_or_missing(double size_px, const BrowserPointer& event) {
    const bool told = event.tool == Tool::finger && (event.width_px > 1.5 || event.height_px > 1.5);
    return told ? size_px : kMissing;
}

Sample sample_of(const BrowserPointer& event, Phase phase, double t_host_s) {
    Sample sample;
    sample.t_host_s = t_host_s;
    sample.t_device_s = event.time_s;
    sample.pointer_id = number_of(event);
    sample.tool = event.tool;
    sample.phase = phase;
    sample.x_px = event.x_px;
    sample.y_px = event.y_px;
    sample.pressure = event.pressure;
    if (event.tool == Tool::pen) {
        sample.tilt_x_deg = event.tilt_x_deg;
        sample.tilt_y_deg = event.tilt_y_deg;
    }
    sample.width_px = size_or_missing(event.width_px, event);
    sample.height_px = size_or_missing(event.height_px, event);
    return sample;
}

// Returns the phase of an event. A pen's side button is no contact; a finger that moves is. Returns nothing for a
// finger that was never put down.
std::optional<Phase> phase_of(const BrowserPointer& event, bool touched) {
    using Kind = BrowserPointer::Kind;
    if (event.kind == Kind::cancel) return touched ? Phase::cancel : Phase::hover;
    const bool finger = event.tool == Tool::finger;
    const bool touches = event.kind != Kind::up && (finger || (event.buttons & (kTip | kOtherEnd)) != 0);
    if (touches && !touched && finger && event.kind != Kind::down) return std::nullopt;
    if (touches) return touched ? Phase::move : Phase::down;
    if (touched) return Phase::up;
    return finger ? std::nullopt : std::optional(Phase::hover);
}

// Tells the panels of a sample. Returns true if a panel keeps the press.
bool tell_panels(const Sample& sample, const Pointers& pointers) {
    using Kind = WindowEvent::Kind;
    const bool finger = sample.tool == Tool::finger;
    const bool cancelled = sample.phase == Phase::cancel;  // it must press no button
    const double x_px = cancelled ? kNowhere_px : sample.x_px;
    const double y_px = cancelled ? kNowhere_px : sample.y_px;
    const auto tell = [&](Kind kind) { return ask_filter(for_panels(kind, x_px, y_px, sample.pointer_id), pointers); };
    switch (sample.phase) {
        case Phase::down:
            if (!finger) tell(Kind::pointer_move);
            return tell(finger ? Kind::finger_down : Kind::button_down);
        case Phase::up:
        case Phase::cancel:
            return tell(finger ? Kind::finger_up : Kind::button_up);
        default:
            return tell(finger ? Kind::finger_move : Kind::pointer_move);
    }
}

void receive_mouse(const BrowserPointer& event, double t_host_s, Pointers& pointers) {
    Mouse& mouse = pointers.mouse;
    const bool pressed = (event.buttons & kTip) != 0;
    bool on_panel = ask_filter(for_panels(WindowEvent::Kind::pointer_move, event.x_px, event.y_px), pointers);
    mouse.x_px = event.x_px;
    mouse.y_px = event.y_px;
    if (event.kind == BrowserPointer::Kind::cancel) {
        mouse.button.down = false;
        cancel_gone(t_host_s, kMousePointerId, pointers.presses, pointers.pending);
    } else if (pressed && !mouse.button.down) {
        on_panel = ask_filter(for_panels(WindowEvent::Kind::button_down, event.x_px, event.y_px), pointers);
        press_mouse(t_host_s, event.time_s, mouse, pointers.made);
    } else if (!pressed && mouse.button.down) {
        on_panel = ask_filter(for_panels(WindowEvent::Kind::button_up, event.x_px, event.y_px), pointers);
        release_mouse(t_host_s, event.time_s, mouse, pointers.made);
    } else {
        move_mouse(t_host_s, event.time_s, event.x_px, event.y_px, mouse, pointers.made);
    }
    admit_made(owner_if(on_panel), pointers);
}

std::optional<PointerKey> pointer_key(int code) {
    switch (code) {
        case key::left:
            return PointerKey::left;
        case key::right:
            return PointerKey::right;
        case key::up:
            return PointerKey::up;
        case key::down:
            return PointerKey::down;
        case key::space:
            return PointerKey::press;
        case key::page_up:
            return PointerKey::harder;
        case key::page_down:
            return PointerKey::softer;
        default:
            return std::nullopt;
    }
}

}  // namespace

void receive(const BrowserPointer& event, double t_host_s, Pointers& pointers) {
    hold(t_host_s, pointers);
    pointers.seen[static_cast<std::size_t>(event.tool)] = true;
    if (event.tool == Tool::mouse) return receive_mouse(event, t_host_s, pointers);
    const std::int64_t number = number_of(event);
    auto& touching = pointers.touching;
    const auto known = std::find(touching.begin(), touching.end(), number);
    const auto phase = phase_of(event, known != touching.end());
    if (!phase) return;
    if (*phase == Phase::down) touching.push_back(number);
    if (*phase == Phase::up || *phase == Phase::cancel) touching.erase(known);
    const Sample sample = sample_of(event, *phase, t_host_s);
    const bool on_panel = tell_panels(sample, pointers);
    admit(sample, owner_if(on_panel), pointers.presses, pointers.pending);
}

void receive_wheel(double notches, double t_device_s, double t_host_s, Pointers& pointers) {
    hold(t_host_s, pointers);
    WindowEvent event = for_panels(WindowEvent::Kind::wheel, pointers.mouse.x_px, pointers.mouse.y_px);
    event.notches = notches;
    if (!ask_filter(event, pointers)) turn_wheel(t_host_s, t_device_s, notches, pointers.mouse, pointers.made);
    admit_made(PressOwner::tissue, pointers);
}

void receive_key(const WindowEvent& event, double t_host_s, Pointers& pointers) {
    hold(t_host_s, pointers);
    const bool on_panel = ask_filter(event, pointers);
    set_slow(t_host_s, event.shift, pointers.keyboard);
    const auto which = pointer_key(event.key);
    if (!which || event.repeat) return;
    if (event.kind == WindowEvent::Kind::key_up) {
        key_up(t_host_s, *which, pointers.keyboard, pointers.made);
    } else if (!on_panel) {
        key_down(t_host_s, *which, pointers.keyboard, pointers.made);
    }
    admit_made(PressOwner::tissue, pointers);
}

void release_all(double t_host_s, Pointers& pointers) {
    hold(t_host_s, pointers);
    pointers.mouse.button.down = false;
    release_keys(pointers.keyboard);
    cancel_all(t_host_s, pointers.presses, pointers.pending);
}

void hold(double t_host_s, Pointers& pointers) {
    hold_mouse_and_keys(t_host_s, pointers.mouse, pointers.keyboard, pointers.made);
    admit_made(PressOwner::tissue, pointers);
}

void forget_presses(Pointers& pointers) {
    cancel_all(0.0, pointers.presses, pointers.made);
    pointers.made.clear();
    pointers.pending.clear();
}

void set_keyboard_area(double t_host_s, const KeyboardArea& area, Pointers& pointers) {
    hold(t_host_s, pointers);
    set_area(area, pointers.keyboard);
    if (!is_on(pointers.keyboard)) cancel_gone(t_host_s, kKeyboardPointerId, pointers.presses, pointers.pending);
}

}  // namespace palpa::platform
