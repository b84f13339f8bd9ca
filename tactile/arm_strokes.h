#pragma once
// Strokes on a force arm: a hand goes down and up, the arm renders a law, and what happens is recorded once per millisecond.
// The same function runs with an arm (or its simulator) on the link and with a simulated one in this process.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/arm_link.h"
#include "devices/limits.h"
#include "devices/press_file.h"
#include "devices/simulators/arm_plant.h"
#include "tactile/arm_compensation.h"

namespace palpa::tactile {

// What strokes talk to.
class ArmRig {
  public:
    virtual ~ArmRig() = default;
    // Waits for the next millisecond and returns its time, s.
    virtual double next_tick() = 0;
    virtual bool read(devices::ArmFeedback& out) noexcept = 0;
    virtual void send(const devices::ArmCommand& command) noexcept = 0;
    // Null where there is no link.
    virtual const devices::LinkHealth* link() const { return nullptr; }
};

// An arm on the link, in real time.
std::unique_ptr<ArmRig> open_rig(const devices::ArmDevice& device);
// A simulated arm in this process, without waiting. What it says is a millisecond old, as on the link.
std::unique_ptr<ArmRig> virtual_rig(devices::simulators::ArmPlant plant);

struct StrokeOptions {
    std::string arm = "arm";  // its name and address, for messages
    double seconds = 0.0;
    // The force to render, N against the press, at a depth of the arm (m); it is asked from the surface down only.
    std::function<double(double depth_m)> law;
    std::optional<ArmCompensation> compensation;
    devices::Limits limits;
    std::function<void(double done_s)> progress;  // ten times a second, may be empty
};

struct Strokes {
    std::vector<StrokeRow> rows;
    devices::Guard guard;
    std::int64_t late_ticks = 0;  // that began over 1 ms late
    double delay_s = 0.0;         // median, from what the arm says to the command that follows from it, there and back
};

// Waits up to 2 s for the sensor's zero, then strokes. Throws std::runtime_error if nothing answers, if a fault
// stopped the arm for good, or if arm or sensor was silent for half a second; the sensor's silence ends the strokes at once.
Strokes run_strokes(const StrokeOptions& options, ArmRig& rig);

// Paths for a hand, as rows of a PRESS. Slow strokes over the whole range for a fit: at five speeds, the slower ones over
// less. 39 s for 50 mm.
std::vector<devices::PressRow> slow_strokes(double lowest_m, double deepest_m);
// Cycles from 2 mm above the surface to a depth and back, each of cycle_s below the surface, at an even speed.
std::vector<devices::PressRow> cycles(double depth_m, int count, double cycle_s);

}  // namespace palpa::tactile
