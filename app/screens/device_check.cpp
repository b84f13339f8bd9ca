#include "app/screens/device_check.h"

#include <algorithm>
#include <cmath>

namespace palpa::app {
namespace {

constexpr double kShortestClock_s = 4.0;

void widen(double value, Range& range) {
    if (!std::isfinite(value)) return;
    range.lowest = std::fmin(range.lowest, value);  // fmin and fmax ignore NaN
    range.highest = std::fmax(range.highest, value);
}

// Notes a value of the pressure: counts as they are, a pressure without counts in 65535 steps.
void note_pressure(const platform::Sample& sample, ToolCheck& tool) {
    widen(sample.pressure, tool.pressure);
    widen(sample.pressure_raw, tool.pressure_raw);
    constexpr double kLast = ToolCheck::kMostValues - 1.0;
    const double raw = sample.pressure_raw;
    const double step = raw >= 0.0 && raw <= kLast ? raw : kLast * sample.pressure;
    if (std::isfinite(step)) tool.values.set(static_cast<std::size_t>(std::clamp(std::round(step), 0.0, kLast)));
}

void fit(const platform::Sample& sample, ClockFit& clock) {
    if (std::isnan(sample.t_device_s)) return;
    if (std::isnan(clock.shortest_ahead_s)) {
        clock.first_host_s = sample.t_host_s;
        clock.first_device_s = sample.t_device_s;
        clock.shortest_host_s = 0.0;
        clock.shortest_ahead_s = 0.0;
    }
    const double since_s = sample.t_host_s - clock.first_host_s;
    const double since_ahead_s = (sample.t_device_s - clock.first_device_s) - since_s;
    constexpr double kQuarters_per_s = 4.0;
    const auto quarter = static_cast<std::int64_t>(kQuarters_per_s * since_s);
    const bool over = quarter > clock.quarter;  // times of one delivery may come in any order
    const double host_s = clock.shortest_host_s, ahead_s = clock.shortest_ahead_s;
    if (over || since_ahead_s > clock.shortest_ahead_s) {
        clock.shortest_host_s = since_s;
        clock.shortest_ahead_s = since_ahead_s;
    }
    if (!over) return;
    clock.quarter = quarter;
    const double n = static_cast<double>(++clock.count);
    const double host_off_s = host_s - clock.mean_host_s;
    const double ahead_off_s = ahead_s - clock.mean_ahead_s;
    clock.mean_host_s += host_off_s / n;
    clock.mean_ahead_s += ahead_off_s / n;
    clock.sum_host_host += host_off_s * (host_s - clock.mean_host_s);
    clock.sum_host_ahead += host_off_s * (ahead_s - clock.mean_ahead_s);
    clock.sum_ahead_ahead += ahead_off_s * (ahead_s - clock.mean_ahead_s);
}

// Returns the pointer's place in the table. If the table is full, it replaces the pointer that was quiet for longest.
PointerTime& slot_of(std::int64_t pointer_id, DeviceCheck& check) {
    PointerTime* quiet = check.pointers.data();
    for (PointerTime& pointer : check.pointers) {
        if (pointer.used && pointer.pointer_id == pointer_id) return pointer;
        const bool quieter = quiet->used && (!pointer.used || pointer.t_host_s < quiet->t_host_s);
        if (quieter) quiet = &pointer;
    }
    *quiet = PointerTime{};
    return *quiet;
}

void note_gap(const platform::Sample& sample, PointerTime& pointer, ToolCheck& tool) {
    if (!pointer.used || pointer.t_host_s != sample.t_host_s) ++tool.deliveries;
    const double delay_s = sample.t_host_s - sample.t_device_s;
    constexpr double kSameClock_s = 5.0;  // clocks that differ by more count from different moments
    if (delay_s >= 0.0 && delay_s < kSameClock_s) tool.delays.add_ns(1e9 * delay_s);
    if (pointer.used) {
        const double by_device_s = sample.t_device_s - pointer.t_device_s;
        const double gap_s = std::isnan(by_device_s) ? sample.t_host_s - pointer.t_host_s : by_device_s;
        if (gap_s >= 0.0 && gap_s <= kRest_s) {
            tool.gaps.add_ns(1e9 * gap_s);
            tool.gaps_s += gap_s;
            ++tool.gap_count;
        }
    }
    pointer = {true, sample.pointer_id, sample.t_host_s, sample.t_device_s};
}

// NaN, which traces write as n/a, becomes null.
files::Json range_json(const Range& range) {
    return {files::number_or_null(range.lowest), files::number_or_null(range.highest)};
}

files::Json seen_json(platform::Tool which, const DeviceCheck& check) {
    const ToolCheck& tool = of_tool(which, check);
    const ClockDrift drift = clock_drift(tool);
    files::Json json{
        {"samples", tool.samples}, {"touching", tool.touching}, {"rate_Hz", files::number_or_null(rate_Hz(tool))}};
    json["gap_ms"] = {{"median", files::number_or_null(1e3 * median_gap_s(tool))},
                      {"worst", files::number_or_null(1e3 * worst_gap_s(tool))}};
    json["pressure"] = name_of(platform::pressure_kind(check.pressure, which));
    json["pressure_range"] = range_json(tool.pressure);
    json["pressure_raw_range"] = range_json(tool.pressure_raw);
    json["distinct_pressures"] = distinct_pressures(tool);
    json["tilt"] = tool.tilt;
    json["contact_size"] = tool.contact_size;
    json["clock_drift_ppm"] = files::number_or_null(drift.ppm);
    json["clock_drift_standard_error_ppm"] = files::number_or_null(drift.standard_error_ppm);
    json["samples_per_delivery"] = files::number_or_null(samples_per_delivery(tool));
    json["delay_ms"] = files::number_or_null(1e3 * median_delay_s(tool));
    json["x_px"] = range_json(tool.x_px);
    json["y_px"] = range_json(tool.y_px);
    return json;
}

}  // namespace

void observe(const platform::Sample& sample, DeviceCheck& check) {
    if (sample.phase == platform::Phase::ui) return;
    platform::watch(sample, check.pressure);
    ToolCheck& tool = check.tools[static_cast<std::size_t>(sample.tool)];
    ++tool.samples;
    widen(sample.x_px, tool.x_px);
    widen(sample.y_px, tool.y_px);
    tool.tilt = tool.tilt || std::isfinite(sample.tilt_x_deg);
    tool.contact_size = tool.contact_size || std::isfinite(sample.width_px);
    fit(sample, tool.clock);
    if (sample.phase == platform::Phase::down || sample.phase == platform::Phase::move) {
        ++tool.touching;
        note_pressure(sample, tool);
    }
    PointerTime& pointer = slot_of(sample.pointer_id, check);
    note_gap(sample, pointer, tool);
    const bool finger_gone = sample.tool == platform::Tool::finger &&
                             (sample.phase == platform::Phase::up || sample.phase == platform::Phase::cancel);
    if (finger_gone) pointer.used = false;  // another touch gets another number
}

const ToolCheck& of_tool(platform::Tool tool, const DeviceCheck& check) {
    return check.tools[static_cast<std::size_t>(tool)];
}

bool knows_gaps(const ToolCheck& tool) {
    constexpr std::int64_t kFewest = 5;  // two samples of one press may come together
    return tool.gap_count >= kFewest && tool.gaps_s > 0.0;
}

double rate_Hz(const ToolCheck& tool) {
    return knows_gaps(tool) ? static_cast<double>(tool.gap_count) / tool.gaps_s : platform::kMissing;
}

double median_gap_s(const ToolCheck& tool) {
    return knows_gaps(tool) ? 1e-9 * tool.gaps.quantile_ns(0.5) : platform::kMissing;
}

double worst_gap_s(const ToolCheck& tool) {
    return knows_gaps(tool) ? 1e-9 * tool.gaps.worst_ns() : platform::kMissing;
}

std::int64_t distinct_pressures(const ToolCheck& tool) { return static_cast<std::int64_t>(tool.values.count()); }

// slope = S_ha / S_hh,  variance of the slope = (S_aa - slope S_ha) / ((n - 2) S_hh)
ClockDrift clock_drift(const ToolCheck& tool) {
    const ClockFit& clock = tool.clock;
    const double n = static_cast<double>(clock.count);
    // n quarters of a second evenly over T have a variance of T^2 / 12; over 1 s, a delay that changes by 1 ms would look like 1000
    // ppm
    if (clock.count < 16 || clock.sum_host_host < n * kShortestClock_s * kShortestClock_s / 12.0) return {};
    const double slope = clock.sum_host_ahead / clock.sum_host_host;
    const double left = std::max(0.0, clock.sum_ahead_ahead - slope * clock.sum_host_ahead);
    return {1e6 * slope, 1e6 * std::sqrt(left / ((n - 2.0) * clock.sum_host_host))};
}

double samples_per_delivery(const ToolCheck& tool) {
    return tool.deliveries > 0 ? static_cast<double>(tool.samples) / static_cast<double>(tool.deliveries)
                               : platform::kMissing;
}

double median_delay_s(const ToolCheck& tool) {
    return tool.delays.timed() > 0 ? 1e-9 * tool.delays.quantile_ns(0.5) : platform::kMissing;
}

files::Json check_json(const DeviceCheck& check) {
    files::Json json = files::Json::object();
    for (const platform::Tool tool :
         {platform::Tool::pen, platform::Tool::finger, platform::Tool::mouse, platform::Tool::keyboard}) {
        if (of_tool(tool, check).samples > 0) json[std::string(name_of(tool))] = seen_json(tool, check);
    }
    return json;
}

const char* name_of(platform::PressureKind kind) {
    switch (kind) {
        case platform::PressureKind::unknown:
            return "unknown";
        case platform::PressureKind::varies:
            return "varies";
        case platform::PressureKind::constant:
            return "constant";
        case platform::PressureKind::missing:
            return "missing";
    }
    return "unknown";
}

}  // namespace palpa::app
