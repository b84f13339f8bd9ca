#pragma once
// The choices of a soft device, each with the error of the force that it renders and the cost of a tick: element and mesh, law,
// fidelity, bearings, command, rate of the sensor, speed of the finger.

#include <filesystem>

#include "accuracy/accuracy.h"

namespace palpa::accuracy {

// devices: folder of strip.json and accordion.json.
std::vector<Measurement> tangible_measurements(const Effort& effort, const std::filesystem::path& devices);

// Writes tangible.gp beside tangible.csv in `folder` and runs gnuplot on it: tangible.png, .svg, .pdf. Returns in words what
// went wrong; empty on success. Throws std::runtime_error if tangible.gp cannot be written.
std::string plot_tangible(const std::filesystem::path& folder, const Machine& machine);

}  // namespace palpa::accuracy
