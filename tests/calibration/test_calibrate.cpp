#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "calibration/calibrate.h"
#include "tests/close_to.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::calibration;
using namespace palpa::test;

namespace {

constexpr unsigned kSeed = 7;

void add_row(double level, double force_N, int repeat, CalibrationRows& rows) {
    rows.level.push_back(level);
    rows.force_N.push_back(force_N);
    rows.repeat.push_back(repeat);
    rows.line.push_back(rows.line.size() + 2);
}

// Presses of one pen, each a little off as a whole, each point a little more.
CalibrationRows presses(int repeats, int points, double repeat_error, double point_error, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    CalibrationRows rows;
    for (int r = 0; r < repeats; ++r) {
        const double offset = repeat_error * normal(random);
        for (int i = 0; i < points; ++i) {
            const double x = (i + 0.5) / points;
            add_row(x, 0.1 * std::exp(4.0 * x + offset + point_error * normal(random)), r, rows);
        }
    }
    return rows;
}

bool any_with(const std::vector<std::string>& texts, const std::string& part) {
    return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) { return contains(text, part); });
}

// 0.25 Hz up and down, the level `lag_s` late, the force at a level `loop` of itself greater when pressing.
CalibrationRows waves(double lag_s, double loop, std::mt19937_64& random, double step_s = 0.005,
                      double noise_N = 0.004) {
    std::normal_distribution<double> normal;
    CalibrationRows rows;
    for (int i = 0; i < std::lround(20.0 / step_s); ++i) {
        const double t_s = step_s * i;
        const auto force_N = [](double t) { return 0.06 + 2.6 * (0.5 - 0.5 * std::cos(0.5 * M_PI * t)); };
        const bool pressing = std::fmod(t_s - lag_s + 4.0, 4.0) < 2.0;
        const double felt_N = force_N(t_s - lag_s) / (pressing ? 1.0 + loop : 1.0);
        rows.time_s.push_back(t_s);
        rows.level.push_back(std::clamp(std::log(felt_N / 0.05) / std::log(3.0 / 0.05), 0.0, 1.0));
        rows.force_N.push_back(std::max(0.0, force_N(t_s) + noise_N * normal(random)));
        rows.line.push_back(static_cast<std::size_t>(i + 2));
    }
    return rows;
}

}  // namespace

TEST_CASE("calibrate: left-out points choose the law that made the data, and its error") {
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> normal;
    CalibrationRows power, loud;
    for (int i = 1; i <= 2000; ++i) {
        const double x = i / 2000.0;
        add_row(x, 3.0 * std::pow(x, 1.6) * std::exp(0.05 * normal(random)), 0, power);
        add_row(x, std::max(0.0, 0.1 * std::exp(4.0 * x) + 0.1 * normal(random)), 0, loud);
    }
    const Calibration a = calibrate(power, {});
    CHECK(a.profile.curve.model == CurveModel::power);
    CHECK(a.chosen.error == ErrorModel::log);
    CHECK(a.profile.curve.b == close_to(1.6).epsilon(0.01));
    const Calibration b = calibrate(loud, {});
    CHECK(b.chosen.error == ErrorModel::newton);
    CHECK(b.profile.curve.model != CurveModel::power);
}

TEST_CASE("calibrate: 95 % intervals over repeats hold the truth about that often") {
    // 200 pens, 6 presses that differ by 5 %. Single points would promise sqrt(20) too much.
    std::mt19937_64 random(kSeed);
    CAPTURE(kSeed);
    CalibrateOptions options;
    options.model = CurveModel::exponential;
    options.error = ErrorModel::log;
    options.bootstrap_fits = 300;
    int by_repeats = 0;
    int by_points = 0;
    for (int pen = 0; pen < 200; ++pen) {
        CalibrationRows rows = presses(6, 20, 0.05, 0.02, random);
        const auto holds = [&] {
            const Bootstrap boot = calibrate(rows, options).bootstrap;
            const double truth_N = 0.1 * std::exp(4.0 * boot.level[50]);
            return boot.low_N[50] < truth_N && truth_N < boot.high_N[50];
        };
        by_repeats += holds();
        rows.repeat.clear();
        by_points += holds();
    }
    MESSAGE("of 200 intervals, the truth was in ", by_repeats, " (repeats drawn) and ", by_points, " (points drawn)");
    CHECK(by_repeats > 176);
    CHECK(by_points < 110);
}

