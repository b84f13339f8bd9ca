#include <cmath>
#include <doctest/doctest.h>

#include "scene/advance.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/scene/allocations.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::calibration;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

struct Run {
    Scene scene;
    Plan plan;
    State state;
    explicit Run(const char* name) {
        scene = read_scene(kAssets / "scenes" / name, kAssets);
        plan = make_plan(scene);
        state = start(scene, plan, {1280, 800});
    }
    void feed(const Sample& sample) { advance(scene, plan, sample, state); }
    std::int64_t calls(StageId id) const { return state.meters[static_cast<std::size_t>(id)].calls(); }
};

Sample pen(double t_s, Phase phase, const Eigen::Vector2d& px, double pressure = 0.76) {
    Sample sample;
    sample.t_host_s = t_s;
    sample.pointer_id = 3;
    sample.tool = Tool::pen;
    sample.phase = phase;
    sample.x_px = px.x();
    sample.y_px = px.y();
    sample.pressure = pressure;
    sample.pressure_raw = 1023 * pressure;
    return sample;
}

// Along y = 35 mm, over nodule A, 30 mm/s; every sample goes to `after`.
template <class After>
void stroke(Run& run, double rate_Hz, After&& after) {
    const auto px_at = [&](double x_m) { return px_of_tissue(run.state.view, {x_m, 0.035}); };
    run.feed(pen(0.0, Phase::hover, px_at(0.01)));
    run.feed(pen(0.0, Phase::down, px_at(0.01)));
    for (int i = 1; i <= static_cast<int>(2.0 * rate_Hz); ++i) {
        run.feed(pen(i / rate_Hz, Phase::move, px_at(0.01 + 0.03 * i / rate_Hz)));
        after(run.state);
    }
    run.feed(pen(2.1, Phase::up, px_at(0.07), 0.0));
}

}  // namespace

TEST_CASE("advance: what a scene does not ask for is never called and changes nothing") {
    Run off("off.json");
    stroke(off, 240, [](const State& state) { CHECK(state.avatar.lag_m.norm() == 0.0); });
    CHECK(off.calls(StageId::depth) == 483);
    CHECK(off.calls(StageId::display_ratio) == 0);
    CHECK(off.calls(StageId::delay) == 0);
    CHECK(off.calls(StageId::surface) == 0);
    CHECK_FALSE(off.state.display_ratio);
    CHECK_FALSE(off.state.delay);
    CHECK(off.state.extremes.lag_m == 0.0);

    Run on("default.json");
    stroke(on, 240, [](const State&) {});
    CHECK(on.calls(StageId::display_ratio) == 483);
    CHECK(on.calls(StageId::delay) == 0);
    CHECK_FALSE(on.state.delay);
    CHECK(on.state.extremes.lag_m > 0.5e-3);
    CHECK(on.state.extremes.depth_m == off.state.extremes.depth_m);  // the effect does not reach back
}

TEST_CASE("advance: a sample allocates nothing, an absent effect allocates nothing at the start either") {
    for (const char* name : {"off.json", "default.json", "delay.json"}) {
        CAPTURE(name);
        Run run(name);
        SurfaceShape surface;
        run.state.time_every = 1;
        const std::int64_t before = allocations();
        stroke(run, 1000, [](const State&) {});
        if (run.scene.surface) surface_now(run.scene, run.plan, run.state, surface);
        avatar_at(run.scene, run.state, 3.0);
        CHECK(allocations() == before);
    }
    Run run("off.json");
    std::int64_t before = allocations();
    start(run.scene, run.plan, {1280, 800});
    CHECK(allocations() == before);
    before = allocations();
    CHECK(std::vector<int>(3).size() == 3);
    CHECK(allocations() > before);  // the counter counts
}

TEST_CASE("advance: a contact says when and where it was") {
    Run run("default.json");
    const Eigen::Vector2d px(600, 380);
    run.feed(pen(2.0, Phase::down, {640, 400}, 0.3));
    run.feed(pen(2.5, Phase::move, px, 0.3));
    REQUIRE(run.state.contact.depth_m > 0.0);
    CHECK(run.state.contact.time_s == run.state.timeline.now_s);
    CHECK(run.state.contact.p_m == tissue_of_px(run.state.view, px));
    const double pressed_s = run.state.contact.time_s;
    run.feed(pen(3.0, Phase::up, px, 0.0));
    CHECK(run.state.contact.time_s == close_to(pressed_s + 0.5));
    CHECK(run.state.contact.p_m == run.state.touch.p_m);
}

