#pragma once
// Arm and pins behind the guard's process, which alone holds their ports and limits (limits.h). Everything rests, for good, after
// 100 ms without a command, after stop() and when this program ends, however that happens; the other faults are as in
// limits.h.

#include <optional>
#include <type_traits>

#include "devices/arm_link.h"
#include "devices/guard_process.h"
#include "devices/limits.h"

namespace palpa::devices {

struct ShapeRig {
    std::optional<ArmDevice> arm;
    std::optional<PinDevice> pins;
    double force_limit_N = 0.0;  // the scene's; the lower one of it and the arm's counts
};
files::Json shape_rig_json(const ShapeRig& rig);
ShapeRig read_shape_rig(files::JsonReader reader);
Limits limits_of(const ShapeRig& rig);

// A command's values: those of the arm (force_N, feedforward_N, depth_m, mode), then the heights of the pins.
inline constexpr std::size_t kArmValues = 4;

struct ShapeReport {
    Fault fault = Fault::none;
    bool ready = false;  // the arm was heard, its force sensor has its zero, every board of the pins is proved
    bool arm_heard = false;
    std::array<std::int64_t, kFaults> count{};  // as in Guard
    std::int64_t limited = 0, slewed = 0;
    ArmFeedback arm;                                    // newest
    std::int64_t arm_readings = 0;                      // so far
    std::int64_t sent = 0, unsent = 0, arm_rested = 0;  // as in LinkHealth
    SensorHealth arm_feedback;
    PinHealth pins;
};
static_assert(std::is_trivially_copyable_v<ShapeReport>);

class ShapeGuard {
  public:
    // Throws like GuardLink.
    explicit ShapeGuard(const ShapeRig& rig, const std::string& program = guard_program());

    void send(const ArmCommand& arm, std::span<const double> pins_m) noexcept;  // never waits
    // Takes the reports that have come; by one thread. Returns whether there was any. Once the guard has ended, its fault is
    // guard_gone.
    bool poll() noexcept;
    const ShapeReport& newest() const { return newest_; }
    const LinkHealth& link() const { return link_health_; }  // of the arm

    void stop() noexcept { link_.send(GuardWord::stop); }
    void release() noexcept { link_.send(GuardWord::release); }
    pid_t pid() const { return link_.pid(); }

  private:
    GuardLink link_;
    ShapeReport newest_;
    double reported_s_ = 0.0;  // when that came
    LinkHealth link_health_;
};

}  // namespace palpa::devices
