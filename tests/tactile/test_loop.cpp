#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "tactile/loop.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"
#include "tests/tactile/tactile_scene.h"

using namespace palpa;
using namespace palpa::tactile;
using namespace palpa::test;

namespace {

LoopInput touched(double time_s, double depth_m, double x_m = 0.02) {
    LoopInput in;
    in.time_s = time_s;
    in.touch = {time_s, x_m, 0.02, depth_m, 0.0, depth_m > 0.0};
    return in;
}

// The commands of a press that goes down at a speed.
std::vector<LoopCommand> pressed(const TactilePlan& plan, double m_per_s, int steps) {
    LoopState state = make_loop_state(plan);
    std::vector<LoopCommand> out;
    for (int k = 0; k < steps; ++k) out.push_back(loop_command(plan, touched(1e-3 * k, m_per_s * 1e-3 * k), state));
    return out;
}

const char* const kSchedules[] = {"free", "lead", "locked"};

std::string with_schedule(const std::string& schedule) {
    return R"({"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json", "schedule": ")" + schedule +
           R"("}})";
}

}  // namespace

TEST_CASE("tactile loop: above the surface the force is zero and the pins rest") {
    const TactileScene slab;
    const auto plan = slab.tactile_plan();
    LoopState state = make_loop_state(*plan);
    const LoopCommand out = loop_command(*plan, touched(0.0, -1e-3), state);
    CHECK(out.force_N == 0.0);
    CHECK(out.arm.force_N == 0.0);
    CHECK_FALSE(out.pressed);
    CHECK(out.pins == 36);
    for (std::size_t i = 0; i < 36; ++i) CHECK(out.pins_m[i] == close_to(mechanics::rest_height_m(*plan->pins)));
}

TEST_CASE("tactile loop: depth in, force out, and the bowl of the surface on the pins") {
    const TactileScene slab(with_schedule("free"));
    const auto plan = slab.tactile_plan();
    const std::vector<LoopCommand> steps = pressed(*plan, 0.002, 1000);
    const LoopCommand& last = steps.back();
    CHECK(last.force_N == close_to(plan->stiffness_N_per_m * last.depth_m).epsilon(0.01));
    CHECK(last.arm.force_N == last.force_N);
    CHECK(last.arm.mode == static_cast<double>(devices::ArmMode::force));
    const double middle_m = last.wanted_m[14];  // row 2, column 2
    const double corner_m = last.wanted_m[0];
    CHECK(corner_m - middle_m > 0.3 * last.depth_m);
    for (std::size_t i = 0; i < 36; ++i) {
        CHECK(std::abs(last.pins_m[i] - last.wanted_m[i]) <= 0.5e-4 + 1e-9);  // in steps of 0.1 mm
        CHECK(std::abs(std::remainder(last.pins_m[i], 1e-4)) < 1e-9);
    }
}

TEST_CASE("tactile loop: above the force limit force and shape hold, and say so") {
    const TactileScene slab(with_schedule("free"));
    const auto plan = slab.tactile_plan();
    const std::vector<LoopCommand> steps = pressed(*plan, 0.01, 900);  // 9 mm: beyond
    const auto first = std::find_if(steps.begin(), steps.end(), [](const LoopCommand& step) { return step.held; });
    REQUIRE(first != steps.end());
    for (auto step = first; step != steps.end(); ++step) {
        CHECK(step->held);
        CHECK(step->force_N <= 2.5);
        CHECK(step->force_N == close_to(2.5).epsilon(1e-6));
        CHECK(step->wanted_m == first->wanted_m);
    }
    for (auto step = steps.begin(); step != first; ++step) CHECK(step->force_N <= 2.5);
}

TEST_CASE("tactile loop: lead commands what free commands 20 ms later, from what was read alone") {
    const TactileScene slab(with_schedule("lead"));
    const auto plan = slab.tactile_plan();
    const auto later = std::make_shared<TactilePlan>(*plan);
    later->options.display->schedule = scene::PinSchedule::free;
    const std::vector<LoopCommand> lead = pressed(*plan, 0.004, 600);
    const std::vector<LoopCommand> free = pressed(*later, 0.004, 600);
    for (std::size_t k = 50; k + 20 < lead.size(); ++k) {
        CAPTURE(k);
        CHECK(lead[k].force_N == free[k].force_N);  // the force is that of now
        CHECK(lead[k].wanted_m == free[k].wanted_m);
        double off_m = 0.0;
        for (std::size_t i = 0; i < 36; ++i)
            off_m = std::max(off_m, std::abs(lead[k].pins_m[i] - free[k + 20].pins_m[i]));
        CHECK(off_m <= 1.01e-4);  // a step of rounding
    }
    // a press that turns at once is not foreseen
    LoopState state = make_loop_state(*plan);
    for (int k = 0; k < 100; ++k) loop_command(*plan, touched(1e-3 * k, 0.0), state);
    const LoopCommand turned = loop_command(*plan, touched(0.1, 0.0), state);
    CHECK(turned.pins_m[0] == close_to(mechanics::rest_height_m(*plan->pins)));
}