TEST_CASE("hard case 4: force only while touching") {
    Run run("default.json");
    const Eigen::Vector2d middle(640, 400);
    run.feed(pen(0.0, Phase::hover, middle, 0.0));
    CHECK(run.state.contact.normal_N == 0.0);
    CHECK(run.state.contact.depth_m == 0.0);
    run.feed(pen(0.01, Phase::down, middle, 0.0));
    CHECK(run.state.contact.normal_N == close_to(0.1008));
    run.feed(pen(0.02, Phase::move, middle, 1.5));
    CHECK(run.state.contact.normal_N == close_to(6.77632).epsilon(1e-4));
    CHECK(run.state.contact.saturated);
    CHECK(run.state.counters.levels_clamped == 1);
    run.feed(pen(0.03, Phase::up, middle, 0.7));
    CHECK(run.state.contact.normal_N == 0.0);
    run.feed(pen(0.04, Phase::down, middle, kMissing));
    CHECK(run.state.contact.normal_N == 0.0);
    CHECK(run.state.counters.without_level == 1);
}

TEST_CASE("hard case 8: the same stroke at 30 to 1,000 Hz gives the same lag within 1e-6 mm") {
    double lag_m[3] = {};
    int n = 0;
    for (const double rate_Hz : {30.0, 240.0, 1000.0}) {
        Run run("default.json");
        stroke(run, rate_Hz, [&](const State& state) {
            if (std::abs(state.timeline.now_s - 0.6) < 1e-9) lag_m[n] = state.avatar.lag_m.norm();
        });
        ++n;
    }
    CHECK(lag_m[0] > 0.3e-3);
    CHECK(std::abs(lag_m[1] - lag_m[0]) < 1e-9);
    CHECK(std::abs(lag_m[2] - lag_m[0]) < 1e-9);
}

TEST_CASE("hard case 10: a delay under 1,000 Hz input stays within its cap and no sample waits") {
    Run run("delay.json");
    double worst_s = 0.0;
    stroke(run, 1000, [&](const State& state) { worst_s = std::max(worst_s, state.avatar.delay_s); });
    CHECK(worst_s > 5e-3);
    CHECK(worst_s <= 0.15);
    CHECK(run.state.counters.samples == 2003);
    CHECK(run.state.counters.dropped_steps == 0);
}

TEST_CASE("hard case 11: samples out of order press nothing, a late lift still lifts") {
    Run run("default.json");
    const Eigen::Vector2d middle(640, 400);
    run.feed(pen(1.0, Phase::down, middle));
    run.feed(pen(1.1, Phase::move, middle));
    const double force_N = run.state.contact.normal_N;
    run.feed(pen(0.5, Phase::move, {700, 400}, 0.1));
    CHECK(run.state.contact.normal_N == force_N);
    CHECK(run.state.timeline.backwards == 1);
    run.feed(pen(0.6, Phase::up, middle, 0.0));
    CHECK_FALSE(run.state.touch.down);
    CHECK(run.state.timeline.now_s == 1.1);
}

TEST_CASE("hard case 11: a gap is walked on the grid; what is cut of a long one is counted") {
    Run run("default.json");
    const Eigen::Vector2d middle(640, 400);
    run.feed(pen(0.0, Phase::down, middle));
    run.feed(pen(10.0, Phase::move, middle));
    CHECK(run.state.counters.steps == 2400);
    CHECK(run.state.counters.dropped_steps == 0);
    run.feed(pen(1e9, Phase::move, middle));
    CHECK(run.state.counters.steps == 2400 + 60 * 240);
    CHECK(run.state.counters.dropped_steps > 1e11);
    run.feed(pen(1e9 + 1, Phase::up, middle));
    CHECK(run.state.counters.steps == 2400 + 61 * 240);
    const std::int64_t dropped = run.state.counters.dropped_steps;
    run.feed(pen(1e9 + 1000, Phase::hover, middle));  // nothing touches
    CHECK(run.state.counters.steps == 2400 + 121 * 240);
    CHECK(run.state.counters.dropped_steps == dropped);
}

TEST_CASE("advance: the grid begins with the first sample and goes on at one pace, touched or not, at any rate") {
    for (const char* name : {"off.json", "default.json", "delay.json"}) {
        for (const double rate_Hz : {30.0, 1000.0}) {
            CAPTURE(name);
            CAPTURE(rate_Hz);
            Run run(name);
            const Eigen::Vector2d middle(640, 400);
            const int second = static_cast<int>(rate_Hz);
            for (int i = 0; i <= 4 * second; ++i) {
                const bool presses = i > second && i <= 2 * second;
                const Phase phase = presses ? (i == second + 1 ? Phase::down : Phase::move)
                                            : (i == 2 * second + 1 ? Phase::up : Phase::hover);
                run.feed(pen(7.0 + i / rate_Hz, phase, middle));
                if (i % second == 0) CHECK(run.state.counters.steps == 240 * (i / second));
            }
            CHECK(run.state.counters.dropped_steps == 0);
        }
    }
}