TEST_CASE("calibrate: the lag between pen and sensor is found and removed") {
    std::mt19937_64 random(kSeed);
    for (const double lag : {0.043, -0.02, 0.0, 0.11}) {
        CAPTURE(lag);
        const CalibrationRows rows = waves(lag, 0.0, random);
        const Calibration calibration = calibrate(rows, {});
        REQUIRE(calibration.lag_s);
        CHECK(std::abs(*calibration.lag_s - lag) < 1e-3);  // a fifth of a sample
        CHECK(calibration.quality.r2_newton > 0.999);
        CHECK(std::abs(calibration.hysteresis->median_relative) < 0.02);  // noise of any standard library
    }
    CalibrateOptions keep;
    keep.remove_lag = false;
    CHECK(calibrate(waves(0.11, 0.0, random), keep).quality.r2_newton < 0.98);
    // five presses of 0.8 s, a row each 10 ms, sampled without a gap: no half period is taken for a lag
    CalibrationRows quick;
    std::normal_distribution<double> normal;
    for (int i = 0; i < 400; ++i) {
        const int k = i % 80;
        add_row(0.02 + 0.96 * (k < 40 ? k : 79 - k) / 39.0, 0.0, i / 80, quick);
        quick.force_N.back() = 0.11 * std::exp(3.4 * quick.level.back()) + 0.05 * normal(random);
        quick.time_s.push_back(0.01 * (i + 1));
        quick.phase.push_back(k < 40 ? PressPhase::press : PressPhase::release);
    }
    const Calibration pressed = calibrate(quick, {});
    REQUIRE(pressed.lag_s);
    CHECK(std::abs(*pressed.lag_s) < 2e-3);
    CHECK(pressed.quality.r2_newton > 0.99);
    // a ramp alone fits any lag
    CalibrationRows ramp = waves(0.043, 0.0, random);
    for (auto* column : {&ramp.level, &ramp.force_N, &ramp.time_s}) column->resize(380);
    ramp.line.resize(380);
    CHECK_FALSE(calibrate(ramp, {}).lag_s);
}

TEST_CASE(
    "calibrate: lag and hysteresis are told apart, each alone and both at once, in long presses and in short ones") {
    std::mt19937_64 random(kSeed);
    for (const double lag : {0.0, 0.02, 0.06, 0.1}) {
        for (const double loop : {0.0, 0.05, 0.2}) {
            for (const bool gaps : {false, true}) {
                CAPTURE(lag);
                CAPTURE(loop);
                CAPTURE(gaps);
                CalibrationRows rows = waves(lag, loop, random);
                for (std::size_t i = 0; i < rows.time_s.size(); ++i) {
                    const auto press = static_cast<int>(rows.time_s[i] / 4.0);
                    rows.repeat.push_back(press);
                    if (gaps) rows.time_s[i] += 3.0 * press;  // each press by itself
                }
                CalibrateOptions options;
                options.bootstrap_fits = 0;
                const Calibration calibration = calibrate(rows, options);
                REQUIRE(calibration.lag_s);
                CHECK(std::abs(*calibration.lag_s - lag) < 3e-3);
                REQUIRE(calibration.hysteresis);
                CHECK(std::abs(calibration.hysteresis->median_relative - loop / (1.0 + 0.5 * loop)) < 0.02);
            }
        }
    }
}

