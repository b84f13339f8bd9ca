#pragma once
// The guard's side of a soft device: it takes commands from a socket, and alone drives the lines and reads the sensor.

#include "devices/rig.h"

namespace palpa::devices::guard {

// Runs until the other end of the socket is closed or `ended` is set, then relaxes everything. Throws std::runtime_error before
// the first report if a port cannot be opened.
void serve_rig(const ActuatorRig& rig, int socket, const volatile int& ended);

}  // namespace palpa::devices::guard
