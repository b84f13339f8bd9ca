#include <cmath>
#include <doctest/doctest.h>

#include "accuracy/tactile.h"
#include "tests/close_to.h"

using namespace palpa::accuracy;
using namespace palpa::test;
using palpa::test::close_to;

TEST_CASE(
    "schedule: 20 ms ahead leaves at most half the mismatch at 20 mm/s; at 100 mm/s the servos' speed is the limit") {
    const double free_m = schedule_mismatch_m(0.02, 0.0, false);
    const double lead_m = schedule_mismatch_m(0.02, 20e-3, false);
    MESSAGE("free " << 1e3 * free_m << " mm, lead " << 1e3 * lead_m << " mm");
    CHECK(free_m == close_to(0.116e-3).epsilon(0.2));
    CHECK(lead_m < 0.5 * free_m);
    // rounding to 0.1 mm alone leaves 0.029 mm
    CHECK(lead_m > 0.02e-3);
    CHECK(schedule_mismatch_m(0.1, 20e-3, false) > 5.0 * lead_m);
    CHECK(schedule_mismatch_m(0.05, 0.0, false) > free_m);
}

TEST_CASE("tactile measurements: contact, table, sheet, steps and schedule are all there, and the short ones run") {
    const std::vector<Measurement> list = tactile_measurements({true, 0.0, 0.0});
    CHECK(list.size() >= 8);
    std::vector<AccuracyRow> rows;
    for (const Measurement& m : list)
        if (m.what == "sheet" || m.what == "steps and schedule" || m.what == "pad against Hertz") m.run(rows);
    REQUIRE(rows.size() == 4 + 8 + 2 + 8);
    for (const AccuracyRow& row : rows) {
        CAPTURE(row.choice);
        CHECK(std::isfinite(row.error_percent));
        CHECK_FALSE(row.reference.empty());
    }
    // from four spacings on the pad is within 3 % of Hertz
    for (std::size_t k = 1; k < 4; ++k) CHECK(rows[k].worst_error_percent < 3.0);
}
