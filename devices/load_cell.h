#pragma once
// A load cell behind an HX711 and an Arduino: lines "t_us,raw\n", micros() and the signed 24-bit reading.
//
// Supported: a first line cut off by opening the port, garbled lines (skipped to the next newline), the wrap-around of
// micros() every 71.6 minutes, losses (seen as gaps of the clock), lines that come twice or out of order, a port that is
// unplugged and comes back. Not supported yet: other line formats. Tried with devices/simulators only.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "devices/force_sensor.h"

namespace palpa::devices {

struct LoadCellLine {
    std::uint32_t t_us = 0;
    std::int32_t raw = 0;  // -2^23 ... 2^23 - 1
};

// Builds lines from bytes as they arrive.
struct LineParser {
    std::string line;
    bool skipping = true;  // until the first newline, since the port was opened within a line
};
// Returns true when `byte` ends a good line. Counts garbled lines.
bool feed(std::uint8_t byte, LineParser& parser, SensorHealth& health, LoadCellLine& out);

// The readings of the sensor's clock, and what they say about the stream.
struct LoadCellClock {
    bool started = false;
    std::uint32_t last_us = 0;
    std::int64_t total_us = 0;
    std::array<std::int32_t, 16> recent_us{};  // steps
    std::int64_t steps = 0;
    std::int64_t lost_before = 0;  // by the step before
    std::int64_t malformed = 0;    // lines that were garbled up to the last good one
};
// Returns false for a line that came twice or late. Counts losses once the period is known (after 16 steps: their lower
// quartile, which neither gaps nor single short steps change); what is missing from the clock because its line was garbled is
// not lost as well, nor what a reading that is stamped late seems to skip.
bool take_time(std::uint32_t t_us, LoadCellClock& clock, SensorHealth& health);

struct LoadCellOptions {
    std::string path;
    int baud = 115200;
    double N_per_count = 0.0;
};
std::unique_ptr<ForceSensor> open_load_cell(const LoadCellOptions& options);

}  // namespace palpa::devices