TEST_CASE("advance: not-a-number, a second finger, a pen beside the tissue") {
    Run run("default.json");
    const Eigen::Vector2d middle(640, 400);
    run.feed(pen(0.0, Phase::down, middle));
    const double force_N = run.state.contact.normal_N;
    run.feed(pen(0.01, Phase::move, {std::nan(""), 400}));
    CHECK(run.state.contact.normal_N == force_N);
    CHECK(run.state.counters.not_numbers == 1);

    Sample finger = pen(0.02, Phase::down, {700, 300}, 1.0);
    finger.pointer_id = 9;
    run.feed(finger);
    CHECK_FALSE(run.state.answered);
    CHECK(run.state.contact.normal_N == force_N);
    finger.phase = Phase::up;
    finger.t_host_s = 0.03;
    run.feed(finger);
    CHECK(run.state.touch.down);

    run.feed(pen(0.04, Phase::move, {5, 5}));
    CHECK_FALSE(run.state.touch.down);
    CHECK(run.state.contact.normal_N == 0.0);
    CHECK(run.state.counters.off_tissue == 1);
    run.feed(pen(0.05, Phase::move, middle));
    CHECK(run.state.touch.down);
}

TEST_CASE("advance: the avatar between samples is where the next sample of a resting pen finds it") {
    for (const char* name : {"default.json", "delay.json"}) {
        CAPTURE(name);
        Run run(name);
        const auto px_at = [&](double x_m) { return px_of_tissue(run.state.view, {x_m, 0.035}); };
        run.feed(pen(0.0, Phase::down, px_at(0.01)));
        for (int i = 1; i <= 143; ++i) run.feed(pen(i / 240.0, Phase::move, px_at(0.01 + 0.03 * i / 240.0)));
        CHECK(run.state.avatar.lag_m.norm() > 0.1e-3);
        for (const double later_s : {0.01, 0.1, 0.2, 0.3}) {
            const double t_s = 143 / 240.0 + later_s;
            const Avatar expected = avatar_at(run.scene, run.state, t_s);
            State copy = run.state;
            advance(run.scene, run.plan, pen(t_s, Phase::move, px_at(0.01 + 0.03 * 143 / 240.0)), copy);
            CHECK((expected.lag_m - copy.avatar.lag_m).norm() < 1e-12);
            CHECK(expected.delay_s == close_to(copy.avatar.delay_s));
        }
    }
}

TEST_CASE("advance: a resize is a row of its own and moves the mapping") {
    Run run("default.json");
    Sample resize;
    resize.phase = Phase::ui;
    resize.action = Action::resize;
    resize.x_px = 100;
    resize.y_px = 20;
    resize.width_px = 800;
    resize.height_px = 1280;
    run.feed(resize);
    CHECK(run.state.screen.width_px == 800);
    CHECK((px_of_tissue(run.state.view, run.plan.area.centre_m) - Eigen::Vector2d(500, 660)).norm() < 1e-9);
    resize.width_px = -1;
    run.feed(resize);
    resize.width_px = kMissing;
    run.feed(resize);
    CHECK(run.state.screen.width_px == 800);
}

TEST_CASE("advance: a pen that reports full pressure in its first sample presses from the second on") {
    Run run("default.json");
    const Eigen::Vector2d middle(640, 400);
    run.feed(pen(0.00, Phase::down, middle, 1.0));
    CHECK(run.state.touch.down);
    CHECK(run.state.contact.normal_N == 0.0);
    CHECK(run.state.contact.depth_m == 0.0);
    CHECK(run.state.counters.distrusted == 1);
    CHECK(run.state.counters.levels_clamped == 0);
    run.feed(pen(0.01, Phase::move, middle, 0.1));
    CHECK(run.state.contact.normal_N == close_to(0.1008 * std::exp(0.42081)).epsilon(1e-6));
    run.feed(pen(0.02, Phase::move, middle, 0.95));  // a move may be as hard as it likes
    CHECK(run.state.contact.normal_N > 5.0);
    CHECK(run.state.extremes.force_at_s > 0.015);
    run.feed(pen(0.03, Phase::up, middle, 0.0));

    run.feed(pen(0.04, Phase::down, middle, 0.9));
    CHECK(run.state.contact.normal_N > 0.0);
    run.feed(pen(0.05, Phase::up, middle, 0.0));
    for (const Tool tool : {Tool::mouse, Tool::keyboard}) {  // a wheel may be set to full before the press
        Sample set = pen(0.06, Phase::down, middle, 1.0);
        set.tool = tool;
        run.feed(set);
        CHECK(run.state.contact.normal_N > 5.0);
        set.phase = Phase::up;
        run.feed(set);
    }
    CHECK(run.state.counters.distrusted == 1);
}

