// Measured points of a calibration.

#include "calibration/points.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::calibration;

PALPA_FUZZ_ENTRY(points)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("points");
    return fuzz::read_or_refuse([&] {
        const CalibrationRows rows = read_points(file.with(fuzz::text_of(data, size)), {});
        const LevelRange range = level_range_of(rows.level);
        fit_points(rows, range, ends_of(rows, range));
    });
}
