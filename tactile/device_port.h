#pragma once
// The devices of a plan as the loop sees them. A process of its own holds their ports, and guards what goes there
// (devices/shape_guard.h).
//
// Three threads may meet here: the loop calls read() and send(); any thread may call stop() and release().

#include <atomic>
#include <memory>
#include <string>

#include "devices/shape_guard.h"
#include "tactile/loop.h"

namespace palpa::tactile {

// The guard and what it stands between, real devices or simulated ones.
struct Guarded {
    devices::Limits limits;
    devices::Guard guard;
};
Guarded guarded_of(const TactilePlan& plan);

// Replaces what a command says to arm and pins by what may be sent now. Nothing reaches a wire but through here.
// `fresh`: whether the arm was heard since the last call; `arm`: its newest feedback, null without an arm; `found`: what
// the driver of the pins has found.
void guard_command(double now_s, bool fresh, const devices::ArmFeedback* arm, devices::Fault found,
                   LoopCommand& command, Guarded& guarded) noexcept;

// Real devices, or simulators that speak their protocols.
class DevicePort {
  public:
    // Starts the guard, which opens what the plan has. Throws std::runtime_error with the guard's or the system's reason.
    explicit DevicePort(const TactilePlan& plan);
    ~DevicePort();  // arm and pins rest
    DevicePort(const DevicePort&) = delete;
    DevicePort& operator=(const DevicePort&) = delete;

    // Waits until the arm was heard, its force sensor has its zero, and every board of the pins has proved that it is safe.
    // Throws std::runtime_error that says what is missing after `most_s`.
    void wait_until_ready(double most_s);

    // The arm's newest feedback; without an arm, zeros. Always true: a step that hears nothing new works on the last feedback.
    bool read(LoopFeedback& feedback) noexcept;
    void send(double now_s, const LoopCommand& command) noexcept;

    void stop() noexcept;     // F12: latched
    void release() noexcept;  // a person's wish to go on

    devices::Fault fault() const noexcept { return guarded_.guard.fault; }  // by the loop's thread
    const Guarded& guarded() const noexcept { return guarded_; }            // once the loop has ended
    const devices::LinkHealth* link() const { return arm_ ? &guard_->link() : nullptr; }
    devices::PinHealth pins() const { return guard_ ? guard_->newest().pins : devices::PinHealth{}; }

  private:
    std::unique_ptr<devices::ShapeGuard> guard_;  // null where there is nothing to open
    std::size_t pins_count_ = 0;
    bool arm_ = false;
    Guarded guarded_;  // the guard's own, as it reports it
    std::atomic<bool> stopped_{false};
};

}  // namespace palpa::tactile
