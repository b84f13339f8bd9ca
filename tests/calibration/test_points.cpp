#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "calibration/calibrate.h"
#include "calibration/points.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::calibration;
using namespace palpa::test;

namespace {

CalibrationRows read(const std::string& text, const ReadOptions& options = {}) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "d.csv", text);
    return read_points(folder / "d.csv", options);
}

std::string refusal_of_points(const std::string& text, const ReadOptions& options = {}) {
    return message_of([&] { read(text, options); });
}

}  // namespace

TEST_CASE("points: columns by name, gram-force becomes newtons") {
    const CalibrationRows rows =
        read("repeat,force_gf,level,phase,time_s\nb,10,0.1,press,1\nb,100,0.5,press,2\na,200,0.9,release,0\n");
    CHECK(rows.force_N[1] == close_to(0.980665));
    CHECK(rows.repeat == std::vector<int>{0, 0, 1});
    CHECK(read("level,force_N,repeat\n0.1,1,10\n0.2,2,9\n0.3,3,11\n").repeat == std::vector<int>{1, 0, 2});
    CHECK(rows.phase[2] == PressPhase::release);
    CHECK(rows.line[2] == 4);
    CHECK(read("pressure_norm,force_N\n0,0.1\n0.5,1\n1,2\n").level[1] == 0.5);
    CHECK(read("level,force_N,pen\n0,0.1,a\n0.5,1,a\n0.7,2,b\n1,2,a\n", {{{"pen", "a"}}, false, true}).level.size() ==
          3);
    const CalibrationRows sessions = read("level,force_N,pen\n0,0.1,a\n0.5,1,a\n1,2,a\n0.5,2,b\n");
    CHECK(contains(sessions.notes.at(0), "2 sessions"));
    CHECK(sessions.repeat.back() == 1);
}

TEST_CASE("points: full level that begins between two points far apart is not fitted where its rows are, and said") {
    CalibrationRows rows;
    const auto level = [](double force_N) { return std::min(1.0, std::pow(force_N / 2.5, 0.6)); };
    for (int k = 3; k < 30; ++k) {  // three presses, each with the same steps
        rows.force_N.push_back(0.27 * (k / 3));
        rows.level.push_back(level(rows.force_N.back()));
        rows.line.push_back(static_cast<std::size_t>(k + 1));
    }
    const auto with = [&](double full_N) {
        CalibrationRows more = rows;
        more.force_N.push_back(full_N);
        more.level.push_back(1.0);
        more.line.push_back(40);
        return calibrate(more, {});
    };
    const Calibration open = with(2.98);
    CHECK(open.ends.before_saturation_N == close_to(2.43));
    CHECK(value_N(open.profile.curve, 1.0) == close_to(2.5).epsilon(0.01));  // 2.98 before
    CHECK(contains(open.warnings.at(1), "begins somewhere between 2.43 and 2.98 N"));
    const Calibration closed = with(2.51);
    CHECK(std::isnan(closed.ends.before_saturation_N));
    CHECK(value_N(closed.profile.curve, 1.0) == close_to(2.51).epsilon(0.005));
    // eight presses of the very same levels, with one level in the highest tenth
    CalibrationRows alike;
    for (int press = 0; press < 8; ++press) {
        for (int k = 1; k <= 13; ++k) {
            alike.level.push_back(k < 13 ? 0.0816 * k : 1.0);
            alike.force_N.push_back((k < 13 ? 0.06 * std::pow(40.0, alike.level.back()) : 3.0) *
                                    (1.0 + 1e-3 * (press % 3)));
            alike.line.push_back(static_cast<std::size_t>(13 * press + k + 1));
            alike.repeat.push_back(press + 1);
        }
    }
    const Calibration repeated = calibrate(alike, {});
    CHECK(value_N(repeated.profile.curve, 1.0) == close_to(2.4).epsilon(0.02));  // 3.0 before
    CHECK_FALSE(std::isnan(repeated.ends.before_saturation_N));
    // nothing between the ends
    CalibrationRows ends_alone;
    for (int k = 0; k < 8; ++k) {
        ends_alone.level.push_back(k < 4 ? 0.0 : 1.0);
        ends_alone.force_N.push_back(0.1 + 0.3 * k);
        ends_alone.line.push_back(static_cast<std::size_t>(k + 2));
    }
    CHECK(message_of([&] { calibrate(ends_alone, {}); }) != "");
    // a steep end, of which too little is known: the row at full level is all there is
    CalibrationRows steep;
    for (int k = 0; k <= 10; ++k) {
        steep.level.push_back(k < 10 ? 0.08 * k + 0.08 : 1.0);
        steep.force_N.push_back(0.1 * std::exp(4.0 * steep.level.back()));
        steep.line.push_back(static_cast<std::size_t>(k + 2));
    }
    CHECK(std::isnan(ends_of(steep, {0.0, 1.0}).before_saturation_N));
}