TEST_CASE("tactile loop: locked pins stand at the top") {
    const TactileScene slab(with_schedule("locked"));
    const std::vector<LoopCommand> steps = pressed(*slab.tactile_plan(), 0.01, 300);
    for (const LoopCommand& step : steps) {
        for (std::size_t i = 0; i < 36; ++i) CHECK(step.pins_m[i] == close_to(2e-3));
    }
    CHECK(steps.back().force_N > 0.5);
}

TEST_CASE("tactile loop: a step allocates nothing, in any schedule") {
    for (const char* schedule : kSchedules) {
        CAPTURE(schedule);
        const TactileScene slab(with_schedule(schedule));
        const auto plan = slab.tactile_plan();
        LoopState state = make_loop_state(*plan);
        double force_N = 0.0;
        for (int k = 0; k < 5; ++k) force_N += loop_command(*plan, touched(1e-3 * k, 1e-3), state).force_N;
        const long before = allocation_count();
        for (int k = 5; k < 2000; ++k) {
            const double time_s = 1e-3 * k;
            force_N +=
                loop_command(*plan, touched(time_s, 4e-3 * (1.0 - std::cos(10.0 * time_s)), 0.02 + 1e-6 * k), state)
                    .force_N;
        }
        CHECK(allocation_count() == before);
        CHECK(force_N > 0.0);
    }
}

TEST_CASE("tactile loop: user faster than everything: all that is commanded stays within limits") {
    const TactileScene slab;
    const auto plan = slab.tactile_plan();
    LoopState state = make_loop_state(*plan);
    for (int k = 0; k < 2000; ++k) {  // 2 m/s up and down, and jumps across the tissue and beyond
        const double depth_m = k % 7 == 0 ? 0.5 : 0.01 * (k % 3) - 0.005;
        const LoopCommand out = loop_command(*plan, touched(1e-3 * k, depth_m, 0.3 * std::sin(0.7 * k)), state);
        CHECK(out.force_N >= 0.0);
        CHECK(out.force_N <= 2.5);
        for (std::size_t i = 0; i < 36; ++i) {
            CHECK(out.pins_m[i] >= 0.0);
            CHECK(out.pins_m[i] <= 2e-3);
            CHECK(out.reached_m[i] >= -1e-12);
            CHECK(out.reached_m[i] <= 2e-3 + 1e-12);
        }
    }
}

TEST_CASE("tactile loop: NaN anywhere in the input gives finite commands") {
    const TactileScene slab;
    const auto plan = slab.tactile_plan();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double wrong :
         {nan, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
        LoopState state = make_loop_state(*plan);
        loop_command(*plan, touched(0.0, 1e-3), state);
        LoopInput depth = touched(1e-3, wrong), place = touched(2e-3, 1e-3, wrong);
        depth.touch.down = true;
        for (const LoopInput& in : {depth, place, touched(3e-3, 1e-3)}) {
            LoopCommand out = loop_command(*plan, in, state);
            CHECK(std::isfinite(out.force_N));
            for (std::size_t i = 0; i < 36; ++i) CHECK(std::isfinite(out.pins_m[i]));
        }
    }
}

TEST_CASE("tactile loop: stopped, the force is zero and the pins rest whatever the hand does") {
    const TactileScene slab;
    const auto plan = slab.tactile_plan();
    LoopState state = make_loop_state(*plan);
    for (int k = 0; k < 100; ++k) {
        LoopInput in = touched(1e-3 * k, 5e-3);
        in.feedback.stopped = 1.0;
        const LoopCommand out = loop_command(*plan, in, state);
        CHECK(out.force_N == 0.0);
        CHECK(out.arm.mode == static_cast<double>(devices::ArmMode::rest));
        CHECK(out.pins_m[0] == close_to(mechanics::rest_height_m(*plan->pins)));
    }
}
