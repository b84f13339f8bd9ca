#pragma once
// What is allowed in a device file and yet seldom meant.

#include "tangible/device_model.h"

namespace palpa::tangible {

// Warnings: of the mesh; a motion that nothing resists, by its name; one linear tetrahedron through a wall, with the
// wall's number of cells.
std::vector<std::string> device_warnings(const DeviceModel& model);

double weight_N(const DeviceModel& model);  // of the body on earth, whether it is simulated or not

// "left, right: same force and same motion"
std::string describe(const SoftDevice& device, const SoftTie& tie);

}  // namespace palpa::tangible
