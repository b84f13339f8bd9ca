#include <cmath>
#include <doctest/doctest.h>
#include <vector>

#include "tactile/mismatch.h"
#include "tests/close_to.h"

using namespace palpa::tactile;
using namespace palpa::test;

namespace {

// Four pins that follow sinusoids `late_s` behind (ahead if negative), with an offset.
MismatchMeter followed(double late_s, double offset_m = 0.0) {
    MismatchMeter meter;
    for (int k = 0; k < 3000; ++k) {
        std::vector<double> wanted(4), reached(4);
        for (std::size_t i = 0; i < 4; ++i) {
            const double phase = static_cast<double>(i);
            wanted[i] = 1e-3 * std::sin(7.0 * 1e-3 * k + phase);
            reached[i] = 1e-3 * std::sin(7.0 * (1e-3 * k - late_s) + phase) + offset_m;
        }
        add(wanted, reached, true, meter);
    }
    return meter;
}

}  // namespace

TEST_CASE("mismatch: heights, root mean square and greatest") {
    const MismatchMeter meter = followed(0.0, 2e-4);
    CHECK(rms_m(meter) == close_to(2e-4).epsilon(1e-6));
    CHECK(meter.max_m == close_to(2e-4).epsilon(1e-6));
}

TEST_CASE("mismatch: how long the pins are behind, or ahead") {
    for (const double late_s : {0.0, 7e-3, 23.5e-3, 100e-3, -12e-3}) {
        CAPTURE(late_s);
        CHECK(lag_s(followed(late_s)) == close_to(late_s).epsilon(0.02).scale(5e-3));
    }
}

TEST_CASE("mismatch: without a press or without pins there is none") {
    MismatchMeter meter;
    CHECK(std::isnan(rms_m(meter)));
    CHECK(std::isnan(lag_s(meter)));
    const std::vector<double> still(4, 1e-3);
    for (int k = 0; k < 1000; ++k) add(still, still, false, meter);
    CHECK(std::isnan(rms_m(meter)));
    CHECK(std::isnan(lag_s(meter)));
    for (int k = 0; k < 1000; ++k) {  // it trembles by a micrometre
        const std::vector<double> trembling(4, 1e-3 + (k / 20 % 2 == 0 ? 1e-6 : 0.0));
        add(trembling, still, false, meter);
    }
    CHECK(std::isnan(lag_s(meter)));
    add({}, {}, true, meter);
    CHECK(meter.steps == 0);
}
