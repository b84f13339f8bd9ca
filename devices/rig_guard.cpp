#include "devices/rig_guard.h"

#include <algorithm>
#include <cmath>

namespace palpa::devices {
namespace {

constexpr double kLongestStep_s = 0.05;  // after a longer pause the commands do not jump

void relax_all(const ActuatorRig& rig, RigGuard& guard) noexcept {
    guard.driven = false;
    for (std::size_t i = 0; i < rig.channels.size(); ++i) guard.value[i] = rig.channels[i].relaxed;
}

// Draws all values that carry force towards rest by one share, so that they stay within their ranges.
void limit_total(const ActuatorRig& rig, std::array<double, kMostChannels>& value, RigGuard& guard) noexcept {
    double total_N = 0.0, resting_N = 0.0;
    for (std::size_t i = 0; i < rig.channels.size(); ++i) {
        const double per_unit = rig.channels[i].force_N_per_unit;
        total_N += std::abs(per_unit * value[i]);
        resting_N += std::abs(per_unit * rig.channels[i].relaxed);
    }
    if (total_N <= rig.total_force_N) return;
    ++guard.scaled;
    constexpr double kRounding = 1e-12;
    const double share = std::clamp((rig.total_force_N - resting_N) / (total_N - resting_N) - kRounding, 0.0, 1.0);
    for (std::size_t i = 0; i < rig.channels.size(); ++i) {
        const RigChannel& channel = rig.channels[i];
        if (channel.force_N_per_unit != 0.0) value[i] = channel.relaxed + share * (value[i] - channel.relaxed);
    }
}

}  // namespace

RigGuard make_rig_guard(const ActuatorRig& rig) {
    RigGuard guard;
    relax_all(rig, guard);
    return guard;
}

void latch(const ActuatorRig& rig, Fault fault, RigGuard& guard) noexcept {
    if (guard.fault == Fault::none && fault != Fault::none) {
        guard.fault = fault;
        ++guard.count[static_cast<std::size_t>(fault)];
    }
    relax_all(rig, guard);
}

void release(const ActuatorRig& rig, RigGuard& guard) noexcept {
    guard.fault = Fault::none;
    relax_all(rig, guard);
}

void watch(const ActuatorRig& rig, double now_s, Fault found, RigGuard& guard) noexcept {
    if (found != Fault::none) latch(rig, found, guard);
    if (guard.driven && !(now_s - guard.commanded_s <= kLoopSilence_s)) latch(rig, Fault::loop_silent, guard);
}

void take_command(const ActuatorRig& rig, double now_s, std::span<const double> wanted, RigGuard& guard) noexcept {
    if (guard.fault != Fault::none) return;
    const auto finite = [](double value) { return std::isfinite(value); };
    if (wanted.size() != rig.channels.size() || !std::all_of(wanted.begin(), wanted.end(), finite))
        return latch(rig, Fault::not_a_number, guard);
    const double step_s = guard.driven ? std::clamp(now_s - guard.commanded_s, 0.0, kLongestStep_s) : 0.0;
    guard.driven = true;
    guard.commanded_s = now_s;
    std::array<double, kMostChannels> value{};
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        value[i] = std::clamp(wanted[i], rig.channels[i].lower, rig.channels[i].upper);
        guard.limited += value[i] != wanted[i];
    }
    limit_total(rig, value, guard);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const double most = rig.channels[i].rate_per_s * step_s;
        const double slewed = std::clamp(value[i], guard.value[i] - most, guard.value[i] + most);
        guard.slewed += slewed != value[i];
        value[i] = slewed;
    }
    limit_total(rig, value, guard);  // a fall may be slower than the rise beside it
    guard.value = value;
}

}  // namespace palpa::devices