TEST_CASE(
    "calibrate: the noise of a load cell at 100 Hz, 0.5 and 1 % of its highest force, is neither lag nor hysteresis") {
    for (const double noise_N : {0.013, 0.026}) {
        for (std::uint64_t seed = kSeed; seed < kSeed + 8; ++seed) {
            CAPTURE(noise_N);
            CAPTURE(seed);
            std::mt19937_64 random(seed);
            CalibrateOptions options;
            options.bootstrap_fits = 0;
            const Calibration calibration = calibrate(waves(0.0, 0.0, random, 0.01, noise_N), options);
            REQUIRE(calibration.lag_s);
            CHECK(std::abs(*calibration.lag_s) < 1.5e-3);
            REQUIRE(calibration.hysteresis);
            CHECK(std::abs(calibration.hysteresis->median_relative) < 0.015);
        }
    }
}

TEST_CASE("calibrate: the loop between pressing and releasing is reported, by phase or by time") {
    std::mt19937_64 random(kSeed);
    CalibrationRows rows;
    for (int i = 1; i < 60; ++i) {
        const double x = i / 60.0;
        add_row(x, 0.1 * std::exp(3.5 * x) * 1.2, 0, rows);
        rows.phase.push_back(PressPhase::press);
        add_row(x, 0.1 * std::exp(3.5 * x), 0, rows);
        rows.phase.push_back(PressPhase::release);
    }
    const Calibration by_phase = calibrate(rows, {});
    REQUIRE(by_phase.hysteresis);
    CHECK(by_phase.hysteresis->median_relative == close_to(0.2 / 1.1).epsilon(0.02));
    CHECK((any_with(by_phase.warnings, "pressing takes 20 % more force than releasing") ||
           any_with(by_phase.warnings, "pressing takes 19.") || any_with(by_phase.warnings, "pressing takes 20.")));
    CalibrateOptions keep;
    keep.remove_lag = false;
    const Calibration by_time = calibrate(waves(0.0, 0.2, random), keep);
    REQUIRE(by_time.hysteresis);
    CHECK(by_time.hysteresis->median_relative == close_to(0.2 / 1.1).epsilon(0.15));
}

TEST_CASE("calibrate: points captured upwards, repeat after repeat, have no release, and no hysteresis") {
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> noise(0.0, 0.02);
    CalibrationRows rows;
    for (int i = 0; i < 120; ++i) {
        const double level = 0.05 + 0.93 * (i % 20) / 19.0;
        add_row(level, 0.2 * std::exp(3.1 * level) * (1.0 + noise(random)), i / 20, rows);
        rows.time_s.push_back(2.0 * i);
    }
    CHECK_FALSE(calibrate(rows, {}).hysteresis);
}

TEST_CASE("calibrate: presses of one reading each are no repeats that differ, and the first response is the lightest") {
    CalibrationRows rows;
    for (int i = 0; i < 38; ++i) {
        const double level = 0.05 * (1 + i % 19);
        add_row(level, (0.1 + 3.0 * std::pow(level, 1.3)) * (i < 19 ? 0.98 : 1.02), i, rows);
    }
    const Calibration calibration = calibrate(rows, {});
    CHECK_FALSE(calibration.drift);
    CHECK_FALSE(any_with(calibration.warnings, "repeats"));
    CHECK(calibration.ends.activation_N == close_to(0.98 * (0.1 + 3.0 * std::pow(0.05, 1.3))));
}

TEST_CASE("calibrate: repeats that drift are told") {
    CalibrationRows rows;
    for (int r = 0; r < 5; ++r) {
        for (int i = 1; i <= 30; ++i) add_row(i / 30.0, 0.1 * std::exp(4.0 * i / 30.0) * (1.0 + 0.04 * r), r, rows);
    }
    const Calibration calibration = calibrate(rows, {});
    REQUIRE(calibration.drift);
    CHECK(calibration.drift->per_repeat == close_to(0.04).epsilon(0.15));
    CHECK(calibration.by_repeats);
    CHECK(any_with(calibration.warnings, "repeats differ by"));

    CalibrationRows two;  // at levels of their own, as a hand holds them, so that the curve can go through each point
    for (int r = 0; r < 2; ++r) {
        for (int i = 1; i <= 14; ++i) {
            const double level = i / 14.5 + 0.012 * r;
            add_row(level, (0.05 + 2.95 * std::pow(level, 1.5)) * (1.0 + 0.06 * r), r, two);
        }
    }
    const Calibration apart = calibrate(two, {});
    REQUIRE(apart.drift);
    CHECK(apart.drift->spread == close_to(0.06 / 1.03).epsilon(0.2));
    CHECK(any_with(apart.warnings, "repeats differ by"));
}

