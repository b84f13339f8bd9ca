#include <cmath>
#include <doctest/doctest.h>

#include "tactile/pin_estimate.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::tactile;
using namespace palpa::test;

namespace {

// Height after `seconds` of a command, in steps of 1 ms.
double after_m(double seconds, double commanded_m) {
    PinEstimate estimate;
    for (int k = 0; 1e-3 * k <= seconds + 1e-9; ++k) estimate_pins({}, 0.0, 1e-3 * k, {&commanded_m, 1}, estimate);
    return estimate.height_m[0];
}

}  // namespace

TEST_CASE("pin estimate: a pin starts at rest, arrives, and goes no faster than it can") {
    CHECK(after_m(0.0, 2e-3) == 0.0);
    CHECK(after_m(0.05, 2e-3) <= 0.05 * 0.03 + 1e-12);  // 30 mm/s
    CHECK(after_m(0.5, 2e-3) == close_to(2e-3).epsilon(1e-6));
}

TEST_CASE("pin estimate: small moves follow a first-order lag of 12 ms") {
    CHECK(after_m(0.012, 1e-4) == close_to(1e-4 * (1.0 - std::exp(-1.0))).epsilon(1e-6));
}

TEST_CASE("pin estimate: a board takes a new target once per frame") {
    PinEstimate estimate;
    double commanded_m = 0.0;
    estimate_pins({}, 0.0, 0.0, {&commanded_m, 1}, estimate);
    commanded_m = 1e-3;
    for (int k = 1; k < 20; ++k) estimate_pins({}, 0.0, 1e-3 * k, {&commanded_m, 1}, estimate);
    CHECK(estimate.height_m[0] == 0.0);  // the frame has not ended
    for (int k = 20; k < 40; ++k) estimate_pins({}, 0.0, 1e-3 * k, {&commanded_m, 1}, estimate);
    CHECK(estimate.height_m[0] > 0.0);
}

TEST_CASE("pin estimate: a time that goes back moves nothing") {
    PinEstimate estimate;
    const double commanded_m = 1e-3;
    for (int k = 0; k < 10; ++k) estimate_pins({}, 0.0, 1e-3 * k, {&commanded_m, 1}, estimate);
    const double before_m = estimate.height_m[0];
    estimate_pins({}, 0.0, 0.0, {&commanded_m, 1}, estimate);
    CHECK(estimate.height_m[0] == before_m);
}
