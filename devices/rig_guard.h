#pragma once
// The guard between the loop of a soft device and its wires (limits.h has that of arm and pins). What passes is finite, within
// each actuator's range, changes no faster than its rate, and adds up to no more than the total force. Any fault relaxes
// everything and stays until release(). Pure functions without thread or port; nothing here allocates or throws.

#include <array>
#include <cstdint>
#include <span>

#include "devices/limits.h"
#include "devices/rig.h"

namespace palpa::devices {

inline constexpr double kLoopSilence_s = 0.1;

struct RigGuard {
    Fault fault = Fault::none;
    bool driven = false;       // a command came since the start or the last release; else all is relaxed
    double commanded_s = 0.0;  // when it came last
    std::array<double, kMostChannels> value{};  // that may be sent now
    std::array<std::int64_t, kFaults> count{};  // how often each fault began
    std::int64_t limited = 0;                   // commands out of an actuator's range
    std::int64_t slewed = 0;                    // that wanted to change too fast
    std::int64_t scaled = 0;                    // that added up to too much force
};

RigGuard make_rig_guard(const ActuatorRig& rig);

// To be called at least every few milliseconds. `found`: what the drivers of the lines and the sensor say.
void watch(const ActuatorRig& rig, double now_s, Fault found, RigGuard& guard) noexcept;

// A command of the loop, in the rig's order. Another number of values than the rig has channels, and a value that is not finite,
// are the fault not_a_number.
void take_command(const ActuatorRig& rig, double now_s, std::span<const double> wanted, RigGuard& guard) noexcept;

// Relaxes everything for good. A fault that is there already stays.
void latch(const ActuatorRig& rig, Fault fault, RigGuard& guard) noexcept;
// A person's wish to go on: everything starts from rest.
void release(const ActuatorRig& rig, RigGuard& guard) noexcept;

}  // namespace palpa::devices
