#include "platform/linux/pointers.h"

#include <SDL.h>
#include <algorithm>
#include <utility>

namespace palpa::platform {
namespace {

bool ask_filter(const WindowEvent& event, const Pointers& pointers) {
    return pointers.filter != nullptr && pointers.filter(event, pointers.filter_user);
}

bool ask_filter(const SDL_Event& event, const Pointers& pointers) {
    const auto for_panels = window_event(event, pointers.window);
    return for_panels && ask_filter(*for_panels, pointers);
}

PressOwner owner_if(bool on_panel) { return on_panel ? PressOwner::panel : PressOwner::tissue; }

void admit_made(PressOwner down_owner, Pointers& pointers) {
    for (const Sample& sample : pointers.made) {
        admit(sample, down_owner, pointers.presses, pointers.pending);
    }
    pointers.made.clear();
}

// Asks the filter about a pen's press. SDL's own event for the tip comes after the pen's event, too late to decide to
// whom the press belongs.
bool pen_on_panel(const Sample& sample, const Pointers& pointers) {
    WindowEvent event;
    event.kind = WindowEvent::Kind::button_down;
    event.x_px = sample.x_px;
    event.y_px = sample.y_px;
    return ask_filter(event, pointers);
}

// Asks the filter about a finger's press, since SDL reports no finger of a touch screen that was plugged in after the
// start.
bool finger_on_panel(const Sample& sample, const Pointers& pointers) {
    WindowEvent event;
    event.kind = WindowEvent::Kind::finger_down;
    event.finger_id = sample.pointer_id;
    event.x_px = sample.x_px;
    event.y_px = sample.y_px;
    return ask_filter(event, pointers);
}

bool down_on_panel(const Sample& sample, Pointers& pointers) {
    if (sample.phase != Phase::down) return false;
    if (sample.tool == Tool::pen) return pen_on_panel(sample, pointers);
    const std::optional<bool> known = std::exchange(pointers.finger_on_panel, std::nullopt);
    return known ? *known : finger_on_panel(sample, pointers);
}

void note_mover(const XiEvent& event, Pointers& pointers) {
    const XiState& state = pointers.xinput->state;
    const XiDevice* device = find_device(state, event.source_id);
    if (device == nullptr || event.device_id != event.source_id) return;
    pointers.mover = device->tool;
    pointers.mover_device_s = 1e-3 * static_cast<double>(state.clock.total_ms);
}

void renew_devices(double t_host_s, Pointers& pointers) {
    if (!pointers.xinput) return;
    for (const std::int64_t pointer_id : rescan(*pointers.xinput)) {
        cancel_gone(t_host_s, pointer_id, pointers.presses, pointers.pending);
    }
}

void receive_xinput(const SDL_Event& event, double t_host_s, Pointers& pointers) {
    XiEvent xi;
    switch (read_event(*pointers.xinput, event, xi)) {
        case XiNews::none:
            return;
        case XiNews::devices_changed:
            renew_devices(t_host_s, pointers);
            return;
        case XiNews::event:
            break;
    }
    const auto sample = decode(xi, t_host_s, pointers.xinput->state);
    note_mover(xi, pointers);
    if (!sample) return;
    const PressOwner owner = owner_if(down_on_panel(*sample, pointers));
    admit(*sample, owner, pointers.presses, pointers.pending);
}

// On X11 the device's own event has the time of the server's clock, which pens and fingers use too.
double mouse_device_s(Uint32 timestamp_ms, const Pointers& pointers) {
    return pointers.xinput ? pointers.mover_device_s : 1e-3 * timestamp_ms;
}

bool is_mouse(Uint32 which, const Pointers& pointers) {
    return which != SDL_TOUCH_MOUSEID && pointers.mover == Tool::mouse;
}

void receive_motion(const SDL_MouseMotionEvent& motion, double t_host_s, Pointers& pointers) {
    if (!is_mouse(motion.which, pointers)) return;
    const Scale scale = px_per_unit(pointers.window);
    move_mouse(t_host_s, mouse_device_s(motion.timestamp, pointers), motion.x * scale.x, motion.y * scale.y,
               pointers.mouse, pointers.made);
}

void receive_button(const SDL_MouseButtonEvent& button, double t_host_s, Pointers& pointers) {
    if (button.button != SDL_BUTTON_LEFT || !is_mouse(button.which, pointers)) return;
    const Scale scale = px_per_unit(pointers.window);
    const double t_device_s = mouse_device_s(button.timestamp, pointers);
    pointers.mouse.x_px = button.x * scale.x;
    pointers.mouse.y_px = button.y * scale.y;
    if (button.state == SDL_PRESSED) {
        press_mouse(t_host_s, t_device_s, pointers.mouse, pointers.made);
    } else {
        release_mouse(t_host_s, t_device_s, pointers.mouse, pointers.made);
    }
}

void receive_wheel(const SDL_MouseWheelEvent& wheel, double t_host_s, Pointers& pointers) {
    const double up = wheel.direction == SDL_MOUSEWHEEL_FLIPPED ? -1.0 : 1.0;
    turn_wheel(t_host_s, mouse_device_s(wheel.timestamp, pointers), up * static_cast<double>(wheel.preciseY),
               pointers.mouse, pointers.made);
}

// Takes a finger's event if there is no XInput2. SDL's finger pressure is always 1 here, so no pressure is reported.
void receive_finger(const SDL_TouchFingerEvent& finger, double t_host_s, Pointers& pointers) {
    int width_px = 0, height_px = 0;
    SDL_GL_GetDrawableSize(pointers.window, &width_px, &height_px);
    Sample sample;
    sample.t_host_s = t_host_s;
    sample.t_device_s = 1e-3 * finger.timestamp;
    sample.pointer_id = finger.fingerId + 1;
    sample.tool = Tool::finger;
    sample.phase = finger.type == SDL_FINGERDOWN ? Phase::down : finger.type == SDL_FINGERUP ? Phase::up : Phase::move;
    sample.x_px = static_cast<double>(finger.x) * width_px;
    sample.y_px = static_cast<double>(finger.y) * height_px;
    pointers.made.push_back(sample);
}

std::optional<PointerKey> pointer_key(SDL_Keycode key) {
    switch (key) {
        case SDLK_LEFT:
            return PointerKey::left;
        case SDLK_RIGHT:
            return PointerKey::right;
        case SDLK_UP:
            return PointerKey::up;
        case SDLK_DOWN:
            return PointerKey::down;
        case SDLK_SPACE:
            return PointerKey::press;
        case SDLK_PAGEUP:
            return PointerKey::harder;
        case SDLK_PAGEDOWN:
            return PointerKey::softer;
        default:
            return std::nullopt;
    }
}

void receive_key(const SDL_KeyboardEvent& key, bool on_panel, double t_host_s, Pointers& pointers) {
    set_slow(t_host_s, (key.keysym.mod & KMOD_SHIFT) != 0, pointers.keyboard);
    const auto which = pointer_key(key.keysym.sym);
    if (!which || key.repeat != 0) return;
    if (key.state == SDL_RELEASED) {
        key_up(t_host_s, *which, pointers.keyboard, pointers.made);
    } else if (!on_panel) {
        key_down(t_host_s, *which, pointers.keyboard, pointers.made);
    }
}

void receive_window(const SDL_WindowEvent& event, double t_host_s, Pointers& pointers) {
    if (event.event == SDL_WINDOWEVENT_CLOSE) pointers.close_requested = true;
    if (event.event == SDL_WINDOWEVENT_FOCUS_LOST) {
        pointers.mouse.button.down = false;
        release_keys(pointers.keyboard);
        cancel_all(t_host_s, pointers.presses, pointers.pending);
        // SDL releases all keys just before it reports that the focus is lost, though no key came up
        for (Sample& sample : pointers.pending) {
            if (sample.tool == Tool::keyboard && sample.phase == Phase::up) sample.phase = Phase::cancel;
        }
    }
    const bool other_screen =
        event.event == SDL_WINDOWEVENT_SIZE_CHANGED || event.event == SDL_WINDOWEVENT_DISPLAY_CHANGED;
    if (other_screen) renew_devices(t_host_s, pointers);
}

bool of_other_window(const SDL_Event& event, const Pointers& pointers) {
    const Uint32 ours = SDL_GetWindowID(pointers.window);
    switch (event.type) {
        case SDL_WINDOWEVENT:
            return event.window.windowID != ours;
        case SDL_MOUSEMOTION:
            return event.motion.windowID != ours;
        case SDL_MOUSEBUTTONDOWN:
        case SDL_MOUSEBUTTONUP:
            return event.button.windowID != ours;
        case SDL_MOUSEWHEEL:
            return event.wheel.windowID != ours;
        case SDL_KEYDOWN:
        case SDL_KEYUP:
            return event.key.windowID != ours;
        case SDL_FINGERDOWN:
        case SDL_FINGERMOTION:
        case SDL_FINGERUP:
            return event.tfinger.windowID != ours;
        default:
            return false;
    }
}

// True if the filter was asked about this pen's press already; it is asked about each press once.
bool told_before(const SDL_Event& event, const Pointers& pointers) {
    return event.type == SDL_MOUSEBUTTONDOWN && event.button.button == SDL_BUTTON_LEFT &&
           event.button.which != SDL_TOUCH_MOUSEID && pointers.mover == Tool::pen;
}

void receive_sdl(const SDL_Event& event, bool on_panel, double t_host_s, Pointers& pointers) {
    switch (event.type) {
        case SDL_QUIT:
            pointers.quit_requested = true;
            break;
        case SDL_DISPLAYEVENT:
            renew_devices(t_host_s, pointers);
            break;
        case SDL_WINDOWEVENT:
            receive_window(event.window, t_host_s, pointers);
            break;
        case SDL_MOUSEMOTION:
            receive_motion(event.motion, t_host_s, pointers);
            break;
        case SDL_MOUSEWHEEL:
            if (!on_panel) receive_wheel(event.wheel, t_host_s, pointers);
            break;
        case SDL_MOUSEBUTTONDOWN:
            // SDL also lets a first finger move the mouse, just before it reports the finger itself
            if (event.button.which == SDL_TOUCH_MOUSEID) pointers.finger_on_panel = on_panel;
            receive_button(event.button, t_host_s, pointers);
            break;
        case SDL_MOUSEBUTTONUP:
            receive_button(event.button, t_host_s, pointers);
            break;
        case SDL_KEYDOWN:
        case SDL_KEYUP:
            receive_key(event.key, on_panel, t_host_s, pointers);
            on_panel = false;  // a key that a panel took made no sample
            break;
        case SDL_FINGERDOWN:
            on_panel = on_panel || pointers.finger_on_panel.value_or(false);
            pointers.finger_on_panel = on_panel;
            [[fallthrough]];
        case SDL_FINGERMOTION:
        case SDL_FINGERUP:
            if (pointers.xinput) break;  // the touch itself comes next
            pointers.finger_on_panel.reset();
            receive_finger(event.tfinger, t_host_s, pointers);
            break;
        default:
            break;
    }
    admit_made(owner_if(on_panel), pointers);
}

void note_stir(const SDL_Event& event, Pointers& pointers) {
    if (event.type == SDL_POLLSENTINEL) return;
    pointers.stirred = true;
    if (event.type == SDL_WINDOWEVENT || event.type == SDL_DISPLAYEVENT) pointers.uncovered = true;
}

}  // namespace

void receive(const SDL_Event& event, double t_host_s, Pointers& pointers) {
    hold(t_host_s, pointers);
    note_stir(event, pointers);
    if (event.type == SDL_SYSWMEVENT) {
        if (pointers.xinput) receive_xinput(event, t_host_s, pointers);
        return;
    }
    if (event.type == SDL_POLLSENTINEL || of_other_window(event, pointers)) return;
    const bool on_panel = !told_before(event, pointers) && ask_filter(event, pointers);
    receive_sdl(event, on_panel, t_host_s, pointers);
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
    if (!is_on(pointers.keyboard)) {
        cancel_gone(t_host_s, kKeyboardPointerId, pointers.presses, pointers.pending);
    }
}

}  // namespace palpa::platform