TEST_CASE("calibrate: repeats at levels of their own do not differ by the misfit of the model that is asked for") {
    CalibrationRows rows;  // one press after the other from the lightest levels to the strongest
    for (int r = 0; r < 4; ++r) {
        for (int i = 0; i < 12; ++i) {
            const double level = 0.08 + 0.05 * i + 0.1 * r;
            add_row(level, 0.05 * std::exp(4.0 * level), r, rows);
        }
    }
    CalibrateOptions options;
    options.model = CurveModel::power;
    const Calibration calibration = calibrate(rows, options);
    REQUIRE(calibration.by_repeats);
    REQUIRE(calibration.drift);
    CHECK(calibration.drift->spread < 0.02);
    CHECK_FALSE(any_with(calibration.warnings, "repeats differ by"));
}

TEST_CASE("calibrate: a curve below 0 N at the lightest touch is told of, its rounding error is not") {
    const auto warnings_of = [](double offset_N) {
        CalibrationRows rows;
        for (int k = 1; k <= 20; ++k) {
            const double force_N = 0.12 * std::exp(3.5 * 0.05 * k) + offset_N;
            if (force_N > 0.0) add_row(0.05 * k, force_N, 0, rows);
        }
        CalibrateOptions options;
        options.model = CurveModel::exponential_offset;
        return calibrate(rows, options).warnings;
    };
    CHECK_FALSE(any_with(warnings_of(-0.1201), "at the lightest touch"));
    CHECK(any_with(warnings_of(-0.2), "the curve falls to -0.08 N at the lightest touch"));
}

TEST_CASE("calibrate: warnings in plain words, for pens and for fingers") {
    CalibrationRows pen;
    CalibrationRows finger;
    for (int i = 0; i <= 300; ++i) {
        const double F = 0.04 + 0.015 * i;
        add_row(std::clamp(std::log(F / 0.05) / std::log(2.8 / 0.05), 0.0, 1.0), F, 0, pen);
        add_row(0.7 * (1.0 - std::exp(-F / 0.4)), F, 0, finger);
    }
    const Calibration calibration = calibrate(pen, {});
    CHECK(calibration.ends.saturation_N == close_to(2.8).epsilon(0.01));
    CHECK(any_with(calibration.warnings, "N this pen reports full pressure"));
    CHECK(calibration.force_at_full_N == close_to(2.8).epsilon(0.02));
    CalibrateOptions options;
    options.level = LevelField::contact_area;
    const Calibration area = calibrate(finger, options);
    CHECK(any_with(area.warnings, "the contact area grows no more"));
    CHECK(area.profile.full_contact_area_px2 > 0.0);
    CalibrationRows in_px2 = finger;
    for (double& level : in_px2.level) level *= 8000.0;
    CHECK(contains(message_of([&] { calibrate(in_px2, options); }), "from 0 to 1, as `contact_area` has it"));

    CalibrationRows few;
    for (const double x : {0.3, 0.35, 0.4, 0.7, 0.75}) add_row(x, 0.1 * std::exp(4.0 * x), 0, few);
    const auto warnings = calibrate(few, {}).warnings;
    CHECK(any_with(warnings, "light touch below"));
    CHECK(any_with(warnings, "are extrapolated"));
    CHECK(any_with(warnings, "no point between 40 % and 70 %"));
    CHECK(any_with(warnings, "only 5 distinct levels"));
    few = {};
    for (const double x : {0.1, 0.3, 0.5, 0.7, 0.9}) add_row(x, 0.1 * std::exp(4.0 * x), 0, few);
    CHECK(
        any_with(calibrate(few, {}).warnings, "no point between 10 % and 30 % pressure, nor in 3 other gaps as wide"));
}

