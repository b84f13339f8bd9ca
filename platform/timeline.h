#pragma once
// One time for everything that evolves: the device's clock converted to the host's. The host stamps the samples of one
// frame at almost the same moment; the device's clock tells how far apart they are, but runs at a different rate.

#include <cstdint>

#include "platform/sample.h"

namespace palpa::platform {

struct Timeline {
    double now_s = 0.0;  // never goes back
    bool started = false;
    double offset_s = 0.0;  // host - device; meaningless before has_offset
    bool has_offset = false;
    double device_s = 0.0;         // device time of the sample before
    std::int64_t backwards = 0;    // samples from the past, not accepted
    std::int64_t late = 0;         // samples behind others, of a clock that goes on or by a frame at most: taken now
    std::int64_t duplicates = 0;   // samples with the same time as the one before
    std::int64_t clock_jumps = 0;  // the device's clock was set, or another device took over
};

// Moves `now_s` to the sample's time and returns true. For a sample more than 0.1 s in the past it leaves `now_s` as it
// is and returns false; the limit is 0.1 s because sources without a clock of their own may run ahead of the others by
// a frame. The offset follows the smallest delay seen: it falls by at most a tenth of the time that passes, and rises
// by at most 200 ppm, so that the order is kept.
bool move_to(const Sample& sample, Timeline& timeline);

}  // namespace palpa::platform
