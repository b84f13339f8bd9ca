#pragma once
// Events of a window for its panels: pointer, wheel, keys and text. Positions are in px of the drawing area.

#include <cstdint>
#include <string>

namespace palpa::platform {

// The number of a key: the ASCII code of what it types (lower-case letters), or one of these constants.
namespace key {
inline constexpr int backspace = 8, tab = 9, enter = 13, escape = 27, space = 32, del = 127;
inline constexpr int left = 256, right = 257, up = 258, down = 259, page_up = 260, page_down = 261, home = 262,
                     end = 263;
inline constexpr int f10 = 264, f11 = 265, f12 = 280;
inline constexpr int pad_enter = 266, pad_plus = 267, pad_minus = 268, pad_0 = 269;  // pad_0 + 1 ... pad_0 + 9 follow
inline constexpr int f1 = 279;
inline constexpr int count = 300;
inline constexpr int other = 0;  // any other key
}  // namespace key

struct WindowEvent {
    // button_*: the left button of a mouse, or a pen's tip.
    enum class Kind : std::uint8_t {
        pointer_move,
        button_down,
        button_up,
        wheel,
        finger_down,
        finger_move,
        finger_up,
        key_down,
        key_up,
        text
    };
    Kind kind = Kind::pointer_move;
    double x_px = 0.0;
    double y_px = 0.0;
    bool made_from_touch = false;  // a mouse event that the system derives from a finger's event
    std::int64_t finger_id = 0;
    double notches = 0.0;  // of a wheel, away from the person
    int key = key::other;
    bool ctrl = false;
    bool shift = false;
    bool repeat = false;  // the key is held
    std::string text;     // typed, UTF-8
};

// A filter returns true to keep a press for panels (Window::set_event_filter in window.h).
using EventFilter = bool (*)(const WindowEvent& event, void* user);

}  // namespace palpa::platform
