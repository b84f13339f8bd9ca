#pragma once
// The choices of multi-material parts, each with its error and its cost: beams, finite cells, buttons.

#include "accuracy/accuracy.h"

namespace palpa::accuracy {

std::vector<Measurement> part_measurements(const Effort& effort);

// parts.gp beside parts.csv, as plot_list().
std::string plot_parts(const std::filesystem::path& folder, const Machine& machine);

}  // namespace palpa::accuracy