TEST_CASE("points: presses that drift are no saturation; a level that stays in each press is") {
    const auto drifting = [](double most_level) {
        CalibrationRows rows;
        for (int press = 0; press < 5; ++press) {
            for (int k = 0; k <= 100; ++k) {
                const double force_N = 0.022 * k;
                rows.time_s.push_back(5.0 * press + 0.02 * k);
                rows.level.push_back(std::min(most_level, std::pow(force_N / 2.4575, 0.4)));
                rows.force_N.push_back(force_N * (1.0 + 0.05 * press));
                rows.line.push_back(rows.line.size() + 2);
            }
        }
        return rows;
    };
    CHECK(std::isnan(ends_of(drifting(1.0), {0.0, 1.0}).saturation_N));
    CHECK(ends_of(drifting(0.8), {0.0, 1.0}).saturation_N > 1.0);
}

TEST_CASE("hard case 3: every kind of bad points has a message that names it") {
    const std::string head = "level,force_N\n";
    CHECK(contains(refusal_of_points(head + "0,0.1\n0.5,1\n0,0.2\n0.5,1.1\n"),
                   "2 distinct levels in 4 rows, expected 3 at least"));
    CHECK(contains(refusal_of_points(head), "no rows"));
    CHECK(contains(refusal_of_points(head + "0,1\n0.5,1\n1,1\n"), "the same force, 1 N, in every row"));
    CHECK(contains(
        refusal_of_points(head + "0,0.1\n0.5,-0.03\n1,2\n"),
        "line 3, force_N: found '-0.03', expected a force >= 0, or noise down to -0.02 (was the sensor zeroed?)"));
    CHECK(
        contains(refusal_of_points("level,force_gf\n0,10\n0.5,-30\n1,200\n"),
                 "line 3, force_gf: found '-30', expected a force >= 0, or noise down to -2 (was the sensor zeroed?)"));
    CHECK(refusal_of_points(head + "0,-0.01\n0.5,0.5\n1,2\n").empty());  // the noise of a sensor at rest
    CHECK(contains(refusal_of_points(head + "0,0.1\n0.5,nan\n1,2\n"),
                   "line 3, force_N: found 'nan', expected a finite number"));
    CHECK(contains(refusal_of_points(head + "0,0.1\n0.5,\n1,2\n"),
                   "line 3, force_N: found '', expected a finite number"));
    CHECK(contains(refusal_of_points(head + "0,0.1\n-0.5,1\n1,2\n"),
                   "line 3, level: found '-0.5', expected a level >= 0"));
    CHECK(contains(refusal_of_points(head + "0,0.1\n0.5,inf\n1,2\n"), "finite number"));
    CHECK(contains(refusal_of_points("level,weight\n0,0.1\n"), "expected a column 'force_N'"));
    CHECK(contains(refusal_of_points("pressure,force_N\n0,0.1\n"), "expected a column 'level'"));
    CHECK(contains(refusal_of_points("level,force_N,phase\n0,0.1,down\n"), "expected press or release"));
    CHECK(contains(refusal_of_points(head + "0,0.1\n0.5,1\n1,2\n", {{{"level", "7"}}, false, true}),
                   "no row with level=7"));
    CHECK(contains(refusal_of_points(head + "0,0.1\n0.5,1\n1,2\n", {{{"pen", "7"}}, false, true}),
                   "expected a column 'pen'"));
}

