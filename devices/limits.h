#pragma once
// The guard between every loop and the wire. Whatever the loop wants, what passes is finite, within range, changes no
// faster than allowed, and rests after a silence or a fault. Pure functions without thread or port, so that a process of
// its own can run them too. Nothing here allocates or throws.
//
// Once per tick:  begin_tick(), then guard_arm() and guard_pins() for what the scene drives.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "devices/arm.h"
#include "devices/pins.h"

namespace palpa::devices {

enum class Fault : std::uint8_t {
    none,
    stopped,          // by a person (F12)
    not_a_number,     // a command that is not finite
    silence,          // nothing comes from the arm, the force sensor that it follows, or a board of the pins
    out_of_range,     // the arm says that it is where it cannot be
    too_fast,         // the arm moves faster than a hand may
    board_error,      // a board of the pins reports errors again and again
    timeout_missing,  // a board would hold its pins when Palpa is gone
    crc_missing,      // a board would take garbled targets
    loop_silent,      // nothing came from the loop for 100 ms
    parent_gone,      // the program that runs the loop has ended
    guard_gone,       // the guard's process has ended
    arm_error,        // the arm says that it has a fault of its own
    guard_silent,     // the guard's process is there and tells nothing; passes by itself
};
inline constexpr std::size_t kFaults = 14;
std::string_view text(Fault fault);

// Whether the fault stays until release(). silence, guard_silent and too_fast pass by themselves.
bool latches(Fault fault);

struct Limits {
    double force_N = 2.5;  // the force that is rendered lies in [0, force_N]
    double feedforward_N = 15.0;
    double force_slew_N_per_s = 1000.0;  // a fault's fall to zero is not held back
    double lowest_m = -0.01;
    double deepest_m = 0.05;
    double range_slack_m = 0.01;  // so far beyond the range the arm's word is a fault
    double depth_slew_m_per_s = 0.2;
    double speed_m_per_s = 1.0;
    double pin_lowest_m = 0.0;
    double pin_highest_m = 2e-3;
    double pin_rest_m = 0.0;
    double pin_slew_m_per_s = 0.12;
    double silence_s = 0.1;
};

// Limits of the devices that are there; null: none. force_limit_N: the scene's; the lower one counts. Pins may be told to
// move four times as fast as they can: that holds back what is wild, and delays nothing that a servo could follow.
Limits limits_of(const ArmDevice* arm, const PinDevice* pins, double force_limit_N);

// What the guard remembers.
struct Guard {
    Fault fault = Fault::none;  // what holds now: with anything but none, all rests
    double now_s = 0.0;
    double dt_s = 0.0;
    double heard_s = 0.0;  // when feedback came last
    bool begun = false;
    double force_N = 0.0;                      // sent last
    double feedforward_N = 0.0;                // sent last
    double depth_m = 0.0;                      // sent last in mode position; otherwise where the arm is
    bool has_depth = false;                    // the arm has said where it is
    std::array<double, kMostPins> height_m{};  // sent last
    bool has_heights = false;
    std::array<std::int64_t, kFaults> count{};  // how often each fault began
    std::int64_t limited = 0;                   // commands that were out of range
    std::int64_t slewed = 0;                    // commands that wanted to change too fast
};

// What the state of the pins means for the guard; none while they are proved or driven.
Fault fault_of(PinState pins) noexcept;

// `fresh`: whether feedback came in this tick. `in`: the newest feedback, null without an arm. `found`: what a driver says.
void begin_tick(const Limits& limits, double now_s, bool fresh, const ArmFeedback* in, Guard& guard,
                Fault found = Fault::none) noexcept;

// Replaces the command by what may be sent.
void guard_arm(const Limits& limits, ArmCommand& command, Guard& guard) noexcept;

// The same for heights (m, 0 the lowest; at most kMostPins).
void guard_pins(const Limits& limits, std::span<double> heights_m, Guard& guard) noexcept;

// F12. Latched.
void stop(Guard& guard) noexcept;
// A fault that somebody else found. It does not replace one that is latched; one that passes lasts for this tick.
void latch(Fault fault, Guard& guard) noexcept;
// A person's wish to go on. Everything starts from rest.
void release(Guard& guard) noexcept;

}  // namespace palpa::devices
