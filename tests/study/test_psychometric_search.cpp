#include <cmath>
#include <doctest/doctest.h>
#include <vector>

#include "study/psychometric_search.h"
#include "study/simulated_observer.h"
#include "tests/close_to.h"

using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("psychometric search: at a top the log likelihood is level along every free coordinate") {
    constexpr std::uint64_t kSeed = 6;
    CAPTURE(kSeed);
    Random random(kSeed);
    for (int i = 0; i < 20; ++i) {
        const auto levels = draw_answers(paper_levels(), 240, {0.05, 0.3, 0.02}, random);
        const CurveSearch search{levels, 0.05, 0.1};
        const CurvePoint top = climb(search, {0.0, 2.0, 0.02});
        constexpr double kStep = 1e-5;
        const auto slope_along = [&](double height, double slope, double lapse) {
            CurvePoint up = top, down = top;
            up.height += kStep * height, down.height -= kStep * height;
            up.slope += kStep * slope, down.slope -= kStep * slope;
            up.lapse += kStep * lapse, down.lapse -= kStep * lapse;
            return (log_likelihood(search, up) - log_likelihood(search, down)) / (2.0 * kStep);
        };
        CHECK(std::abs(slope_along(1, 0, 0)) < 1e-4);
        CHECK(std::abs(slope_along(0, 1, 0)) < 1e-4);
        if (top.lapse > kStep && top.lapse < 0.05) CHECK(std::abs(slope_along(0, 0, 1)) < 1e-3);
        CHECK(top.lapse >= 0.0);
        CHECK(top.lapse <= 0.05);
    }
}

TEST_CASE("psychometric search: what is held stays") {
    const std::vector<LevelAnswers> levels{{-0.5, 3, 40}, {0.0, 15, 40}, {0.5, 36, 40}};
    const CurvePoint at_slope = climb({levels, 0.05, 0.0, true, false}, {0.3, 2.0, 0.01});
    CHECK(at_slope.slope == 2.0);
    const CurvePoint at_pse = climb({levels, 0.05, 0.1, false, true}, {0.0, 2.0, 0.01});
    CHECK(at_pse.height == 0.0);
    const CurvePoint free = climb({levels, 0.05, 0.0}, {0.0, 2.0, 0.01});
    CHECK(free.log_likelihood >= at_slope.log_likelihood);
    CHECK(free.log_likelihood >= at_pse.log_likelihood);
}

TEST_CASE("psychometric search: the likeliest step is where the limit of a steep curve is") {
    constexpr std::uint64_t kSeed = 8;
    CAPTURE(kSeed);
    Random random(kSeed);
    for (int i = 0; i < 20; ++i) {
        std::vector<LevelAnswers> levels;
        for (int x = 0; x < 6; ++x) {
            levels.push_back({static_cast<double>(x), 0, 20});
            const double p = i % 2 == 0 ? (x < 3 ? 0.03 : 0.97) : 0.2 * x;
            for (int k = 0; k < 20; ++k) levels.back().stiffer += random.uniform() < p ? 1 : 0;
        }
        double steep = -1e300;  // any height at a level: the PSE moves by fractions of a very small sd
        for (double pse = 0.0; pse <= 5.0; pse += 0.5) {
            for (double height = -3.0; height <= 3.0; height += 0.05) {
                for (double lapse = 0.0; lapse <= 0.05001; lapse += 0.0025)
                    steep = std::max(steep, log_likelihood({levels, 0.05, pse}, {height, 1e3, lapse}));
            }
        }
        const Step step = likeliest_step(levels, 0.05);
        CHECK(step.log_likelihood >= steep - 1e-9);
        CHECK(step.log_likelihood <= steep + 0.1);  // the grid's fineness
    }
}

TEST_CASE("psychometric search: constants and shares") {
    const std::vector<LevelAnswers> levels{{0.0, 2, 10}, {1.0, 6, 10}};
    CHECK(constant_log_likelihood(levels, 0.0, 1.0) == close_to(8 * std::log(0.4) + 12 * std::log(0.6)));
    CHECK(constant_log_likelihood(levels, 0.5, 1.0) == close_to(20 * std::log(0.5)));
    CHECK(saturated_log_likelihood(levels) ==
          close_to(2 * std::log(0.2) + 8 * std::log(0.8) + 6 * std::log(0.6) + 4 * std::log(0.4)));
}