TEST_CASE("hard case 3: gram-force and newtons mixed up are seen") {
    CHECK(contains(refusal_of_points("level,force_N\n0,5\n0.5,80\n1,250\n"),
                   "forces up to 250 N, expected less than 60 N"));
    CHECK(refusal_of_points("level,force_N\n0,5\n0.5,80\n1,250\n", {{}, true, true}) == "");
    CHECK(
        contains(refusal_of_points("level,force_gf\n0,0.05\n0.5,0.8\n1,2.5\n"), "(2.5 gf), expected more than 0.15 N"));
    // the column is called as the file calls it
    CHECK(contains(refusal_of_points("level,force_N\n0,0.0002\n0.5,0.0017\n1,0.0035\n"),
                   "force_N: found no force above"));
    CHECK(contains(refusal_of_points("level,force_gf\n0,50\n0.5,800\n1,25000\n"), "force_gf: found forces up to"));
    CHECK(contains(refusal_of_points("level,force_N,force_gf\n0,0.1,10.2\n0.5,1,102\n1,2,2\n"),
                   "line 4, force_gf: found '2', expected 203.9 gf"));
    std::string mixed = "level,force_N\n";
    for (int i = 1; i <= 12; ++i)
        mixed += number_text(i / 12.0) + "," + number_text(i == 7 ? 0.4 * 101.97 : 0.05 * i) + "\n";
    CHECK(contains(refusal_of_points(mixed), "line 8, force: found 40.79 N, expected about"));
    // light forces that drown in the noise of the sensor are no other unit; a tenth of the rows in another one are seen
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    std::string noisy = "level,force_N\n", tenth = noisy;
    for (int i = 0; i < 300; ++i) {
        const double force_N = 0.05 * std::exp(3.5 * i / 300.0);
        noisy += number_text(i / 300.0) + "," + number_text(std::abs(force_N + 0.03 * normal(random))) + "\n";
        tenth += number_text(i / 300.0) + "," +
                 number_text(force_N * (1.0 + 0.02 * normal(random)) * (i % 10 == 5 ? 9.80665e-3 : 1.0)) + "\n";
    }
    CHECK(refusal_of_points(noisy) == "");
    CHECK(contains(refusal_of_points(tenth), "gram-force and newtons mixed up?"));
}

TEST_CASE("hard case 3: times that do not rise, and a sensor that stands still") {
    const std::string head = "time_s,level,force_N\n";
    CHECK(contains(refusal_of_points(head + "0,0,0.1\n2,0.5,1\n1,1,2\n"),
                   "line 4, time_s: found 1 after 2, expected times that rise"));
    CHECK(contains(refusal_of_points(head + "0,0,0.1\n1,0.5,1\n1,1,2\n"), "line 4, time_s: found 1 after 1"));
    CHECK(refusal_of_points("time_s,repeat,level,force_N\n0,1,0,0.1\n1,1,0.5,1\n0,2,1,2\n") == "");
    std::string stopped = head;
    for (int i = 0; i < 40; ++i)
        stopped += number_text(0.1 * i) + "," + number_text(i / 40.0) + "," +
                   number_text(i < 20 ? 0.1 + 0.05 * i : 1.05) + "\n";
    CHECK(contains(refusal_of_points(stopped),
                   "lines 21 to 41, force: found 1.05 N all the time while the level goes from 0.475 to 0.975"));
}

