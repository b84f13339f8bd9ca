#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "avatar/display_ratio.h"
#include "tests/avatar/test_tissues.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::avatar;
using namespace palpa::test;

namespace {

constexpr double kTolerance_m = 1e-9;  // 1e-6 mm, as the reference values are printed

template <class Force>
double lag_after(const DisplayRatio& law, const std::vector<Touch>& samples, Force force_N, DisplayRatioState& state) {
    Eigen::Vector2d lag = Eigen::Vector2d::Zero();
    for (const Touch& touch : samples) lag = advance_lag(law, touch, rise_of(force_N), state);
    return lag.x();
}

template <class Force>
double lag_after(const DisplayRatio& law, const std::vector<Touch>& samples, Force force_N) {
    DisplayRatioState state;
    return lag_after(law, samples, force_N, state);
}

}  // namespace

TEST_CASE("display ratio: gain at a rise of 18 mN") {
    CHECK(display_gain(display_ratio_paper(), 0.018) == close_to(0.982318).epsilon(1e-6));
    CHECK(display_gain(display_ratio_clear(), 0.018) == close_to(0.526316).epsilon(1e-6));
    CHECK(display_gain(display_ratio_clear(), -0.5) == 1.0);
    CHECK(display_gain(display_ratio_clear(), 0.0) == 1.0);
}

TEST_CASE("display ratio: reference lags on the tent, at every sampling rate") {
    struct Row {
        bool clear;
        double x_mm;
        double lag_mm;
    };
    const Row rows[] = {{false, -3, 0.032652302}, {false, 0, 0.085697488}, {false, 1, 0.0},
                        {true, -3, 0.768673643},  {true, 0, 1.610544454},  {true, 1, 0.780531384},
                        {true, 1.4, 0.380531384}};
    for (const Row& row : rows) {
        for (const double rate_Hz : {30.0, 60.0, 100.0, 133.0, 240.0, 1000.0}) {
            CAPTURE(row.clear);
            CAPTURE(row.x_mm);
            CAPTURE(rate_Hz);
            const DisplayRatio law = row.clear ? display_ratio_clear() : display_ratio_paper();
            const double lag_m = lag_after(law, stroke(rate_Hz, 1e-3 * row.x_mm), tent_N);
            CHECK(std::abs(lag_m - 1e-3 * row.lag_mm) < kTolerance_m);
        }
    }
}

TEST_CASE("display ratio: the lag decays while the pen stands still") {
    const DisplayRatio law = display_ratio_clear();
    DisplayRatioState state;
    const auto samples = stroke(1000, -3e-3);
    CHECK(std::abs(lag_after(law, samples, tent_N, state) - 0.768673643e-3) < kTolerance_m);
    struct Row {
        int after_ms;
        double lag_mm;
    };
    const Row rows[] = {{100, 0.768674}, {150, 0.755969}, {250, 0.278105}, {350, 0.102309}, {650, 0.005094}};
    const double stop_s = samples.back().t_s;
    int ms = 0;
    for (const Row& row : rows) {
        double lag_m = 0.0;
        for (; ms < row.after_ms; ++ms) {
            lag_m = advance_lag(law, touch_at(stop_s + 1e-3 * (ms + 1), -3e-3), rise_of(tent_N), state).x();
        }
        CAPTURE(row.after_ms);
        CHECK(std::abs(lag_m - 1e-3 * row.lag_mm) < 0.6e-9);  // the table has nanometres
    }
}

TEST_CASE("display ratio: after a reversal the avatar waits for the pen") {
    const DisplayRatio law = display_ratio_clear();
    struct Row {
        double back_mm;
        double lag_mm;
        double avatar_mm;
    };
    for (const Row& row : {Row{0.3, 0.76867, -4.06867}, {0.6, 0.56867, -4.16867}, {1.2, 0, -4.2}, {1.8, 0, -4.8}}) {
        auto samples = stroke(1000, -3e-3);
        const double turn_s = samples.back().t_s;
        const int n = static_cast<int>(std::lround(row.back_mm / 0.03));
        for (int i = 1; i <= n; ++i) samples.push_back(touch_at(turn_s + 1e-3 * i, -3e-3 - 3e-5 * i));
        const double lag_m = lag_after(law, samples, tent_N);
        CAPTURE(row.back_mm);
        CHECK(std::abs(lag_m - 1e-3 * row.lag_mm) < 1e-8);
        CHECK(std::abs(samples.back().p_m.x() - lag_m - 1e-3 * row.avatar_mm) < 1e-8);
    }
}

TEST_CASE("display ratio: peak lag over a round bump is the same at 10, 30 and 100 mm/s") {
    struct Row {
        bool clear;
        double speed;
        double peak_mm;
    };
    for (const Row& row : {Row{true, 0.01, 1.614}, {true, 0.03, 1.614}, {true, 0.1, 1.614}, {false, 0.03, 0.0865}}) {
        const DisplayRatio law = row.clear ? display_ratio_clear() : display_ratio_paper();
        DisplayRatioState state;
        double peak_m = 0.0;
        double lag_past_m = 1.0;
        for (const Touch& touch : stroke(1000, 10e-3, row.speed)) {
            const double lag_m = advance_lag(law, touch, rise_of(bump_N), state).x();
            peak_m = std::max(peak_m, lag_m);
            if (touch.p_m.x() > -0.70e-3) lag_past_m = lag_m;
        }
        CHECK(peak_m == close_to(1e-3 * row.peak_mm).epsilon(2e-3));
        CHECK(lag_past_m == 0.0);
    }
}

