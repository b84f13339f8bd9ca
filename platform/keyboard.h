#pragma once
// A pointer moved by keys: arrows move its cursor; the press key presses harder the longer it is held, or with the
// level that the level keys set.

#include <array>
#include <cstdint>
#include <vector>

#include "platform/held_pressure.h"
#include "platform/mouse.h"
#include "platform/sample.h"

namespace palpa::platform {

// Pointer numbers of pens count down from -2 (platform/mouse.h).
inline constexpr std::int64_t kKeyboardPointerId = -1;
inline constexpr double kSlowShare = 0.2;  // share of the speed while Shift is held

enum class PointerKey : std::uint8_t { left, right, up, down, press, harder, softer };

// Where the cursor may move, and how fast. An empty area turns the pointer off.
struct KeyboardArea {
    double x0_px = 0.0;
    double y0_px = 0.0;
    double x1_px = 0.0;
    double y1_px = 0.0;
    double speed_px_per_s = 0.0;
};

struct Keyboard {
    KeyboardArea area;
    KeyboardArea left;  // the area before the pointer was turned off
    HeldPressure button;
    double x_px = 0.0;  // the cursor, at moved_s
    double y_px = 0.0;
    double moved_s = 0.0;
    std::array<bool, 4> held{};  // left, right, up, down
    bool slow = false;           // Shift is held
    std::int64_t last_tick = 0;  // grid points up to this one have their sample
};

bool is_on(const Keyboard& keyboard);
bool key_held(const Keyboard& keyboard);  // an arrow or the press key is held: samples come without events

// Sets a new area, into which the cursor is moved. It starts in the middle if the pointer was off, but stays where it was if
// the area is that before, as after a page of help. If the area turns the pointer off, all keys are released; the caller
// cancels a press in progress.
void set_area(const KeyboardArea& area, Keyboard& keyboard);

// While a key is held: appends one sample for each grid point up to and including `t_host_s` that has none yet, with
// phase hover, or move while the press key is down. To be called before any other sample of that time, so that samples
// stay in order. No sample of a keyboard has a device time.
void hold_keys(double t_host_s, Keyboard& keyboard, std::vector<Sample>& out);

// Appends the samples of hold_mouse() and hold_keys() in order of time.
void hold_mouse_and_keys(double t_host_s, Mouse& mouse, Keyboard& keyboard, std::vector<Sample>& out);

// Take a key that goes down or comes up; hold_keys() must be called with the same time first. They append a sample if
// something changes: a press begins or ends, an arrow is released (the cursor stops), or the level changes during a
// press. They ignore all keys while the pointer is off, and a key that is held already.
void key_down(double t_host_s, PointerKey key, Keyboard& keyboard, std::vector<Sample>& out);
void key_up(double t_host_s, PointerKey key, Keyboard& keyboard, std::vector<Sample>& out);

void set_slow(double t_host_s, bool slow, Keyboard& keyboard);  // Shift

// Releases all keys without a sample; the caller cancels the press.
void release_keys(Keyboard& keyboard);

}  // namespace palpa::platform
