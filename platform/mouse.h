#pragma once
// A mouse has no pressure sensor. It presses harder the longer its button is held, or with the level that its wheel
// sets.

#include <cstdint>
#include <vector>

#include "platform/held_pressure.h"
#include "platform/sample.h"

namespace palpa::platform {

inline constexpr std::int64_t kMousePointerId = 0;  // fingers count from 1, pens down from -2; the keyboard is -1

struct Mouse {
    HeldPressure button;
    double x_px = 0.0;
    double y_px = 0.0;
    std::int64_t last_tick = 0;  // grid points up to this one have their sample
};

// While the button is held: appends one sample for each grid point up to and including `t_host_s` that has none yet. To
// be called before any other sample of that time, so that samples stay in order. These samples have no device time,
// since no device sent them.
void hold_mouse(double t_host_s, Mouse& mouse, std::vector<Sample>& out);

// Append a sample for each event of the mouse: hover or move, down, up.
void move_mouse(double t_host_s, double t_device_s, double x_px, double y_px, Mouse& mouse, std::vector<Sample>& out);
void press_mouse(double t_host_s, double t_device_s, Mouse& mouse, std::vector<Sample>& out);
void release_mouse(double t_host_s, double t_device_s, Mouse& mouse, std::vector<Sample>& out);

// Turns the wheel; notches away from the person press harder. Appends a sample if the button is down.
void turn_wheel(double t_host_s, double t_device_s, double notches, Mouse& mouse, std::vector<Sample>& out);

}  // namespace palpa::platform
