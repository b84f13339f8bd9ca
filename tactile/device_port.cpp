#include "tactile/device_port.h"

#include <chrono>
#include <stdexcept>
#include <thread>

#include "files/clock.h"

namespace palpa::tactile {
namespace {

constexpr double kPinsEvery_s = 0.02;  // from one look at the boards' health to the next

}  // namespace

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

DevicePort::DevicePort(const TactilePlan& plan) : guarded_(guarded_of(plan)) {
    if (plan.arm) arm_ = devices::open_arm(*plan.arm);
    sensor_ = plan.arm && plan.arm->sensor;
    if (plan.pin_device) pins_ = std::make_unique<devices::PinDriver>(*plan.pin_device);
}

DevicePort::~DevicePort() {
    if (arm_) arm_->send({});
}

bool DevicePort::ask_arm() {
    if (!arm_) return true;
    arm_->send({});  // rest; the arm answers every command
    arm_heard_ = arm_->read(newest_) || arm_heard_;
    return arm_heard_ && (!sensor_ || newest_.has_sensor > 0.5);
}

void DevicePort::wait_until_ready(double most_s) {
    const double until_s = files::steady_s() + most_s;
    bool arm_ready = ask_arm();
    while (!arm_ready || (pins_ && pins().state != devices::PinState::driving)) {
        const devices::Fault found = pins_ ? devices::fault_of(pins().state) : devices::Fault::none;
        if (devices::latches(found))
            throw std::runtime_error("the pins are not driven: " + std::string(devices::text(found)) +
                                     " (`palpa tactile pins test` says which)");
        if (files::steady_s() > until_s) {
            if (arm_ready) throw std::runtime_error("the boards of the pins do not answer");
            throw std::runtime_error(arm_heard_ ? "the force sensor of the arm does not answer"
                                                : "the arm does not answer");
        }
        arm_ready = ask_arm();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void DevicePort::watch_pins(double now_s) noexcept {
    if (!pins_ || now_s < pins_due_s_) return;
    pins_due_s_ = now_s + kPinsEvery_s;
    found_ = devices::fault_of(pins_->health().state);
}

bool DevicePort::read(LoopFeedback& feedback) noexcept {
    if (arm_) fresh_ = arm_->read(newest_) || fresh_;
    feedback.arm = newest_;
    if (release_.exchange(false)) {
        stop_ = false;
        devices::release(guarded_.guard);
    }
    if (stop_) devices::stop(guarded_.guard);
    feedback.stopped = stop_ ? 1.0 : 0.0;
    return true;
}

void DevicePort::send(double now_s, const LoopCommand& command) noexcept {
    watch_pins(now_s);
    LoopCommand guarded = command;
    guard_command(now_s, fresh_, arm_ ? &newest_ : nullptr, found_, guarded, guarded_);
    fresh_ = false;
    if (arm_) arm_->send(guarded.arm);
    if (pins_) pins_->send({guarded.pins_m.data(), static_cast<std::size_t>(guarded.pins)});
}

}  // namespace palpa::tactile
