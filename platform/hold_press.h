#pragma once
// Another way to press for pens and fingers without a sensor: the longer they touch, the harder.

#include <cstdint>
#include <vector>

#include "platform/sample.h"

namespace palpa::platform {

// A pen or a finger that is touching.
struct HeldPointer {
    double down_s = 0.0;
    Sample last;  // as it went out last
};

struct HoldPress {
    bool pen = false;  // which tools press so
    bool finger = false;
    double hold_s = 2.0;  // from no pressure to full
    // what is going on
    std::vector<HeldPointer> held;
    std::int64_t last_tick = 0;  // grid points up to this one were looked at
    std::vector<Sample> merged;  // scratch
};

// Replaces the pressure of touching samples of the chosen tools by the share of the hold time that has passed;
// pressure_raw stays what the device said. Adds a sample, without a device time, at each grid point
// (kHoldGrid_Hz) up to and with `now_s` by which a pointer has sent none of its own for a whole grid step: one
// that is held still may send nothing. `samples` are those that came since the last call, in order of their host
// time, none after `now_s`; they stay in order, and how often it is called makes no difference.
void press_by_hold(double now_s, HoldPress& hold, std::vector<Sample>& samples);

}  // namespace palpa::platform
