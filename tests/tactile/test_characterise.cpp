// The stiffness that a simulated arm renders, in virtual time.

#include <cmath>
#include <doctest/doctest.h>

#include "tactile/characterise.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::tactile;
using namespace palpa::devices::simulators;
using namespace palpa::test;

namespace {

devices::Limits wide_limits() {
    devices::Limits limits;
    limits.force_N = 15.0;
    return limits;
}

ArmCompensation known_to(const ArmPlantParameters& arm) {
    ArmCompensation out;
    out.coulomb_N = arm.coulomb_N;
    out.static_N = arm.static_N;
    out.stribeck_m_per_s = arm.stribeck_m_per_s;
    out.viscous_N_s_per_m = arm.viscous_N_s_per_m;
    out.weight_N = 9.80665 * arm.weight_kg;
    out.ripple = {arm.ripple_N, arm.ripple_wavelength_m, arm.ripple_phase_rad};
    return out;
}

ArmCompensation identified(const ArmPlantParameters& arm, std::uint64_t seed) {
    const auto path = slow_strokes(-5e-3, 45e-3);
    StrokeOptions options;
    options.seconds = path.back().t_s;
    options.limits = wide_limits();
    const auto rig = virtual_rig(make_arm_plant(arm, path, seed));
    return fit_compensation(run_strokes(options, *rig).rows).compensation;
}

Strokes cycles_at(double stiffness_N_per_m, const ArmPlantParameters& arm,
                  const std::optional<ArmCompensation>& compensation, std::uint64_t seed) {
    const auto path = cycles(hand_depth_m(10e-3, stiffness_N_per_m, arm.hand_N_per_m), 3, 4.0);
    StrokeOptions options;
    options.seconds = path.back().t_s;
    options.limits = wide_limits();
    options.law = [stiffness_N_per_m](double depth_m) { return stiffness_N_per_m * depth_m; };
    options.compensation = compensation;
    const auto rig = virtual_rig(make_arm_plant(arm, path, seed));
    return run_strokes(options, *rig);
}

}  // namespace

TEST_CASE("characterise: arms of seeds 1 to 10, compensated: mean error 5 %, none over 15 %, hysteresis 0.2 N") {
    double uncompensated_sum = 0.0, uncompensated_hysteresis_N = 0.0, compensated_sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        CAPTURE(seed);
        const ArmPlantParameters arm = arm_parameters(seed);
        const ArmCompensation found = identified(arm, seed);
        double sum = 0.0;
        for (const double wanted : {250.0, 330.0, 500.0, 1000.0}) {
            CAPTURE(wanted);
            const auto law_N = [&](double depth_m) { return wanted * depth_m; };
            const StiffnessRun run = stiffness_of(law_N, cycles_at(wanted, arm, found, seed).rows);
            CHECK(std::abs(run.error_share) < 0.15);
            CHECK(run.hysteresis_N < 0.2);
            sum += std::abs(run.error_share) / 4.0;
            const StiffnessRun bare = stiffness_of(law_N, cycles_at(wanted, arm, std::nullopt, seed).rows);
            uncompensated_sum += std::abs(bare.error_share) / 40.0;
            uncompensated_hysteresis_N = std::max(uncompensated_hysteresis_N, bare.hysteresis_N);
        }
        CHECK(sum < 0.05);
        compensated_sum += sum / 10.0;
    }
    MESSAGE("mean error ", 100.0 * compensated_sum, " % compensated, ", 100.0 * uncompensated_sum, " % and +-",
            uncompensated_hysteresis_N, " N without");
    CHECK(uncompensated_sum > 2.0 * compensated_sum);
}

TEST_CASE("characterise: line, offset and hysteresis of readings that are known") {
    std::vector<StrokeRow> rows;
    for (int i = 0; i < 4000; ++i) {
        const bool down = i < 2000;
        const double depth_m = down ? 5e-6 * i : 5e-6 * (4000 - i);
        const double v = down ? 5e-3 : -5e-3;
        rows.push_back({1e-3 * i, depth_m, v, 400.0 * depth_m + 0.3 + (down ? 0.25 : -0.25), 0.0});
    }
    const StiffnessRun run = stiffness_of([](double depth_m) { return 500.0 * depth_m; }, rows);
    CHECK(run.wanted_N_per_m == close_to(500.0));
    CHECK(run.rendered_N_per_m == close_to(400.0));
    CHECK(run.error_share == close_to(-0.2));
    CHECK(run.hysteresis_N == close_to(0.25));
    CHECK(run.force_at_0_N == close_to(0.3));
    CHECK(run.force_rms_N == close_to(std::sqrt(0.09 - 0.3 + 1.0 / 3.0 + 0.0625)).epsilon(1e-3));
    CHECK_THROWS_WITH_AS(stiffness_of([](double) { return 0.0; }, {}), doctest::Contains("did the hand press"),
                         std::runtime_error);
}

TEST_CASE("characterise: the curve of a law that is rendered exactly is no error of the arm") {
    const auto law_N = [](double depth_m) { return 2e4 * depth_m * depth_m; };
    std::vector<StrokeRow> rows;
    for (int i = 0; i < 4000; ++i) {
        const double depth_m = i < 2000 ? 5e-6 * i : 5e-6 * (4000 - i);
        rows.push_back({1e-3 * i, depth_m, i < 2000 ? 5e-3 : -5e-3, law_N(depth_m), 0.0});
    }
    const StiffnessRun run = stiffness_of(law_N, rows);
    CHECK(run.wanted_N_per_m == close_to(200.0).epsilon(0.01));  // the slope in the middle of 0.5 to 9.5 mm
    CHECK(run.error_share == close_to(0.0));
}

