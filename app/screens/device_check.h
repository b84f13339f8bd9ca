#pragma once
// Measures from samples what the pointing devices really send: rate, pressure, clock. Taking a sample allocates
// nothing, so that the check can run beside everything else.

#include <array>
#include <bitset>
#include <cstdint>

#include "files/json.h"
#include "platform/pressure.h"
#include "platform/sample.h"
#include "scene/meter.h"

namespace palpa::app {

// A straight line through (device - host) over host time, by least squares with running sums, of the sample with the
// shortest delay in each quarter of a second: a busy computer makes delays longer, many at once, but seldom all.
struct ClockFit {
    std::int64_t count = 0;  // quarters of a second, without the one that goes on
    std::int64_t quarter = 0;
    double shortest_host_s = platform::kMissing;  // of the quarter that goes on, since the first sample
    double shortest_ahead_s = platform::kMissing;
    double first_host_s = 0.0;
    double first_device_s = 0.0;
    double mean_host_s = 0.0;    // since the first sample
    double mean_ahead_s = 0.0;   // device - host, since the first sample
    double sum_host_host = 0.0;  // sums of products of deviations from the means, s^2
    double sum_host_ahead = 0.0;
    double sum_ahead_ahead = 0.0;
};

struct ClockDrift {
    // Positive: the device's clock is fast. NaN before 16 quarters of a second with samples, over some 4 s.
    double ppm = platform::kMissing;
    // Assumes random shortest delays; a computer that is busy for seconds on end adds to the error.
    double standard_error_ppm = platform::kMissing;
};

struct Range {
    double lowest = platform::kMissing;
    double highest = platform::kMissing;
};

// All pointers of one tool together.
struct ToolCheck {
    static constexpr std::size_t kMostValues = 65536;
    std::int64_t samples = 0;
    std::int64_t touching = 0;
    Range x_px, y_px;
    Range pressure;                   // 0..1, while touching
    Range pressure_raw;               // counts, while touching
    std::bitset<kMostValues> values;  // the pressures that occurred, as counts (or in 1/65535)
    bool tilt = false;
    bool contact_size = false;
    scene::Meter gaps;  // between samples of one pointer
    std::int64_t gap_count = 0;
    double gaps_s = 0.0;  // sum of the gaps
    ClockFit clock;
    // Number of deliveries of samples of one pointer at one moment: fewer than samples if the system collects them.
    std::int64_t deliveries = 0;
    scene::Meter delays;  // from the device's clock to the host's, if both count from the same moment
};

// The last sample of a pointer.
struct PointerTime {
    bool used = false;
    std::int64_t pointer_id = 0;
    double t_host_s = 0.0;
    double t_device_s = platform::kMissing;
};

struct DeviceCheck {
    std::array<ToolCheck, platform::kToolCount> tools;
    platform::PressureWatch pressure;
    std::array<PointerTime, 32> pointers;
};

// A longer gap counts as a rest and not for the rate, since many devices send nothing while they are held still.
inline constexpr double kRest_s = 0.25;

// Takes every sample as the device sent it; samples of phase ui are ignored.
void observe(const platform::Sample& sample, DeviceCheck& check);

const ToolCheck& of_tool(platform::Tool tool, const DeviceCheck& check);

// Whether enough samples came one after the other. Gaps are measured by the device's own clock if it has one.
bool knows_gaps(const ToolCheck& tool);
// NaN as long as they are not known.
double rate_Hz(const ToolCheck& tool);
double median_gap_s(const ToolCheck& tool);  // to 2 %
double worst_gap_s(const ToolCheck& tool);

std::int64_t distinct_pressures(const ToolCheck& tool);
ClockDrift clock_drift(const ToolCheck& tool);

// Returns how many samples arrive in one delivery on average; 1: each arrives by itself.
double samples_per_delivery(const ToolCheck& tool);
double median_delay_s(const ToolCheck& tool);  // NaN if the clocks cannot be compared

const char* name_of(platform::PressureKind kind);

// Returns what each tool sent, by the tool's name, for files and programs. NaN becomes null.
files::Json check_json(const DeviceCheck& check);

}  // namespace palpa::app
