#include "platform/linux/window_event.h"

#include <SDL.h>

namespace palpa::platform {
namespace {

int key_of(SDL_Keycode code) {
    switch (code) {
        case SDLK_LEFT:
            return key::left;
        case SDLK_RIGHT:
            return key::right;
        case SDLK_UP:
            return key::up;
        case SDLK_DOWN:
            return key::down;
        case SDLK_PAGEUP:
            return key::page_up;
        case SDLK_PAGEDOWN:
            return key::page_down;
        case SDLK_HOME:
            return key::home;
        case SDLK_END:
            return key::end;
        case SDLK_F1:
            return key::f1;
        case SDLK_F10:
            return key::f10;
        case SDLK_F11:
            return key::f11;
        case SDLK_F12:
            return key::f12;
        case SDLK_KP_ENTER:
            return key::pad_enter;
        case SDLK_KP_PLUS:
            return key::pad_plus;
        case SDLK_KP_MINUS:
            return key::pad_minus;
        case SDLK_KP_0:
            return key::pad_0;
        default:
            break;
    }
    if (code >= SDLK_KP_1 && code <= SDLK_KP_9) return key::pad_0 + 1 + (code - SDLK_KP_1);
    return code > 0 && code <= key::del ? code : key::other;  // SDL's codes of keys that type are ASCII too
}

WindowEvent of_key(const SDL_KeyboardEvent& key) {
    WindowEvent out;
    out.kind = key.state == SDL_PRESSED ? WindowEvent::Kind::key_down : WindowEvent::Kind::key_up;
    out.key = key_of(key.keysym.sym);
    out.ctrl = (key.keysym.mod & KMOD_CTRL) != 0;
    out.shift = (key.keysym.mod & KMOD_SHIFT) != 0;
    out.repeat = key.repeat != 0;
    return out;
}

WindowEvent of_finger(const SDL_TouchFingerEvent& finger, SDL_Window* window) {
    int width_px = 0, height_px = 0;
    SDL_GL_GetDrawableSize(window, &width_px, &height_px);
    WindowEvent out;
    out.kind = finger.type == SDL_FINGERDOWN ? WindowEvent::Kind::finger_down
               : finger.type == SDL_FINGERUP ? WindowEvent::Kind::finger_up
                                             : WindowEvent::Kind::finger_move;
    out.finger_id = finger.fingerId;
    out.x_px = static_cast<double>(finger.x) * width_px;
    out.y_px = static_cast<double>(finger.y) * height_px;
    return out;
}

WindowEvent of_mouse(WindowEvent::Kind kind, Uint32 which, int x, int y, SDL_Window* window) {
    const Scale scale = px_per_unit(window);
    WindowEvent out;
    out.kind = kind;
    out.made_from_touch = which == SDL_TOUCH_MOUSEID;
    out.x_px = x * scale.x;
    out.y_px = y * scale.y;
    return out;
}

}  // namespace

Scale px_per_unit(SDL_Window* window) {
    int width = 0, height = 0, width_px = 0, height_px = 0;
    SDL_GetWindowSize(window, &width, &height);
    SDL_GL_GetDrawableSize(window, &width_px, &height_px);
    if (width <= 0 || height <= 0) return {};
    return {static_cast<double>(width_px) / width, static_cast<double>(height_px) / height};
}

std::optional<WindowEvent> window_event(const SDL_Event& event, SDL_Window* window) {
    WindowEvent out;
    switch (event.type) {
        case SDL_MOUSEMOTION:
            return of_mouse(WindowEvent::Kind::pointer_move, event.motion.which, event.motion.x, event.motion.y,
                            window);
        case SDL_MOUSEBUTTONDOWN:
        case SDL_MOUSEBUTTONUP:
            if (event.button.button != SDL_BUTTON_LEFT) return std::nullopt;
            return of_mouse(
                event.type == SDL_MOUSEBUTTONDOWN ? WindowEvent::Kind::button_down : WindowEvent::Kind::button_up,
                event.button.which, event.button.x, event.button.y, window);
        case SDL_MOUSEWHEEL:
            out.kind = WindowEvent::Kind::wheel;
            out.notches = event.wheel.y;
            return out;
        case SDL_FINGERDOWN:
        case SDL_FINGERMOTION:
        case SDL_FINGERUP:
            return of_finger(event.tfinger, window);
        case SDL_KEYDOWN:
        case SDL_KEYUP:
            return of_key(event.key);
        case SDL_TEXTINPUT:
            out.kind = WindowEvent::Kind::text;
            out.text = event.text.text;
            return out;
        default:
            return std::nullopt;
    }
}

}  // namespace palpa::platform