TEST_CASE("advance: a keyboard presses with its share of any profile's range, as a mouse does") {
    Run run("touchpad.json");
    REQUIRE(run.plan.profile.level == LevelField::pressure_raw);
    double force[2] = {};
    int i = 0;
    for (const Tool tool : {Tool::mouse, Tool::keyboard}) {
        Sample sample = pen(0.1 * i, Phase::down, px_of_tissue(run.state.view, {0.06, 0.06}), 0.5);
        sample.tool = tool;
        sample.pointer_id = i;
        sample.pressure_raw = kMissing;
        run.feed(sample);
        force[i++] = run.state.contact.normal_N;
        sample.phase = Phase::up;
        run.feed(sample);
    }
    CHECK(force[0] > 0.0);
    CHECK(force[1] == force[0]);
}

namespace {

Sample finger(double t_s, Phase phase, const Eigen::Vector2d& px, std::int64_t id) {
    Sample sample = pen(t_s, phase, px, 0.76);
    sample.tool = Tool::finger;
    sample.pointer_id = id;
    return sample;
}

}  // namespace

TEST_CASE("advance: a pen takes over from a finger, which is the hand until it lifts") {
    Run run("default.json");
    const Eigen::Vector2d hand(700, 500), tip(640, 400);
    run.feed(finger(0.00, Phase::down, hand, 8));
    for (int i = 1; i < 20; ++i) run.feed(finger(0.01 * i, Phase::move, hand + Eigen::Vector2d(i, 0), 8));
    CHECK(run.state.contact.normal_N > 0.0);
    run.feed(pen(0.20, Phase::hover, tip));  // near is not down
    CHECK(*run.state.pointer == 8);
    run.feed(pen(0.21, Phase::down, tip, 0.76));
    CHECK(run.state.answered);
    CHECK(*run.state.pointer == 3);
    CHECK(run.state.avatar.lag_m.norm() == 0.0);  // a touch of its own, no jump
    CHECK(run.state.counters.palms == 1);

    const double pen_N = run.state.contact.normal_N;
    run.feed(finger(0.22, Phase::move, hand, 8));
    run.feed(finger(0.23, Phase::down, hand, 9));  // more of the hand
    CHECK_FALSE(run.state.answered);
    CHECK(run.state.contact.normal_N == pen_N);
    run.feed(pen(0.24, Phase::up, tip, 0.0));
    for (const std::int64_t id : {8, 9}) {
        run.feed(finger(0.25, Phase::move, hand, id));
        CHECK_FALSE(run.state.answered);
        CHECK_FALSE(run.state.touch.down);
    }
    run.feed(finger(0.26, Phase::up, hand, 8));
    run.feed(finger(0.27, Phase::down, hand, 8));  // this one means it
    CHECK(run.state.answered);
    CHECK(run.state.touch.down);
    run.feed(finger(0.28, Phase::up, hand, 8));
    run.feed(finger(0.29, Phase::cancel, hand, 9));
    run.feed(finger(0.30, Phase::down, hand, 9));
    CHECK(run.state.touch.down);
}

TEST_CASE("advance: a finger that the pen pushed out stays out though it was still meanwhile; down anew it counts") {
    Run run("default.json");
    const Eigen::Vector2d hand(700, 500), tip(640, 400);
    run.feed(finger(0.00, Phase::down, hand, 8));
    run.feed(pen(0.10, Phase::down, tip));
    run.feed(pen(0.20, Phase::up, tip));
    run.feed(finger(0.30, Phase::move, hand, 8));
    CHECK_FALSE(run.state.touch.down);
    run.feed(finger(0.40, Phase::down, hand, 8));  // its lift was lost
    CHECK(run.state.touch.down);
    CHECK(run.state.answered);
}

TEST_CASE("advance: taking over ends the finger's touch as a lift would") {
    for (const char* name : {"display-ratio.json", "delay.json"}) {
        CAPTURE(name);
        Run lifted(name), taken(name);
        for (Run* run : {&lifted, &taken}) {
            const auto px_at = [&](double x_m) { return px_of_tissue(run->state.view, {x_m, 0.035}); };
            run->feed(finger(0.0, Phase::down, px_at(0.01), 8));
            for (int i = 1; i <= 200; ++i) run->feed(finger(0.005 * i, Phase::move, px_at(0.01 + 0.9e-4 * i), 8));
            CHECK(run->state.avatar.lag_m.norm() > 0.0);
            if (run == &lifted) run->feed(finger(1.1, Phase::up, px_at(0.03), 8));
            run->feed(pen(1.1, Phase::down, px_at(0.028), 0.7));  // where the finger is: no jump ends the lag
            for (int i = 1; i <= 10; ++i) run->feed(pen(1.1 + 0.005 * i, Phase::move, px_at(0.028 + 5e-5 * i), 0.7));
        }
        CHECK(taken.state.avatar.lag_m == lifted.state.avatar.lag_m);
        CHECK(taken.state.contact.normal_N == lifted.state.contact.normal_N);
    }
}