TEST_CASE("hard case 8: display ratio with zero motion, repeated events, huge and negative rises") {
    const DisplayRatio law = display_ratio_clear();
    // every sample sent five times: the same lag to the last bit
    DisplayRatioState once;
    DisplayRatioState often;
    for (const Touch& touch : stroke(240, 0.0)) {
        const Eigen::Vector2d lag = advance_lag(law, touch, rise_of(tent_N), once);
        for (int i = 0; i < 5; ++i) CHECK(advance_lag(law, touch, rise_of(tent_N), often) == lag);
    }
    const auto wall = [](const Eigen::Vector2d& p, const Eigen::Vector2d&) { return p.x() > 0 ? 1e12 : 0.0; };
    CHECK(lag_after(law, stroke(240, 1e-4), wall) <= 3e-3);
    const auto cliff = [](const Eigen::Vector2d& p, const Eigen::Vector2d&) { return p.x() > 0 ? -1e12 : 0.0; };
    CHECK(lag_after(law, stroke(240, 1e-4), cliff) == 0.0);
}

TEST_CASE("hard case 9: display ratio gives its lag back at a bounded rate, then exactly zero") {
    const DisplayRatio law = display_ratio_clear();
    constexpr std::uint32_t kSeed = 20261121;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> turn(-0.6, 0.6);
    for (int path = 0; path < 50; ++path) {
        DisplayRatioState state;
        Touch touch = touch_at(0.0, -12e-3);
        Eigen::Vector2d before = touch.p_m;
        double heading = turn(random);
        advance_lag(law, touch, rise_of(bump_N), state);
        for (int i = 1; i < 4000; ++i) {
            heading += 0.05 * turn(random);
            touch.t_s = 1e-3 * i;
            const Eigen::Vector2d step = 3e-5 * Eigen::Vector2d(std::cos(heading), std::sin(heading));
            touch.p_m += step;
            const Eigen::Vector2d lag = advance_lag(law, touch, rise_of(bump_N), state);
            const Eigen::Vector2d avatar = touch.p_m - lag;
            REQUIRE(lag.norm() <= *law.cap_m * (1 + 1e-12));
            REQUIRE((avatar - before).norm() <= 2.2 * step.norm());
            before = avatar;
        }
        CHECK((touch.p_m - before).norm() < 1e-15);  // 108 mm on, away from the bump
    }
}

TEST_CASE("display ratio: not-a-number, lift and jump of the pen") {
    const DisplayRatio law = display_ratio_clear();
    DisplayRatioState state;
    const double lag_m = lag_after(law, stroke(1000, -3e-3), tent_N, state);
    const double t_s = state.path.last.t_s;
    Touch bad = touch_at(t_s + 1e-3, std::nan(""));
    CHECK(advance_lag(law, bad, rise_of(tent_N), state).x() == lag_m);
    CHECK(state.path.ignored == 1);
    CHECK(advance_lag(law, touch_at(t_s - 0.1, 0.0), rise_of(tent_N), state).x() == lag_m);
    CHECK(state.path.ignored == 2);
    CHECK(advance_lag(law, touch_at(t_s + 1e-3, 20e-3), rise_of(tent_N), state).x() == 0.0);
    CHECK(state.path.rope_m.x() == 20e-3);
    Touch up = touch_at(t_s + 2e-3, 20e-3);
    up.down = false;
    CHECK(advance_lag(law, up, rise_of(tent_N), state).norm() == 0.0);
}

TEST_CASE("display ratio: strength 1 is `clear`, `strong` has strength 4 and a wider cap") {
    DisplayRatio law;
    set_strength(1.0, law);
    CHECK(law.f_0_N == display_ratio_clear().f_0_N);
    CHECK(law.gate_N == display_ratio_clear().gate_N);
    set_strength(0.02, law);
    CHECK(law.f_0_N == display_ratio_paper().f_0_N);
    set_strength(4.0, law);
    CHECK(law.f_0_N == 0.005);
    CHECK(display_ratio_strong().f_0_N == 0.005);
    CHECK(*display_ratio_strong().cap_m == 8e-3);
    CHECK(display_gain(display_ratio_strong(), 0.005) == close_to(0.5));
    // as if the tissue were four times as stiff, below the cap
    const auto stiff_N = [](const Eigen::Vector2d& p, const Eigen::Vector2d& u) { return 4.0 * tent_N(p, u); };
    set_strength(4.0, law = display_ratio_clear());
    for (const double x_mm : {-4.0, -2.0, 0.0, 1.0})
        CHECK(lag_after(law, stroke(240, 1e-3 * x_mm), tent_N) ==
              close_to(lag_after(display_ratio_clear(), stroke(240, 1e-3 * x_mm), stiff_N)).epsilon(1e-12));
}

TEST_CASE("display ratio: a resting pen keeps its lag to the last bit for hold_s, then it decays") {
    for (const double hold_s : {0.15, 2.0}) {
        CAPTURE(hold_s);
        DisplayRatio law = display_ratio_clear();
        law.hold_s = hold_s;
        DisplayRatioState state;
        const auto samples = stroke(1000, -3e-3);
        const double lag_m = lag_after(law, samples, tent_N, state);
        const double moved_s = state.moved_s;
        const auto rest_until = [&](double t_s) {
            return advance_lag(law, touch_at(t_s, -3e-3), rise_of(tent_N), state).x();
        };
        CHECK(rest_until(moved_s + 0.99 * hold_s) == lag_m);
        CHECK(rest_until(moved_s + hold_s + law.pause_decay_s) == close_to(lag_m * std::exp(-1.0)));
    }
}
