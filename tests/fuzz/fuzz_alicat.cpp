// The bytes of a line of pressure controllers, both ways.

#include <cmath>

#include "devices/alicat.h"
#include "devices/simulators/alicat_units.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

PALPA_FUZZ_ENTRY(alicat)(const std::uint8_t* data, std::size_t size) {
    AlicatParser parser;
    simulators::AlicatUnits units;
    units.unit = {{'A', 50.0, 0.0, 0.0, false}, {'C', 5.0, 0.0, 0.0, false}};
    for (std::size_t i = 0; i < size; ++i) {
        AlicatFrame frame;
        if (feed(data[i], parser, frame)) {
            if (frame.values == 0 || frame.values > AlicatFrame::kMostValues) fuzz::finding("a frame without values");
            for (std::size_t k = 0; k < frame.values; ++k) {
                if (!(std::abs(frame.value[k]) <= kMostAlicatValue)) fuzz::finding("a value out of range");
            }
        }
        simulators::take_bytes({data + i, 1}, units);
        simulators::advance(1e-3, units);
        for (const simulators::SimulatedAlicat& unit : units.unit) {
            if (!(unit.set_point >= 0.0 && unit.set_point <= unit.full_scale))
                fuzz::finding("a set point out of range");
        }
    }
    return 0;
}
