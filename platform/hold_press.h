#pragma once
// Another way to press for pens and fingers without a sensor: they press harder the longer they touch.

#include <cstdint>
#include <vector>

#include "platform/sample.h"

namespace palpa::platform {

// A pen or a finger that is touching.
struct HeldPointer {
    double down_s = 0.0;
    Sample last;  // the last sample passed on
};

struct HoldPress {
    bool pen = false;  // which tools press by time
    bool finger = false;
    double hold_s = 2.0;  // from no pressure to full
    // the current presses
    std::vector<HeldPointer> held;
    std::int64_t last_tick = 0;  // grid points up to this one were looked at
    std::vector<Sample> merged;  // scratch
};

// Replaces the pressure of touching samples of the chosen tools by the share of the hold time that has passed;
// pressure_raw stays as the device reported it. A device that is held still may send nothing, so a sample without a
// device time is added at each grid point (kHoldGrid_Hz) up to and including `now_s` at which a pointer has sent no
// sample of its own for a whole grid step. `samples` are those that arrived since the last call, in order of their host
// time, none after `now_s`; they stay in order. The result does not depend on how often this function is called.
void press_by_hold(double now_s, HoldPress& hold, std::vector<Sample>& samples);

}  // namespace palpa::platform
