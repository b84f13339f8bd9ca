#include <doctest/doctest.h>

#include "tactile/loop.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/tactile/tactile_scene.h"

using namespace palpa;
using namespace palpa::test;

namespace {

// What the plan says against an arm's device file with these changes.
std::string refused_arm(const std::string& impedance, const std::string& from, const std::string& to) {
    TactileScene slab(R"({"arm": {"impedance": ")" + impedance + R"(", "device": "arm.json"}})");
    std::string arm = files::read_text(kAssets / "devices" / "arm.json");
    const auto at = arm.find(from);
    REQUIRE(at != std::string::npos);
    files::write_text_atomically(slab.folder / "arm.json", arm.replace(at, from.size(), to));
    slab.scene = scene::read_scene(slab.folder / "scene.json", kAssets);
    return message_of([&] { slab.tactile_plan(); });
}

bool has_stage(const tactile::TactilePlan& plan, const std::string& name) {
    for (const scene::StageText& stage : plan.stages)
        if (stage.name == name) return true;
    return false;
}

}  // namespace

TEST_CASE("tactile plan: a high-impedance arm without a force sensor is refused, as the force is its input") {
    const std::string sensor =
        R"("sensor": {"host": "192.168.1.1", "port": 49152, "counts_per_N": 1000000, "axis": "z", "sign": -1})";
    std::string arm = files::read_text(kAssets / "devices" / "arm.json");
    REQUIRE(contains(arm, sensor));
    REQUIRE(contains(arm, R"("impedance": "low")"));
    TactileScene slab(R"({"arm": {"impedance": "high", "device": "arm.json"}})");
    arm.replace(arm.find(R"("low")"), 5, R"("high")");
    files::write_text_atomically(slab.folder / "arm.json", arm);
    slab.scene = scene::read_scene(slab.folder / "scene.json", kAssets);
    CHECK(message_of([&] { slab.tactile_plan(); }) == "");
    CHECK(slab.tactile_plan()->input == tactile::InputKind::force);
    arm.erase(arm.find(sensor), sensor.size());
    arm.erase(arm.rfind(','), 1);
    files::write_text_atomically(slab.folder / "arm.json", arm);
    const std::string said = message_of([&] { slab.tactile_plan(); });
    CHECK(contains(said, "tactile.arm.device: found a high-impedance arm without a force sensor"));
    CHECK(contains(said, "expected a force sensor between the arm and the display"));
}

TEST_CASE("tactile plan: an arm whose device has another impedance is refused") {
    CHECK(contains(refused_arm("high", R"("name": "force arm")", R"("name": "my arm")"),
                   "tactile.arm.impedance: found high, expected that of the device my arm, low"));
}

TEST_CASE("tactile plan: what is absent is not in the plan") {
    const TactileScene arm(R"({"arm": {}})");
    const auto plan = arm.tactile_plan();
    CHECK_FALSE(plan->pins);
    CHECK_FALSE(plan->arm);
    CHECK_FALSE(plan->table);
    CHECK(plan->renderer.observed.points_m.cols() == 0);
    CHECK(has_stage(*plan, "finger"));
    CHECK_FALSE(has_stage(*plan, "pin shape"));
    CHECK_FALSE(has_stage(*plan, "guard"));
    CHECK(tactile::pairing_text(plan->options) == "low-impedance arm: depth in, force out");
}

TEST_CASE("tactile plan: the stages say at which force the stroke is used up") {
    const TactileScene slab;
    const auto plan = slab.tactile_plan();
    CHECK(plan->pins->grid.rows == 6);
    CHECK(plan->stroke_used_up_N > 0.0);
    CHECK(plan->stroke_used_up_N < 2.5);
    bool said = false;
    for (const scene::StageText& stage : plan->stages)
        said = said || contains(stage.fidelity,
                                "the stroke is used up at " + files::short_number(plan->stroke_used_up_N) + " N");
    CHECK(said);
    const TactileScene locked(R"({"display": {"schedule": "locked"}})");
    CHECK_FALSE(std::isfinite(locked.tactile_plan()->stroke_used_up_N));  // no shape is shown
    // ten times as stiff: at a tenth of the depth per newton the stroke lasts ten times as long
    CHECK(plan->greatest_stiffness_N_per_m == close_to(plan->stiffness_N_per_m).epsilon(1e-6));  // linear
    const TactileScene stiff(kArmAndPins, 10.0);
    CHECK(stiff.tactile_plan()->stroke_used_up_N == close_to(10.0 * plan->stroke_used_up_N).epsilon(1e-6));
}

TEST_CASE("tactile plan: under a soft pad, too, the stroke is used up where pins begin to be cut off") {
    for (const char* zero : {"top", "skel"}) {
        CAPTURE(zero);
        const TactileScene slab(
            std::string(R"({"finger": {"contact": "pad", "diameter_mm": 16}, "display": {"zero": ")") + zero +
            R"("}})");
        const auto plan = slab.tactile_plan();
        REQUIRE(plan->stroke_used_up_N < plan->options.force_limit_N);
        tactile::RendererWork work = tactile::make_work(plan->renderer);
        Eigen::VectorXd height_m(plan->pins->pin_m.cols());
        const auto cut_off = [&](double force_N) {
            const tactile::Press press =
                tactile::press_with_force(plan->renderer, slab.plan->area.centre_m, force_N, work);
            Eigen::VectorXd sink_m(height_m.size());
            tactile::shape_m(plan->renderer, work, sink_m);
            mechanics::PinReport report;
            mechanics::pins_from_sinks_m(*plan->pins, press.depth_m, sink_m, height_m, report);
            return report.clipped;
        };
        CHECK(cut_off(0.97 * plan->stroke_used_up_N) == 0);
        CHECK(cut_off(1.03 * plan->stroke_used_up_N) > 0);
    }
}

TEST_CASE("tactile plan: a scene without the key is refused") {
    scene::Scene scene = scene::read_scene(kAssets / "scenes" / "linear.json", kAssets);
    CHECK(contains(message_of([&] { tactile::make_tactile_plan(scene, {}); }), "tactile: found no such key"));
}

TEST_CASE("tactile plan: a force curve answers depth with force, with the display off") {
    scene::TactileOptions options;
    options.arm = scene::ArmOptions{};
    const tactile::DepthForce curve{{1e-3, 2e-3}, {0.5, 2.0}};
    const auto plan = tactile::make_tactile_plan(options, curve, 1.0, "a force curve", "curve.json");
    tactile::LoopState state = tactile::make_loop_state(plan);
    tactile::LoopInput in;
    in.touch = {0.0, 0.0, 0.0, 1.5e-3, 0.0, true};
    CHECK(tactile::loop_command(plan, in, state).force_N == close_to(1.25));
    CHECK(plan.greatest_stiffness_N_per_m == close_to(1500.0));  // of the second millimetre
    in.touch.depth_m = 5e-3;                                     // beyond the curve
    CHECK(tactile::loop_command(plan, in, state).held);
    CHECK(contains(plan.stages.front().fidelity, "a force curve"));
    options.display = scene::DisplayOptions{};
    CHECK(contains(message_of([&] { tactile::make_tactile_plan(options, curve, 1.0, "a force curve", "curve.json"); }),
                   "curve.json: tactile.display: found a display, expected none: a force curve knows no surface"));
}
