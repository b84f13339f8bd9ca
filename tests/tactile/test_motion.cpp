#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "tactile/motion.h"
#include "tests/close_to.h"

using namespace palpa::tactile;
using namespace palpa::test;

namespace {

Motion steady(double m_per_s, int samples, double from_s = 100.0) {
    Motion motion;
    for (int k = 0; k < samples; ++k) {
        const double time_s = from_s + 1e-3 * k;
        remember({time_s, 0.05 + 2.0 * m_per_s * 1e-3 * k, 0.04 - m_per_s * 1e-3 * k, 1e-3 + m_per_s * 1e-3 * k},
                 motion);
    }
    return motion;
}

}  // namespace

TEST_CASE("motion: a steady motion is extrapolated exactly") {
    const Motion motion = steady(0.02, 40);
    const MotionSample soon = ahead(motion, 20e-3);
    CHECK(soon.time_s == close_to(100.039 + 0.020));
    CHECK(soon.value == close_to(1e-3 + 0.02 * 0.059).epsilon(1e-9));
    CHECK(soon.x_m == close_to(0.05 + 0.04 * 0.059).epsilon(1e-9));
    CHECK(soon.y_m == close_to(0.04 - 0.02 * 0.059).epsilon(1e-9));
}

TEST_CASE("motion: a motion that accelerates is followed, over 16 ms of samples") {
    Motion motion;
    for (int k = 0; k < 30; ++k) remember({1e-3 * k, 0.0, 0.0, 0.1 * std::pow(1e-3 * k, 2.0)}, motion);
    CHECK(ahead(motion, 20e-3).value == close_to(0.1 * std::pow(0.049, 2.0)).epsilon(1e-9));
}

TEST_CASE("motion: few and slow samples, as a pen's, are extrapolated on straight lines") {
    Motion motion;
    for (int k = 0; k < 4; ++k) remember({8e-3 * k, 0.0, 0.0, 1e-3 + 0.02 * 8e-3 * k}, motion);
    CHECK(ahead(motion, 20e-3).value == close_to(1e-3 + 0.02 * 0.044).epsilon(1e-9));
}

TEST_CASE("motion: nothing, one sample, equal times and pauses") {
    Motion motion;
    CHECK(ahead(motion, 0.02).value == 0.0);
    remember({1.0, 0.1, 0.2, 3e-3}, motion);
    CHECK(ahead(motion, 0.02).value == 3e-3);
    remember({1.0, 0.1, 0.2, 4e-3}, motion);  // the same time: it replaces the sample
    CHECK(motion.n == 1);
    CHECK(ahead(motion, 0.02).value == 4e-3);
    remember({0.5, 0.1, 0.2, 5e-3}, motion);  // a time that goes back: no jump into the past
    CHECK(motion.n == 1);
    CHECK(ahead(motion, 0.02).time_s == close_to(1.02));
    remember({1.0 + 2 * kForgotten_s, 0.1, 0.2, 1e-3}, motion);
    CHECK(motion.n == 1);
    CHECK(ahead(motion, 0.02).value == 1e-3);
}

TEST_CASE("motion: a hand that lifts does not come out below the surface") {
    Motion motion;
    for (int k = 0; k < 10; ++k) remember({1e-3 * k, 0.0, 0.0, 1e-3 - 1e-4 * k}, motion);
    CHECK(ahead(motion, 20e-3).value == 0.0);
}

TEST_CASE("motion: the steps of an encoder (2 um) are amplified to less than a fifth of a pin's step") {
    const unsigned seed = 7;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> off_m(-1e-6, 1e-6);
    double worst_m = 0.0;
    Motion motion;
    for (int k = 0; k < 2000; ++k) {
        remember({1e-3 * k, 0.0, 0.0, 5e-3 + off_m(random)}, motion);
        if (k > 10) worst_m = std::max(worst_m, std::abs(ahead(motion, 20e-3).value - 5e-3));
    }
    CHECK(worst_m < 2e-5);
}
