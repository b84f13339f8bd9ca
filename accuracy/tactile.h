#pragma once
// The choices of the shape display, each with its error and its cost: contact of the finger, table, sheet, steps of the
// pins, schedule.

#include "accuracy/accuracy.h"

namespace palpa::accuracy {

std::vector<Measurement> tactile_measurements(const Effort& effort);

// Root mean square (m) of wanted minus shown heights of one pin over presses of 4 mm (a fall and rise as a cosine, a
// gain of 0.4) at a greatest speed; the pins' servos are assumed (tactile/pin_estimate.h), the steps 0.1 mm.
// lead_s: how far ahead the commanded shape is; 0: free.
double schedule_mismatch_m(double speed_m_per_s, double lead_s, bool dither);

}  // namespace palpa::accuracy