TEST_CASE("calibrate: a press that was broken off after its first point does not keep the others from their curve") {
    CalibrationRows rows;
    add_row(0.2, 0.0981 * std::exp(3.0 * 0.2) * 1.1, 0, rows);
    for (int i = 1; i <= 8; ++i) add_row(i / 8.0, 0.0981 * std::exp(3.0 * i / 8.0), 1, rows);
    CalibrateOptions options;
    options.model = CurveModel::exponential;
    const Calibration calibration = calibrate(rows, options);
    CHECK(calibration.force_at_full_N == close_to(0.0981 * std::exp(3.0)).epsilon(0.02));
    CHECK_FALSE(calibration.by_repeats);
}

TEST_CASE("calibrate: points far off the curve are told, and whether they pull it") {
    CalibrationRows rows;
    for (int i = 0; i <= 60; ++i)
        add_row(i / 60.0, 0.05 * std::exp(4.0 * i / 60.0) * (i % 20 == 10 ? 3.0 : 1.0), 0, rows);
    CalibrateOptions options;
    options.model = CurveModel::exponential;
    options.error = ErrorModel::newton;
    CHECK(
        any_with(calibrate(rows, options).warnings, "3 of 61 points are far off the curve (slips?) and count little"));
    options.robust = Robust::none;
    const auto warnings = calibrate(rows, options).warnings;
    CHECK_FALSE(any_with(warnings, "count little"));
    CHECK(any_with(warnings, "count in full"));
}

TEST_CASE("calibrate: of two readings that differ the curve takes the middle, which is told with its place") {
    const auto warnings_with = [](int presses, double slip = 1.5) {
        CalibrationRows rows;
        for (int press = 0; press < presses; ++press) {
            for (int i = 1; i <= 14; ++i) {
                const double force_N = 0.05 + 2.95 * std::pow(i / 14.0, 1.5);
                const double noise = 1.0 + 0.004 * ((7 * i + 5 * press) % 5 - 2);
                add_row(i / 14.0, force_N * noise * (i == 7 && press == 0 ? slip : 1.0), press, rows);
            }
        }
        return calibrate(rows, {}).warnings;
    };
    CHECK(any_with(warnings_with(2), "and the curve follows them at "));
    CHECK(any_with(warnings_with(2), "50 %"));
    CHECK(any_with(warnings_with(2), "press these levels again, until each has three readings"));
    CHECK_FALSE(any_with(warnings_with(2), "count little"));
    for (const int presses : {1, 2}) CHECK_FALSE(any_with(warnings_with(presses, 3.0), "count little"));
    CHECK(any_with(warnings_with(4), "count little"));
}

TEST_CASE("calibrate: a stated level that the points cannot be of is refused") {
    CalibrationRows counts, shares;
    counts.file = shares.file = "p.csv";
    for (int i = 0; i <= 20; ++i) {
        add_row(200.0 * i, 0.1 * std::exp(0.15 * i), 0, counts);
        add_row(0.05 * i, 0.1 * std::exp(0.15 * i), 0, shares);
    }
    CalibrateOptions options;
    options.level = LevelField::pressure;
    CHECK(contains(message_of([&] { calibrate(counts, options); }), "from 0 to 1, as `pressure` has it"));
    CHECK(calibrate(shares, options).profile.level == LevelField::pressure);
    options.level = LevelField::pressure_raw;
    CHECK(contains(message_of([&] { calibrate(shares, options); }), "counts, as `pressure_raw` has it"));
    CHECK(calibrate(counts, options).profile.level == LevelField::pressure_raw);
}

TEST_CASE("hard case 3: forces that do not rise are refused") {
    CalibrationRows rows;
    for (int i = 0; i < 20; ++i) add_row(i / 20.0, 2.0 - 0.05 * i, 0, rows);
    CHECK(contains(message_of([&] { calibrate(rows, {}); }), "forces that do not rise with the level"));
}
