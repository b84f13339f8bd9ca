// The bytes of a load cell's serial line, and its clock.

#include "devices/load_cell.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

PALPA_FUZZ_ENTRY(load_cell)(const std::uint8_t* data, std::size_t size) {
    LineParser parser;
    SensorHealth health;
    LoadCellClock clock;
    for (std::size_t i = 0; i < size; ++i) {
        LoadCellLine line;
        if (!feed(data[i], parser, health, line)) continue;
        if (line.raw < -(1 << 23) || line.raw >= 1 << 23) fuzz::finding("a reading of more than 24 bits");
        take_time(line.t_us, clock, health);
    }
    if (health.lost < 0 || health.malformed < 0) fuzz::finding("a count below zero");
    return 0;
}