TEST_CASE("points: silence below activation and the plateau above saturation are told from the curve") {
    CalibrationRows rows;
    for (int i = 0; i <= 400; ++i) {
        const double F = 0.01 * i;  // 0 to 4 N; activation at 0.05, full at 2.8
        rows.force_N.push_back(F);
        rows.level.push_back(std::clamp(std::log(std::max(F, 1e-9) / 0.05) / std::log(2.8 / 0.05), 0.0, 1.0));
        rows.line.push_back(static_cast<std::size_t>(i + 2));
    }
    const Ends ends = ends_of(rows, {0.0, 1.0});
    CHECK(ends.activation_N == close_to(0.06));
    CHECK(ends.saturation_N == close_to(2.8));
    CHECK(ends.above_saturation_N == close_to(4.0));
    const FitPoints points = fit_points(rows, {0.0, 1.0}, ends);
    CHECK(points.level.size() > 270);
    CHECK(points.level.size() < 285);  // the silent and the saturated rows are gone but for the nearest
    CHECK((points.level.tail(points.level.size() - 1) >= points.level.head(points.level.size() - 1)).all());

    // a finger's area that flattens at 0.62 with noise: no hard stop, and no full scale
    for (std::size_t i = 0; i < rows.level.size(); ++i) {
        rows.level[i] =
            0.62 * (1.0 - std::exp(-rows.force_N[i] / 0.3)) + 0.002 * std::sin(1e3 * static_cast<double>(i));
    }
    const Ends area = ends_of(rows, {0.0, 1.0});
    CHECK(area.saturation_N > 0.8);
    CHECK(area.saturation_N < 1.3);

    // a curve that simply ends is not saturated
    for (std::size_t i = 0; i < rows.level.size(); ++i)
        rows.level[i] = std::clamp(std::log(std::max(rows.force_N[i], 1e-9) / 0.05) / 5.0, 0.0, 1.0);
    CHECK(std::isnan(ends_of(rows, {0.0, 1.0}).saturation_N));
}

TEST_CASE("points: weights put on several times saturate a pen where the first of them is at full level") {
    std::string text = "repeat,level,force_gf\n";
    for (int r = 0; r < 3; ++r) {
        for (const double weight_gf : {10.0, 20.0, 50.0, 100.0, 200.0, 300.0, 400.0, 500.0, 600.0}) {
            const double level = weight_gf >= 400.0 ? 1.0 : 0.22 * std::log(weight_gf / 5.0) * (1.0 + 0.002 * r);
            text += std::to_string(r) + "," + number_text(level) + "," + number_text(weight_gf) + "\n";
        }
    }
    const CalibrationRows rows = read(text);
    const Ends ends = ends_of(rows, {0.0, 1.0});
    CHECK(ends.saturation_N == close_to(400.0 * 9.80665e-3));
    CHECK(ends.saturated == 6);
    CHECK(fit_points(rows, {0.0, 1.0}, ends).force_N.maxCoeff() == close_to(400.0 * 9.80665e-3));
}

TEST_CASE("points: noise in share of the force is no saturation, however many rows there are") {
    for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
        for (const int n : {300, 1000, 5000}) {
            CAPTURE(seed);
            CAPTURE(n);
            std::mt19937 random(seed);
            std::uniform_real_distribution<double> level(0.0, 0.9999);
            std::normal_distribution<double> noise(0.0, 0.06);
            CalibrationRows rows, saturated;
            for (int i = 0; i < n; ++i) {
                rows.level.push_back(level(random));
                rows.force_N.push_back(0.1 * std::exp(4.0 * rows.level.back()) * (1.0 + noise(random)));
                rows.line.push_back(static_cast<std::size_t>(i + 2));
            }
            CHECK(std::isnan(ends_of(rows, {0.0, 1.0}).saturation_N));
            saturated = rows;  // the pen reports no more than 0.8
            for (double& one : saturated.level) one = std::min(one, 0.8);
            CHECK(ends_of(saturated, {0.0, 1.0}).saturation_level == close_to(0.78));
        }
    }
}

TEST_CASE("points: the range of counts is the next power of two") {
    CHECK(level_range_of({0.0, 0.9}).highest == 1.0);
    CHECK(level_range_of({0.0, 1023.0}).highest == 1023.0);
    CHECK(level_range_of({0.0, 1024.0}).highest == 2047.0);
    CHECK(level_range_of({0.0, 8000.0}).highest == 8191.0);
}
