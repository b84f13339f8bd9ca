#pragma once
// What the pulses of a shape display's pins mean, from heights that were measured.

#include <vector>

#include "devices/pins.h"

namespace palpa::devices {

// All pins were told the same height by a device file, and measured: height_m[i][pin] at wanted_m[i].
struct PinMeasurements {
    std::vector<double> wanted_m;
    std::vector<std::vector<double>> height_m;
};

struct PinCalibration {
    PinDevice device;       // with zero, gain and direction of each pin
    double before_m = 0.0;  // root mean square of measured minus wanted height
    double after_m = 0.0;   // what is left of it with the new zeros and gains
};

// Fits pulse = zero + gain * height to each pin by least squares. Throws std::runtime_error that names row and column of a
// pin that did not move by a tenth of the stroke, or whose zero or top lies outside of the pulses' range.
PinCalibration calibrate(const PinDevice& device, const PinMeasurements& measured);

}  // namespace palpa::devices
