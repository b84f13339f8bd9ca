#pragma once
// The choices of multi-material parts, each with its error and its cost: beams, finite cells, buttons.

#include "accuracy/accuracy.h"

namespace palpa::accuracy {

std::vector<Measurement> part_measurements(const Effort& effort);

}  // namespace palpa::accuracy
