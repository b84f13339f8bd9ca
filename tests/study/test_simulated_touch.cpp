#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <vector>

#include "study/psychometric.h"
#include "study/simulated_observer.h"
#include "study/simulated_touch.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::study;
using namespace palpa::test;

namespace {

constexpr double kBowl = 0.715;  // shape over depth at the corner of 6 x 6 pins

// A press of 2.3 N there and back on tissue of `N_per_m`, whose shape a display with this stroke shows.
std::vector<FeltMoment> press_on(double N_per_m, double stroke_m) {
    std::vector<FeltMoment> press;
    for (int i = 0; i <= 200; ++i) {
        const double force_N = 2.3 * std::sin(3.14159265358979 * i / 200.0);
        const double depth_m = force_N / N_per_m;
        press.push_back({force_N, depth_m, std::min(stroke_m, kBowl * depth_m), kBowl * depth_m});
    }
    return press;
}

FeltStiffness felt_with(double ln_stiffness, bool pins) {
    FeltStiffness felt;
    felt.by(Sense::hand) = ln_stiffness;
    if (pins) felt.by(Sense::fingertip) = ln_stiffness;
    return felt;
}

// The share of right answers that is expected over the paper's five comparisons in both orders.
double expected_share(bool pins) {
    const double sd = std::sqrt(2.0) * perceived_sd(felt_with(0.0, pins), {});
    double sum = 0.0;
    for (const double x : paper_levels()) sum += probability_stiffer(std::abs(x), {0.0, sd, 0.0});
    return sum / static_cast<double>(paper_levels().size());
}

}  // namespace

TEST_CASE("simulated touch: the default noise gives the paper's 56 and 82 % by construction") {
    CHECK(expected_share(false) == close_to(0.56).epsilon(1e-5));
    CHECK(expected_share(true) == close_to(0.82).epsilon(1e-5));
}

TEST_CASE("simulated touch: answers drawn from what both senses are told have those shares") {
    for (const bool pins : {false, true}) {
        Random random(20);  // the seed
        int right = 0;
        constexpr int kAnswers = 20000;
        const std::vector<double> levels = paper_levels();
        for (int i = 0; i < kAnswers; ++i) {
            const double x = levels[static_cast<std::size_t>(i) % levels.size()];
            const double first = perceived_ln(felt_with(6.0, pins), {}, random);
            const double second = perceived_ln(felt_with(6.0 + x, pins), {}, random);
            right += (second > first) == (x > 0.0) ? 1 : 0;
        }
        const double share = static_cast<double>(right) / kAnswers;
        CAPTURE(pins);
        CHECK(std::abs(share - (pins ? 0.82 : 0.56)) < 0.01);  // three standard errors of 20,000 answers
    }
}

TEST_CASE("simulated touch: hand and fingertip read the same stiffness from force, depth and shape") {
    for (const double N_per_m : {100.0, 304.0, 1000.0}) {
        const FeltStiffness felt = feel_by_hand(press_on(N_per_m, 1.0));
        CHECK(felt.by(Sense::hand) == close_to(std::log(N_per_m)).epsilon(1e-9));
        CHECK(felt.by(Sense::fingertip) == close_to(std::log(N_per_m)).epsilon(1e-9));
        CHECK_FALSE(std::isfinite(felt.by(Sense::eye)));
        CHECK(feel_by_eye(press_on(N_per_m, 1.0)).by(Sense::eye) == felt.by(Sense::hand));
    }
}

TEST_CASE("simulated touch: pins at the end of their stroke tell nothing more, so the shape counts while it grows") {
    const double soft = feel_by_hand(press_on(304.0, 2e-3)).by(Sense::fingertip);  // at 0.85 N the stroke is used up
    CHECK(soft == close_to(std::log(304.0)).epsilon(1e-6));
}

TEST_CASE("simulated touch: what is displayed wrongly is felt wrongly") {
    std::vector<FeltMoment> press = press_on(304.0, 2e-3);
    for (FeltMoment& moment : press) {
        moment.force_N *= 1.1;  // an arm that is too stiff,
        moment.shape_m *= 0.9;  // and pins that stay behind
    }
    const FeltStiffness felt = feel_by_hand(press);
    CHECK(felt.by(Sense::hand) == close_to(std::log(1.1 * 304.0)).epsilon(1e-9));
    CHECK(felt.by(Sense::fingertip) == close_to(std::log(1.1 / 0.9 * 304.0)).epsilon(1e-6));
}

TEST_CASE("simulated touch: without pins the fingertip is told nothing, and without a press nobody is") {
    std::vector<FeltMoment> press = press_on(304.0, 0.0);
    CHECK_FALSE(std::isfinite(feel_by_hand(press).by(Sense::fingertip)));
    for (const auto& none : {std::vector<FeltMoment>{}, std::vector<FeltMoment>(50)}) {
        const FeltStiffness felt = feel_by_hand(none);
        CHECK_FALSE(std::isfinite(felt.by(Sense::hand)));
        CHECK_FALSE(std::isfinite(felt.by(Sense::fingertip)));
        Random random(3);
        CHECK(std::isfinite(perceived_ln(felt, {}, random)));  // a guess
    }
}

TEST_CASE("simulated touch: moments that are no numbers are left out") {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    std::vector<FeltMoment> press = press_on(304.0, 2e-3);
    const FeltStiffness clean = feel_by_hand(press);
    press.insert(press.begin() + 40, {kNan, 1e-3, 1e-3, 1e-3});
    press.insert(press.begin() + 90, {1.0, 1e-3, kNan, 1e-3});
    press.push_back({1.0, 1e-3, 1e-3, std::numeric_limits<double>::infinity()});
    const FeltStiffness felt = feel_by_hand(press);
    CHECK(felt.by(Sense::hand) == clean.by(Sense::hand));
    CHECK(felt.by(Sense::fingertip) == clean.by(Sense::fingertip));
}

TEST_CASE("simulated touch: a soft surface tells hand and fingertip the same, and the joined estimate is that") {
    const FeltStiffness felt = feel_soft_surface(press_on(300.0, 0.0));
    CHECK(felt.by(Sense::hand) == close_to(std::log(300.0)));
    CHECK(felt.by(Sense::fingertip) == felt.by(Sense::hand));
    CHECK_FALSE(std::isfinite(felt.by(Sense::eye)));
    CHECK(joined_ln(felt, {}) == close_to(std::log(300.0)));
    FeltStiffness two;
    two.by(Sense::hand) = 1.0;
    two.by(Sense::fingertip) = 2.0;
    TouchNoise noise;
    noise.sd = {1.0, 0.5, 1.0};
    CHECK(joined_ln(two, noise) == close_to((1.0 + 4.0 * 2.0) / 5.0));
    CHECK_FALSE(std::isfinite(joined_ln({}, noise)));
}
