#pragma once
// What a person does with keys and mouse, as events of the system; Window::poll() hands them over.

#include <SDL.h>

#include "platform/window.h"

namespace palpa::test {

inline void send_key(const platform::Window& window, Uint32 type, SDL_Keycode code, Uint16 mods = KMOD_NONE) {
    SDL_Event event{};
    event.type = type;
    event.key.windowID = SDL_GetWindowID(window.sdl());
    event.key.state = type == SDL_KEYDOWN ? SDL_PRESSED : SDL_RELEASED;
    event.key.keysym.sym = code;
    event.key.keysym.mod = mods;
    SDL_PushEvent(&event);
}

inline void tap(const platform::Window& window, SDL_Keycode code, Uint16 mods = KMOD_NONE) {
    send_key(window, SDL_KEYDOWN, code, mods);
    send_key(window, SDL_KEYUP, code, mods);
}

inline void type(const platform::Window& window, char letter) {
    send_key(window, SDL_KEYDOWN, letter);
    SDL_Event event{};
    event.type = SDL_TEXTINPUT;
    event.text.windowID = SDL_GetWindowID(window.sdl());
    event.text.text[0] = letter;
    SDL_PushEvent(&event);
    send_key(window, SDL_KEYUP, letter);
}

inline void move_mouse(const platform::Window& window, int x_px, int y_px) {
    SDL_Event event{};
    event.type = SDL_MOUSEMOTION;
    event.motion.windowID = SDL_GetWindowID(window.sdl());
    event.motion.x = x_px;
    event.motion.y = y_px;
    SDL_PushEvent(&event);
}

inline void button(const platform::Window& window, bool down, int x_px, int y_px) {
    SDL_Event event{};
    event.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
    event.button.windowID = SDL_GetWindowID(window.sdl());
    event.button.button = SDL_BUTTON_LEFT;
    event.button.state = down ? SDL_PRESSED : SDL_RELEASED;
    event.button.x = x_px;
    event.button.y = y_px;
    SDL_PushEvent(&event);
}

inline void click(const platform::Window& window, int x_px, int y_px) {
    for (const bool down : {true, false}) button(window, down, x_px, y_px);
}

}  // namespace palpa::test
