#pragma once
// Detects whether a device really measures pressure, or the size of a touch. A pen or touch screen without a sensor reports a
// constant (0, 0.5, 1; the same size for every touch) or nothing at all; the person should then be told, and be offered another
// way to press.

#include <array>
#include <cstdint>

#include "platform/sample.h"

namespace palpa::platform {

enum class PressureKind : std::uint8_t {
    unknown,   // too few samples yet
    varies,    // the device has a sensor
    constant,  // the same value in each sample of at least 0.5 s and 30 samples
    missing    // touching samples come without pressure
};

// What one tool has sent, all its pointers together.
struct ToolPressure {
    std::int64_t without = 0;  // touching samples without pressure
    std::int64_t with = 0;     // touching samples with pressure, without the first of each press
    double first = kMissing;   // pressure of the first such sample
    bool changed = false;
    double touching_s = 0.0;     // time between samples of a touch, summed
    double last_s = kMissing;    // time of the sample before; missing while nothing touches
    std::int64_t with_size = 0;  // touching samples with a contact ellipse, without the first of each press
    double first_size_px[2] = {kMissing, kMissing};
    bool size_changed = false;
};

struct PressureWatch {
    std::array<ToolPressure, kToolCount> tools;
};

// Takes every sample, before press_by_hold() changes its pressure. Allocates nothing. The first sample of a press is
// not compared, since some pens report a wrong pressure in it (scene/advance.cpp).
void watch(const Sample& sample, PressureWatch& watch);

// Returns the verdict so far; if a constant changes later, so does the verdict.
PressureKind pressure_kind(const PressureWatch& watch, Tool tool);

// Whether all touches of at least 5 s and 300 samples had the same size. (A size has few steps, so that a steady press may well
// keep one for a second.)
bool has_constant_size(const PressureWatch& watch, Tool tool);

// Returns the value that never changed; NaN unless the kind is constant.
double constant_pressure(const PressureWatch& watch, Tool tool);

}  // namespace palpa::platform
