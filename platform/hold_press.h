#pragma once
// Another way to press for pens and fingers without a sensor: they press harder the longer they touch.

#include <cstdint>
#include <vector>

#include "platform/sample.h"

namespace palpa::platform {

// A pen or a finger that is touching.
struct HeldPointer {
    double down_s = 0.0;
    Sample last;  // the sample that went out last
};

struct HoldPress {
    bool pen = false;  // which tools press by time
    bool finger = false;
    double hold_s = 2.0;  // from no pressure to full
    // the presses that go on
    std::vector<HeldPointer> held;
    std::int64_t last_tick = 0;  // grid points up to this one were looked at
    std::vector<Sample> merged;  // scratch
};

// Replaces the pressure of touching samples of the chosen tools by the share of the hold time that has passed;
// pressure_raw stays what the device said. Adds a sample, without a device time, at each grid point
// (kHoldGrid_Hz) up to and with `now_s` by which a pointer has sent no sample of its own for a whole grid step,
// since a device that is held still may send nothing. `samples` are those that came since the last call, in order of
// their host time, none after `now_s`; they stay in order. How often this function is called makes no difference.
void press_by_hold(double now_s, HoldPress& hold, std::vector<Sample>& samples);

}  // namespace palpa::platform
