#pragma once
// The guard's side of arm and pins: it takes commands from a socket, and alone drives both.

#include "devices/shape_guard.h"

namespace palpa::devices::guard {

// Runs until the other end of the socket is closed or `ended` is set, then everything rests. Throws std::runtime_error before
// the first report if a port cannot be opened.
void serve_shape(const ShapeRig& rig, int socket, const volatile int& ended);

}  // namespace palpa::devices::guard
