// What a force arm does by itself, found from strokes.

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <numbers>
#include <random>

#include "files/text.h"
#include "tactile/arm_compensation.h"
#include "tactile/arm_strokes.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/mechanics/allocation_count.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::tactile;
using namespace palpa::test;

namespace {

ArmCompensation known_arm() {
    ArmCompensation arm;
    arm.coulomb_N = 1.8;
    arm.static_N = 2.5;
    arm.stribeck_m_per_s = 3.5e-3;
    arm.viscous_N_s_per_m = 2.0;
    arm.weight_N = 7.0;
    arm.ripple = {0.35, 11.3e-3, 0.7};
    return arm;
}

// What a hand feels of it at a steady speed.
double hand_force_N(const ArmCompensation& arm, double depth_m, double v) {
    const double ratio = v / arm.stribeck_m_per_s, sign = v > 0.0 ? 1.0 : -1.0;
    return -arm.weight_N +
           arm.ripple.amplitude_N *
               std::sin(2.0 * std::numbers::pi * depth_m / arm.ripple.wavelength_m + arm.ripple.phase_rad) +
           sign * (arm.coulomb_N + (arm.static_N - arm.coulomb_N) * std::exp(-ratio * ratio)) +
           arm.viscous_N_s_per_m * v;
}

// Strokes from 0 to 45 mm and back at steady speeds, without dynamics.
std::vector<StrokeRow> ideal_strokes(const ArmCompensation& arm, double noise_N) {
    std::mt19937_64 random(9);
    std::normal_distribution<double> noise;
    std::vector<StrokeRow> rows;
    double t_s = 0.0;
    for (const double speed : {24e-3, 12e-3, 6e-3, 3e-3, 1.5e-3}) {
        for (const double v : {speed, -speed}) {
            const double seconds = std::min(45e-3 / speed, 10.0);
            for (double done_s = 0.0; done_s < seconds; done_s += 1e-3, t_s += 1e-3) {
                const double depth_m = v > 0.0 ? v * done_s : -v * seconds + v * done_s;
                rows.push_back({t_s, depth_m, v, hand_force_N(arm, depth_m, v) + noise_N * noise(random), 0.0});
            }
        }
    }
    return rows;
}

// What is added after the arm has come a millimetre at this velocity.
double compensation_at(const ArmCompensation& arm, double depth_m, double v) {
    FrictionDirection direction;
    compensation_N(arm, depth_m - (v > 0.0 ? 1e-3 : -1e-3), v, direction);
    return compensation_N(arm, depth_m, v, direction);
}

}  // namespace

TEST_CASE("compensation: parameters of a known arm are found from ideal strokes") {
    const ArmCompensation arm = known_arm();
    const CompensationFit fit = fit_compensation(ideal_strokes(arm, 0.02));
    const ArmCompensation& found = fit.compensation;
    CHECK(found.coulomb_N == close_to(arm.coulomb_N).epsilon(0.01));
    CHECK(found.static_N == close_to(arm.static_N).epsilon(0.02));
    CHECK(found.stribeck_m_per_s == close_to(arm.stribeck_m_per_s).epsilon(0.05));
    CHECK(found.viscous_N_s_per_m == close_to(arm.viscous_N_s_per_m).epsilon(0.1));
    CHECK(found.weight_N == close_to(arm.weight_N).epsilon(0.001));
    CHECK(found.ripple.amplitude_N == close_to(arm.ripple.amplitude_N).epsilon(0.01));
    CHECK(found.ripple.wavelength_m == close_to(arm.ripple.wavelength_m).epsilon(0.002));
    CHECK(std::cos(found.ripple.phase_rad - arm.ripple.phase_rad) > 0.999);
    CHECK(fit.residual_N < 0.03);
}

TEST_CASE("compensation: what is added is what the arm takes, but a twentieth of the friction; none before it moves") {
    ArmCompensation arm = known_arm();
    for (const double v : {-0.05, -2e-3, 2e-3, 0.05}) {
        const double taken_N = hand_force_N(arm, 0.02, v);
        arm.share = 1.0;
        CHECK(compensation_at(arm, 0.02, v) == close_to(-taken_N).epsilon(1e-4));
    }
    arm.share = 0.95;
    arm.ripple.amplitude_N = arm.weight_N = 0.0;
    CHECK(compensation_at(arm, 0.02, 0.05) == close_to(-0.95 * (1.8 + 0.1)).epsilon(1e-6));
    FrictionDirection direction;
    CHECK(compensation_N(arm, 0.02, 0.0, direction) == 0.0);
}

TEST_CASE(
    "compensation: after a turn friction follows over some hundredths of a millimetre, and a jump leaves it whole") {
    ArmCompensation arm = known_arm();
    FrictionDirection direction;
    for (int i = 0; i <= 100; ++i) compensation_N(arm, 1e-6 * i, 1e-3, direction);
    CHECK(direction.share > 0.95);
    compensation_N(arm, 98e-6, -1e-3, direction);
    CHECK(direction.share > 0.8);
    for (int i = 98; i >= -50; --i) compensation_N(arm, 1e-6 * i, -1e-3, direction);
    CHECK(direction.share < -0.9);
    compensation_N(arm, 1.0, 0.0, direction);
    CHECK(direction.share == 1.0);
}

TEST_CASE("compensation: NaN gives no force and is forgotten, and nothing is allocated") {
    const ArmCompensation arm = known_arm();
    FrictionDirection direction;
    const long before = allocation_count();
    CHECK(compensation_N(arm, std::numeric_limits<double>::quiet_NaN(), 0.0, direction) == 0.0);
    CHECK(compensation_N(arm, 0.0, std::numeric_limits<double>::infinity(), direction) == 0.0);
    double sum_N = 0.0;
    for (int i = 0; i < 1000; ++i) sum_N += compensation_N(arm, 1e-5 * i, 1e-5 * (i - 500), direction);
    CHECK(std::isfinite(sum_N));
    CHECK(allocation_count() == before);
}

TEST_CASE("compensation: strokes that cannot tell are refused with what is missing") {
    std::vector<StrokeRow> rows = ideal_strokes(known_arm(), 0.0);
    const auto refused = [](const std::vector<StrokeRow>& some, const char* why) {
        CHECK_THROWS_WITH_AS(fit_compensation(some), doctest::Contains(why), std::runtime_error);
    };
    refused({}, "found 0 readings");
    refused({rows.begin(), rows.begin() + 500}, "readings of steady motion");
    refused({rows.begin(), rows.begin() + 1800}, "one direction");
    std::vector<StrokeRow> shortened = rows;
    for (StrokeRow& row : shortened) row.depth_m *= 0.1;
    refused(shortened, "over 4.48");
    for (StrokeRow& row : rows) row.sensor_N = std::numeric_limits<double>::quiet_NaN();
    refused(rows, "found 0 readings");
}

TEST_CASE("compensation: a written file reads back, and a wrong one is refused") {
    const test::TemporaryFolder folder;
    const auto path = folder / "compensation.json";
    CompensationFit fit;
    fit.compensation = known_arm();
    write_compensation(fit, "an arm", path);
    const ArmCompensation back = read_compensation(path);
    CHECK(back.static_N == 2.5);
    CHECK(back.ripple.wavelength_m == close_to(11.3e-3));
    CHECK(back.share == 0.95);
    std::string text = files::read_text(path);
    text.replace(text.find("\"static_N\": 2.5"), 15, "\"static_N\": 1.0");
    files::write_text_whole(path, text);
    const std::string said = test::message_of([&] { read_compensation(path); });
    CHECK(test::contains(said, "static_N"));
}
