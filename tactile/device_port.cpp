#include "tactile/device_port.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "files/clock.h"

namespace palpa::tactile {

Guarded guarded_of(const TactilePlan& plan) {
    Guarded guarded;
    guarded.limits = devices::limits_of(plan.arm ? &*plan.arm : nullptr, plan.pin_device ? &*plan.pin_device : nullptr,
                                        plan.options.force_limit_N);
    return guarded;
}

void guard_command(double now_s, bool fresh, const devices::ArmFeedback* arm, devices::Fault found,
                   LoopCommand& command, Guarded& guarded) noexcept {
    devices::begin_tick(guarded.limits, now_s, fresh || arm == nullptr, arm, guarded.guard, found);
    if (arm != nullptr) devices::guard_arm(guarded.limits, command.arm, guarded.guard);
    if (command.pins > 0) {
        const auto n = static_cast<std::size_t>(command.pins);
        devices::guard_pins(guarded.limits, {command.pins_m.data(), n}, guarded.guard);
    }
}

DevicePort::DevicePort(const TactilePlan& plan)
    : pins_count_(plan.pin_device ? plan.pin_device->pins.size() : 0),
      arm_(plan.arm.has_value()),
      guarded_(guarded_of(plan)) {
    if (arm_ || pins_count_ > 0)
        guard_ = std::make_unique<devices::ShapeGuard>(
            devices::ShapeRig{plan.arm, plan.pin_device, plan.options.force_limit_N});
}

DevicePort::~DevicePort() = default;

void DevicePort::wait_until_ready(double most_s) {
    if (!guard_) return;
    const devices::ShapeReport& now = guard_->newest();
    for (const double until_s = files::steady_s() + most_s; files::steady_s() < until_s;) {
        guard_->poll();
        if (now.ready) return;
        if (now.fault == devices::Fault::guard_gone) throw std::runtime_error("the guard of arm and pins has ended");
        const devices::Fault found = pins_count_ > 0 ? devices::fault_of(now.pins.state) : devices::Fault::none;
        if (devices::latches(found))
            throw std::runtime_error("the pins are not driven: " + std::string(devices::text(found)) +
                                     " (`palpa tactile pins test` says which)");
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (pins_count_ > 0 && now.pins.state != devices::PinState::driving && (!arm_ || now.arm_heard))
        throw std::runtime_error("the boards of the pins do not answer");
    throw std::runtime_error(now.arm_heard ? "the force sensor of the arm does not answer" : "the arm does not answer");
}

void DevicePort::stop() noexcept {
    stopped_ = true;
    if (guard_) guard_->stop();
}

void DevicePort::release() noexcept {
    stopped_ = false;
    if (guard_) guard_->release();
}

bool DevicePort::read(LoopFeedback& feedback) noexcept {
    feedback.stopped = stopped_ ? 1.0 : 0.0;
    if (!guard_) {  // pins that are only drawn
        const bool stopped = guarded_.guard.fault != devices::Fault::none;
        if (stopped_ && !stopped) devices::stop(guarded_.guard);
        if (!stopped_ && stopped) devices::release(guarded_.guard);
        return true;
    }
    guard_->poll();
    const devices::ShapeReport& now = guard_->newest();
    feedback.arm = now.arm;
    if (now.arm_heard) feedback.arm.age_s = std::max(files::steady_s() - now.arm.time_s, 0.0);
    guarded_.guard.fault = now.fault;
    guarded_.guard.count = now.count;
    guarded_.guard.limited = now.limited;
    guarded_.guard.slewed = now.slewed;
    return true;
}

void DevicePort::send(double /*now_s*/, const LoopCommand& command) noexcept {
    if (!guard_) return;
    const std::size_t pins = std::min(pins_count_, static_cast<std::size_t>(command.pins));
    guard_->send(command.arm, {command.pins_m.data(), pins});
}

}  // namespace palpa::tactile
