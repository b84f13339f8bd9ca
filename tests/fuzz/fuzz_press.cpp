// PRESS.tsv.

#include <cmath>

#include "devices/press_file.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

PALPA_FUZZ_ENTRY(press)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        const std::vector<PressRow> rows = parse_press(std::string(fuzz::text_of(data, size)), "press.tsv");
        if (rows.empty()) fuzz::finding("no rows");
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (i > 0 && !(rows[i].t_s > rows[i - 1].t_s)) fuzz::finding("a time that does not go on");
            if (!std::isfinite(rows[i].x_m) || std::isfinite(rows[i].depth_m) == std::isfinite(rows[i].force_N))
                fuzz::finding("a row without a value");
        }
        std::size_t at = 0;
        press_at(rows, 0.5 * (rows.front().t_s + rows.back().t_s), at);
    });
}