TEST_CASE("strokes: an arm that is compensated and held still stays quiet, with soft and stiff hands") {
    for (const double hand_N_per_m : {300.0, 1000.0, 3000.0}) {
        for (const double stiffness : {500.0, 2000.0, 4000.0}) {  // 2 ms of delay: up to 8 N s/m
            CAPTURE(hand_N_per_m);
            CAPTURE(stiffness);
            ArmPlantParameters arm = arm_parameters(0);
            arm.hand_N_s_per_m *= std::sqrt(hand_N_per_m / arm.hand_N_per_m);
            arm.hand_N_per_m = hand_N_per_m;
            devices::PressRow above, held;
            above.depth_m = -1e-3;
            held.t_s = 1.0;
            held.depth_m = hand_depth_m(3.0 / stiffness, stiffness, hand_N_per_m);  // 3 N
            StrokeOptions options;
            options.seconds = 3.0;
            options.limits = wide_limits();
            options.law = [stiffness](double depth_m) { return stiffness * depth_m; };
            options.compensation = known_to(arm);
            const auto rig = virtual_rig(make_arm_plant(arm, {above, held}, 1));
            const Strokes strokes = run_strokes(options, *rig);
            double fastest = 0.0;
            for (const StrokeRow& row : strokes.rows)
                if (row.time_s > 2.0) fastest = std::max(fastest, std::abs(row.velocity_m_per_s));
            CHECK(fastest < 0.5e-3);
        }
    }
}

TEST_CASE("strokes: the force limit holds, whatever the law asks for, and NaN of the law stops the arm") {
    const ArmPlantParameters arm = arm_parameters(1);
    const auto path = cycles(10e-3, 1, 4.0);
    StrokeOptions options;
    options.seconds = path.back().t_s;
    options.limits.force_N = 2.5;
    options.law = [](double) { return 1e6; };
    const auto rig = virtual_rig(make_arm_plant(arm, path, 1));
    const Strokes strokes = run_strokes(options, *rig);
    for (const StrokeRow& row : strokes.rows) REQUIRE(row.motor_N <= 2.5);
    CHECK(strokes.guard.limited > 0);
    options.law = [](double depth_m) { return depth_m > 5e-3 ? std::nan("") : 0.0; };
    const auto stops = virtual_rig(make_arm_plant(arm, path, 1));
    CHECK_THROWS_WITH_AS(run_strokes(options, *stops), doctest::Contains("not a number"), std::runtime_error);
}

TEST_CASE("strokes: a force sensor that falls silent ends them, and one that never speaks begins none") {
    // A simulated arm whose sensor goes at a time.
    class Rig : public ArmRig {
      public:
        Rig(std::unique_ptr<ArmRig> rig, double from_s, double to_s)
            : rig_(std::move(rig)), from_s_(from_s), to_s_(to_s) {}
        double next_tick() override { return now_s_ = rig_->next_tick(); }
        bool read(devices::ArmFeedback& out) noexcept override {
            const bool came = rig_->read(out);
            if (now_s_ > from_s_ && now_s_ < to_s_) out.sensor_N = out.has_sensor = 0.0;
            return came;
        }
        void send(const devices::ArmCommand& command) noexcept override { rig_->send(command); }

      private:
        std::unique_ptr<ArmRig> rig_;
        double from_s_, to_s_, now_s_ = 0.0;
    };
    const ArmPlantParameters arm = arm_parameters(1);
    const auto path = slow_strokes(-5e-3, 45e-3);
    StrokeOptions options;
    options.arm = "the arm";
    options.seconds = path.back().t_s;
    options.limits = wide_limits();
    const auto strokes = [&](double from_s, double to_s) {
        Rig rig(virtual_rig(make_arm_plant(arm, path, 1)), from_s, to_s);
        return run_strokes(options, rig);
    };
    CHECK_THROWS_WITH_AS(strokes(12.0, 1e9), "the arm: its force sensor fell silent in the middle of the strokes",
                         std::runtime_error);
    CHECK_THROWS_WITH_AS(strokes(-1.0, 1e9), "the arm: its force sensor says nothing within 2 s", std::runtime_error);
    // while it is silent for a moment nothing is taken for 0 N
    const ArmCompensation found = fit_compensation(strokes(12.0, 12.3).rows).compensation;
    CHECK(found.coulomb_N == close_to(arm.coulomb_N).epsilon(0.1));
    CHECK(found.weight_N == close_to(9.80665 * arm.weight_kg).epsilon(0.05));
}

TEST_CASE("strokes: the same seed gives the same rows, to the last bit") {
    const ArmPlantParameters arm = arm_parameters(4);
    const Strokes a = cycles_at(500.0, arm, std::nullopt, 4), b = cycles_at(500.0, arm, std::nullopt, 4);
    REQUIRE(a.rows.size() == b.rows.size());
    int different = 0;
    for (std::size_t i = 0; i < a.rows.size(); ++i)
        different += a.rows[i].depth_m != b.rows[i].depth_m || a.rows[i].sensor_N != b.rows[i].sensor_N;
    CHECK(different == 0);
}
