#include "devices/limits.h"

#include <algorithm>
#include <cmath>

namespace palpa::devices {
namespace {

constexpr double kLongestTick_s = 0.02;  // after a longer pause the commands do not jump
constexpr double kPinSlewOverSpeed = 4.0;

void set_fault(Fault fault, Guard& guard) noexcept {
    if (fault == guard.fault) return;
    guard.fault = fault;
    if (fault != Fault::none) ++guard.count[static_cast<std::size_t>(fault)];
}

// What is wrong now, of the faults that pass by themselves and those that the arm's own word shows.
Fault fault_now(const Limits& limits, const ArmFeedback* in, const Guard& guard) noexcept {
    if (guard.now_s - guard.heard_s > limits.silence_s) return Fault::silence;
    if (in == nullptr) return Fault::none;
    if (in->faulty > 0.5) return Fault::arm_error;
    const bool possible =
        in->depth_m >= limits.lowest_m - limits.range_slack_m && in->depth_m <= limits.deepest_m + limits.range_slack_m;
    if (!possible) return Fault::out_of_range;  // also for NaN
    if (!(std::abs(in->velocity_m_per_s) <= limits.speed_m_per_s)) return Fault::too_fast;
    return Fault::none;
}

double limited(double wanted, double lowest, double highest, Guard& guard) noexcept {
    const double value = std::clamp(wanted, lowest, highest);
    guard.limited += value != wanted;
    return value;
}

double slewed(double wanted, double last, double most, Guard& guard) noexcept {
    const double value = std::clamp(wanted, last - most, last + most);
    guard.slewed += value != wanted;
    return value;
}

bool finite(const ArmCommand& command) noexcept {
    return std::isfinite(command.force_N) && std::isfinite(command.feedforward_N) && std::isfinite(command.depth_m) &&
           std::isfinite(command.mode);
}

void rest_arm(ArmCommand& command, Guard& guard) noexcept {
    guard.force_N = 0.0;
    guard.feedforward_N = 0.0;
    command = ArmCommand{};
    command.depth_m = guard.depth_m;
}

}  // namespace

std::string_view text(Fault fault) {
    switch (fault) {
        case Fault::none:
            return "none";
        case Fault::stopped:
            return "stopped";
        case Fault::not_a_number:
            return "a command was not a number";
        case Fault::silence:
            return "nothing comes from a device";
        case Fault::out_of_range:
            return "the arm reports a depth outside of its range";
        case Fault::too_fast:
            return "the arm moves too fast";
        case Fault::board_error:
            return "a motor board reports errors";
        case Fault::timeout_missing:
            return "a motor board has no serial timeout";
        case Fault::crc_missing:
            return "a motor board does not check CRCs";
        case Fault::loop_silent:
            return "nothing comes from the loop";
        case Fault::parent_gone:
            return "the program has ended";
        case Fault::guard_gone:
            return "the guard has ended (start Palpa again)";
        case Fault::arm_error:
            return "the arm reports a fault of its own";
        case Fault::guard_silent:
            return "nothing comes from the guard";
    }
    return "";
}

bool latches(Fault fault) {
    return fault != Fault::none && fault != Fault::silence && fault != Fault::too_fast && fault != Fault::guard_silent;
}

Limits limits_of(const ArmDevice* arm, const PinDevice* pins, double force_limit_N) {
    Limits limits;
    limits.force_N = force_limit_N;
    if (arm != nullptr) {
        limits.force_N = std::min(force_limit_N, arm->force_N);
        limits.feedforward_N = arm->feedforward_N;
        limits.force_slew_N_per_s = arm->force_slew_N_per_s;
        limits.lowest_m = arm->lowest_m;
        limits.deepest_m = arm->deepest_m;
        limits.depth_slew_m_per_s = arm->depth_slew_m_per_s;
        limits.speed_m_per_s = arm->speed_m_per_s;
        limits.silence_s = arm->silence_s;
    }
    if (pins != nullptr) {
        limits.pin_highest_m = pins->stroke_m;
        limits.pin_rest_m = pins->rest_m;
        limits.pin_slew_m_per_s = kPinSlewOverSpeed * pins->speed_m_per_s;
    }
    return limits;
}

Fault fault_of(PinState pins) noexcept {
    switch (pins) {
        case PinState::proving:
        case PinState::driving:
            return Fault::none;
        case PinState::gone:
        case PinState::no_answer:
            return Fault::silence;
        case PinState::no_timeout:
            return Fault::timeout_missing;
        case PinState::no_crc:
            return Fault::crc_missing;
        case PinState::faulty:
            return Fault::board_error;
    }
    return Fault::none;
}

void begin_tick(const Limits& limits, double now_s, bool fresh, const ArmFeedback* in, Guard& guard,
                Fault found) noexcept {
    if (!std::isfinite(now_s)) return latch(Fault::not_a_number, guard);
    if (!guard.begun) {
        guard.begun = true;
        guard.now_s = now_s;
        guard.heard_s = now_s;
    }
    guard.dt_s = std::clamp(now_s - guard.now_s, 0.0, kLongestTick_s);
    guard.now_s = now_s;
    if (fresh) guard.heard_s = now_s;
    if (fresh && in != nullptr && !guard.has_depth && std::isfinite(in->depth_m)) {
        guard.has_depth = true;
        guard.depth_m = std::clamp(in->depth_m, limits.lowest_m, limits.deepest_m);
    }
    if (latches(guard.fault)) return;
    const Fault own = fault_now(limits, fresh ? in : nullptr, guard);
    set_fault(own != Fault::none && !latches(found) ? own : found, guard);
}

void guard_arm(const Limits& limits, ArmCommand& command, Guard& guard) noexcept {
    if (!finite(command)) latch(Fault::not_a_number, guard);
    const bool force = command.mode == static_cast<double>(ArmMode::force);
    const bool position = command.mode == static_cast<double>(ArmMode::position);
    if (guard.fault != Fault::none || !(force || (position && guard.has_depth))) {
        rest_arm(command, guard);
        guard.has_depth = false;  // it is asked anew where it is before it is told to go somewhere
        return;
    }
    const double most_N = limits.force_slew_N_per_s * guard.dt_s;
    command.force_N = slewed(limited(command.force_N, 0.0, limits.force_N, guard), guard.force_N, most_N, guard);
    command.feedforward_N = slewed(limited(command.feedforward_N, -limits.feedforward_N, limits.feedforward_N, guard),
                                   guard.feedforward_N, most_N, guard);
    guard.force_N = command.force_N;
    guard.feedforward_N = command.feedforward_N;
    if (!position) {
        guard.has_depth = false;
        command.depth_m = 0.0;
        return;
    }
    command.depth_m = slewed(limited(command.depth_m, limits.lowest_m, limits.deepest_m, guard), guard.depth_m,
                             limits.depth_slew_m_per_s * guard.dt_s, guard);
    guard.depth_m = command.depth_m;
}

void guard_pins(const Limits& limits, std::span<double> heights_m, Guard& guard) noexcept {
    if (!guard.has_heights) guard.height_m.fill(limits.pin_rest_m);
    guard.has_heights = true;
    const std::size_t count = std::min(heights_m.size(), kMostPins);
    const bool finite = std::all_of(heights_m.begin(), heights_m.end(), [](double h) { return std::isfinite(h); });
    if (!finite) latch(Fault::not_a_number, guard);
    const double most_m = limits.pin_slew_m_per_s * guard.dt_s;
    for (std::size_t i = 0; i < count; ++i) {
        double& last_m = guard.height_m[i];
        if (guard.fault != Fault::none) {
            last_m = limits.pin_rest_m;
        } else {
            last_m =
                slewed(limited(heights_m[i], limits.pin_lowest_m, limits.pin_highest_m, guard), last_m, most_m, guard);
        }
        heights_m[i] = last_m;
    }
    std::fill(heights_m.begin() + static_cast<std::ptrdiff_t>(count), heights_m.end(), limits.pin_rest_m);
}

void stop(Guard& guard) noexcept { latch(Fault::stopped, guard); }

void latch(Fault fault, Guard& guard) noexcept {
    if (!latches(guard.fault)) set_fault(fault, guard);
}

void release(Guard& guard) noexcept {
    set_fault(Fault::none, guard);
    guard.begun = false;  // a silence counts from now
    guard.has_depth = false;
}

}  // namespace palpa::devices
