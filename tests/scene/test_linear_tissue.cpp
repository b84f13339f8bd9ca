#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

#include "files/cache.h"
#include "files/input_error.h"
#include "files/text.h"
#include "scene/advance.h"
#include "scene/linear_tissue.h"
#include "tests/close_to.h"
#include "tests/scene/allocations.h"
#include "tests/scene/block_phantom.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::avatar;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

struct Block {
    TemporaryFolder folder;
    LinearOptions options;
    LinearTissue tissue;
    LinearWork work;
    explicit Block(std::optional<double> friction = {}) {
        options.friction = friction;
        write_text_atomically(folder / "block.json", kBlockPhantom);
        options.phantom = folder / "block.json";
        options.spacing_m = 4e-3;
        tissue = make_linear_tissue(options, folder / "cache", {});
        work = make_work(tissue);
    }
};

}  // namespace

TEST_CASE("linear tissue: harder sinks deeper, over the nodule less than beside it, nothing without force") {
    Block block;
    double before_m = 0.0;
    for (const double force_N : {0.2, 0.5, 1.0, 1.5}) {
        const LinearAnswer beside = press(block.tissue, {0.045, 0.030}, force_N, block.work);
        CHECK(beside.depth_m > before_m);
        CHECK_FALSE(beside.saturated);
        CHECK(block.work.contact.tool[0].normal_N == close_to(force_N).epsilon(1e-6));
        before_m = beside.depth_m;
        CHECK(press(block.tissue, {0.024, 0.030}, force_N, block.work).depth_m < 0.9 * beside.depth_m);
    }
    CHECK(press(block.tissue, {0.045, 0.030}, 0.0, block.work).depth_m == 0.0);
    const LinearAnswer deep = press(block.tissue, {0.045, 0.030}, 100.0, block.work);
    CHECK(deep.saturated);
    CHECK(deep.depth_m == close_to(0.45 * 0.020));
    CHECK(deep.linearity > 0.25);  // red
}

TEST_CASE("linear tissue: an answer that is not exact says so, and a trial counts it") {
    Block block;
    const Eigen::Vector2d between_nodes(0.0451, 0.0301);
    CHECK(press(block.tissue, between_nodes, 1e-18, block.work).inexact);  // less than the last bit of a depth
    CHECK_FALSE(press(block.tissue, between_nodes, 0.5, block.work).inexact);

    Scene scene;
    scene.tissue = block.options;
    scene.profile = PALPA_SOURCE_DIR "/assets/profiles/s-pen.json";
    ::setenv("XDG_CACHE_HOME", block.folder.path().c_str(), 1);
    Plan plan = make_plan(scene);
    const auto count = [&](const Plan& with) {
        State state = start(scene, with, {600, 600});
        Sample sample;
        const Eigen::Vector2d px = px_of_tissue(state.view, between_nodes);
        sample.x_px = px.x();
        sample.y_px = px.y();
        sample.pressure = 0.45;
        for (const Phase phase : {Phase::down, Phase::move, Phase::up}) {
            sample.phase = phase;
            sample.t_host_s += 0.01;
            advance(scene, with, sample, state);
        }
        return state.counters.inexact;
    };
    CHECK(count(plan) == 0);
    auto& compliance = std::get<LinearTissue>(plan.tissue).compliance;  // that no contact settles on
    compliance.revision = mechanics::new_revision();
    compliance.normal_m_per_N.topRows(compliance.n_touch).diagonal() *= -1.0;
    CHECK(count(plan) == 2);
}

TEST_CASE("linear tissue: resists on the way to the nodule, lets go behind it, mirrored places answer alike") {
    Block block;
    const double depth_m = 2e-3;
    const auto along_x = [&](double x_m, double direction) {
        return tangential_force_N(block.tissue, {x_m, 0.030}, {direction, 0.0}, depth_m, block.work);
    };
    CHECK(along_x(0.016, 1.0) > 5e-3);
    CHECK(along_x(0.032, 1.0) == 0.0);
    CHECK(along_x(0.032, -1.0) == close_to(along_x(0.016, 1.0)).epsilon(0.25));  // the near side differs
    CHECK(tangential_force_N(block.tissue, {0.024, 0.022}, {0.0, 1.0}, depth_m, block.work) ==
          close_to(tangential_force_N(block.tissue, {0.024, 0.038}, {0.0, -1.0}, depth_m, block.work)).epsilon(1e-6));
    CHECK(along_x(0.016, 0.0) == 0.0);
}

TEST_CASE("linear tissue: the surface sinks to the depth under the tool and comes back to zero at the far edge") {
    Block block;
    const LinearAnswer answer = press(block.tissue, {0.032, 0.032}, 0.5, block.work);
    Eigen::VectorXd sink_m;
    surface_sink_m(block.tissue, block.work, sink_m);
    REQUIRE(sink_m.size() == static_cast<Eigen::Index>(block.tissue.n_x * block.tissue.n_y));
    CHECK(sink_m.maxCoeff() == close_to(answer.depth_m).epsilon(0.02));
    CHECK(std::abs(sink_m[0]) < 0.1 * answer.depth_m);
}

TEST_CASE("linear tissue: a second start reads the cache to the same bits, a damaged cache is computed anew") {
    Block block;
    CHECK_FALSE(block.tissue.from_cache);
    CHECK(block.tissue.cache_warning.empty());
    const LinearTissue again = make_linear_tissue(block.options, block.folder / "cache", {});
    CHECK(again.from_cache);
    CHECK(again.compliance.normal_m_per_N == block.tissue.compliance.normal_m_per_N);
    CHECK(again.compliance.node == block.tissue.compliance.node);

    for (const auto& entry : std::filesystem::directory_iterator(block.folder / "cache")) {
        std::string bytes = read_text(entry.path());
        bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
        write_text_atomically(entry.path(), bytes);
    }
    const LinearTissue anew = make_linear_tissue(block.options, block.folder / "cache", {});
    CHECK_FALSE(anew.from_cache);
    CHECK(anew.compliance.normal_m_per_N == block.tissue.compliance.normal_m_per_N);

    Block rough(0.3);  // more of it, under another number
    const LinearTissue rough_again = make_linear_tissue(rough.options, rough.folder / "cache", {});
    CHECK(rough_again.from_cache);
    CHECK(rough_again.compliance.full_m_per_N == rough.tissue.compliance.full_m_per_N);
    CHECK(rough_again.compliance.full_m_per_N.rows() == 3 * rough_again.compliance.n_touch);
}

TEST_CASE(
    "linear tissue: friction sticks, then slides at mu N, turns back with the tool, and is forgotten when lifted") {
    const double mu = 0.3;
    const double force_N = 1.0;
    Block block(mu);
    const double y_m = 0.045;  // beside the nodule
    const auto slide_to = [&](double x_m) {
        const LinearAnswer answer = press(block.tissue, {x_m, y_m}, force_N, block.work);
        drag(block.tissue, {x_m, y_m}, answer.depth_m, block.work);
        return block.work.drag_N.x();
    };
    CHECK(std::abs(slide_to(0.020)) < 0.1 * mu * force_N);  // straight down
    const double stuck_N = slide_to(0.0201);
    CHECK(stuck_N > 0.005);
    CHECK(stuck_N < 0.5 * mu * force_N);
    double x_m = 0.0201;
    while (x_m < 0.036) {
        CHECK(slide_to(x_m += 2e-4) <= mu * force_N * 1.05);
        REQUIRE(!block.work.sliding.flags.not_settled);
    }
    // 5 %: the rough contact is as deep as the smooth one, and so presses a little more or less
    CHECK(block.work.drag_N.x() == close_to(mu * force_N).epsilon(0.05));
    CHECK(rough_tangential_force_N(block.tissue, {x_m, y_m}, {1.0, 0.0}, block.work.depth_m, block.work) > 0.2);
    CHECK(rough_tangential_force_N(block.tissue, {x_m, y_m}, {-1.0, 0.0}, block.work.depth_m, block.work) == 0.0);
    const double slid_N = block.work.drag_N.x();
    // in one leap the last two contact radii are walked, from a fresh touch
    Block leap(mu);
    const auto leap_to = [&](double at_m) {
        const LinearAnswer answer = press(leap.tissue, {at_m, y_m}, force_N, leap.work);
        drag(leap.tissue, {at_m, y_m}, answer.depth_m, leap.work);
    };
    leap_to(0.001);
    leap_to(x_m);
    CHECK(leap.work.drag_N.x() == close_to(slid_N).epsilon(0.02));
    // a long way in one call is walked in half spacings
    LinearWork walked = make_work(block.tissue);
    for (const double at_m : {0.022, 0.024, 0.026, 0.028}) drag(block.tissue, {at_m, y_m}, 2e-3, walked);
    LinearWork at_once = make_work(block.tissue);
    for (const double at_m : {0.022, 0.028}) drag(block.tissue, {at_m, y_m}, 2e-3, at_once);
    REQUIRE(at_once.friction.touch == walked.friction.touch);
    for (std::size_t i = 0; i < walked.friction.force_N.size(); ++i) {
        CHECK(at_once.friction.force_N[i] == close_to(walked.friction.force_N[i]).epsilon(1e-9));
    }
    while (x_m > 0.024) slide_to(x_m -= 2e-4);
    CHECK(block.work.drag_N.x() == close_to(-mu * force_N).epsilon(0.05));
    drag(block.tissue, {x_m, y_m}, 0.0, block.work);
    CHECK(block.work.drag_N.isZero(0.0));
    CHECK(block.work.friction.touch.empty());
    CHECK(std::abs(slide_to(x_m)) < 0.1 * mu * force_N);
}

TEST_CASE("linear tissue: a compliance with friction beyond 1 GB is refused before it is computed") {
    Block block;
    block.options.friction = 0.3;
    block.options.spacing_m = 0.9e-3;
    CHECK_THROWS_WITH_AS(make_linear_tissue(block.options, {}, {}), doctest::Contains("GB of compliance with friction"),
                         InputError);
}

namespace {

// Along x over the nodule and out again, 46 mm; returns the greatest number of stations skipped in one sample.
std::int64_t stroke_over(const Scene& scene, const Plan& plan, double speed_m_per_s, double rate_Hz, State& state) {
    std::int64_t most = 0;
    for (int i = 0; i * speed_m_per_s / rate_Hz < 0.046; ++i) {
        Sample sample;
        sample.t_host_s = i / rate_Hz;
        sample.phase = i == 0 ? Phase::down : Phase::move;
        const Eigen::Vector2d px = px_of_tissue(state.view, {0.007 + i * speed_m_per_s / rate_Hz, 0.030});
        sample.x_px = px.x();
        sample.y_px = px.y();
        sample.pressure = 0.45;
        const std::int64_t before = state.counters.skipped_stations;
        advance(scene, plan, sample, state);
        most = std::max(most, state.counters.skipped_stations - before);
    }
    return most;
}

}  // namespace

TEST_CASE("linear tissue: a fast stroke skips stations and counts them, alike in every run; a slow one skips none") {
    std::optional<double> friction;
    SUBCASE("frictionless") {}
    SUBCASE("with friction") { friction = 0.3; }
    Block block(friction);
    Scene scene;
    scene.tissue = block.options;
    scene.profile = PALPA_SOURCE_DIR "/assets/profiles/s-pen.json";
    scene.display_ratio = display_ratio_clear();
    scene.delay = delay_clear();
    ::setenv("XDG_CACHE_HOME", block.folder.path().c_str(), 1);
    const Plan plan = make_plan(scene);
    for (const double rate_Hz : {60.0, 120.0}) {
        CAPTURE(rate_Hz);
        State slow = start(scene, plan, {600, 600});
        stroke_over(scene, plan, 0.19, rate_Hz, slow);
        CHECK(slow.counters.skipped_stations == 0);
        CHECK(slow.counters.skipped_slides == 0);
    }
    // 20 mm a sample are 400 stations; 64 are asked for, by each of the two laws
    State fast[2] = {start(scene, plan, {600, 600}), start(scene, plan, {600, 600})};
    for (State& state : fast) CHECK(std::abs(stroke_over(scene, plan, 1.2, 60.0, state) - 2 * (400 - 64)) <= 2);
    CHECK(fast[0].counters.skipped_stations == fast[1].counters.skipped_stations);
    CHECK(fast[0].counters.skipped_slides == 0);  // 10 half spacings a sample
    CHECK(fast[0].avatar.p_m == fast[1].avatar.p_m);
    CHECK(fast[0].contact.tangential_N == fast[1].contact.tangential_N);
    State leap = start(scene, plan, {600, 600});
    stroke_over(scene, plan, 2.4, 60.0, leap);
    CHECK((leap.counters.skipped_slides > 0) == friction.has_value());  // 20 half spacings, 16 walked
}

namespace {

const LinearWork& work_of(const State& state) { return std::get<LinearWork>(state.tissue); }

}  // namespace

TEST_CASE("linear tissue: palpated live a sample allocates nothing and two runs agree to the last bit") {
    std::optional<double> friction;
    SUBCASE("frictionless") {}
    SUBCASE("with friction") { friction = 0.3; }
    Block block(friction);
    Scene scene;
    scene.tissue = block.options;
    scene.profile = PALPA_SOURCE_DIR "/assets/profiles/s-pen.json";
    scene.display_ratio = display_ratio_clear();
    Plan plan;
    {
        // as make_plan does, with the cache of this test
        ::setenv("XDG_CACHE_HOME", block.folder.path().c_str(), 1);
        plan = make_plan(scene);
    }
    const bool rubs = std::any_of(plan.sample_stages.begin(), plan.sample_stages.end(),
                                  [](const Stage& stage) { return stage.id == StageId::friction; });
    CHECK(rubs == friction.has_value());
    State states[3] = {start(scene, plan, {600, 600}), start(scene, plan, {600, 600}), {}};
    std::int64_t allocated = 0;
    constexpr int kStored = 300;  // in the middle of a slide; the third run goes on from the state then
    for (State& state : states) {
        const bool goes_on = &state == &states[2];
        for (int i = goes_on ? kStored : 0; i < 600; ++i) {
            if (&state == &states[1] && i == kStored) states[2] = state;
            Sample sample;
            sample.t_host_s = 2e-3 * i;
            sample.phase = i == 0 ? Phase::down : Phase::move;
            const Eigen::Vector2d px = px_of_tissue(state.view, {0.008 + 6e-5 * i, 0.030});
            sample.x_px = px.x();
            sample.y_px = px.y();
            sample.pressure = 0.45;
            const std::int64_t before = allocations();
            advance(scene, plan, sample, state);
            if (i > 0 && !goes_on) allocated += allocations() - before;
        }
    }
    CHECK(allocated == 0);
    CHECK(states[0].extremes.lag_m > 0.05e-3);
    CHECK(states[0].extremes.lag_m == states[1].extremes.lag_m);
    CHECK(states[0].avatar.p_m == states[1].avatar.p_m);
    CHECK(states[0].contact.depth_m == states[1].contact.depth_m);
    for (const State* other : {&states[1], &states[2]}) {
        CHECK(states[0].contact.tangential_N == other->contact.tangential_N);
        CHECK(work_of(states[0]).drag_N == work_of(*other).drag_N);
        CHECK(work_of(states[0]).friction.force_N == work_of(*other).friction.force_N);
    }
    CHECK((work_of(states[0]).drag_N.x() > 0.1) == friction.has_value());
    Sample lift;
    lift.t_host_s = 2.0;
    lift.phase = Phase::up;
    lift.x_px = lift.y_px = 300.0;
    advance(scene, plan, lift, states[0]);
    CHECK(work_of(states[0]).drag_N.isZero(0.0));
}

TEST_CASE("linear tissue: a graded block answers as an even one, finest where it was asked for") {
    Block even;
    Block graded;
    graded.options.grading = mechanics::Grading{{0.045, 0.030}, 2e-3};
    graded.tissue = make_linear_tissue(graded.options, graded.folder / "cache", {});
    graded.work = make_work(graded.tissue);
    REQUIRE(graded.tissue.graded);
    CHECK(graded.tissue.compliance.n_touch == even.tissue.compliance.n_touch);
    CHECK(graded.tissue.content != even.tissue.content);
    const auto spacing_m = [&](double x_m, double y_m) { return spacing_at_m(graded.tissue, {x_m, y_m}); };
    CHECK(spacing_m(0.0451, 0.0301) == close_to(2e-3).epsilon(0.05));
    CHECK(spacing_m(0.001, 0.001) > 3e-3);
    CHECK(spacing_at_m(even.tissue, {0.001, 0.001}) == close_to(4e-3));
    const double even_m = press(even.tissue, {0.045, 0.030}, 0.5, even.work).depth_m;
    CHECK(press(graded.tissue, {0.045, 0.030}, 0.5, graded.work).depth_m == close_to(even_m).epsilon(0.1));

    // pictures get an even grid, deepest under the finger
    SurfaceShape shape;
    sample_surface(graded.tissue, {}, {}, graded.work, shape);
    REQUIRE(shape.sink_m.size() == shape.n_x * shape.n_y);
    Eigen::Index deepest = 0;
    shape.sink_m.maxCoeff(&deepest);
    CHECK(static_cast<double>(deepest % shape.n_x) * shape.spacing_m.x() == close_to(0.045).epsilon(0.06));
    CHECK(static_cast<double>(deepest / shape.n_x) * shape.spacing_m.y() == close_to(0.030).epsilon(0.06));

    // the cache keeps them apart and brings the coordinates back
    const LinearTissue again = make_linear_tissue(graded.options, graded.folder / "cache", {});
    CHECK(again.from_cache);
    REQUIRE(again.graded);
    CHECK(again.graded->x.at_m == graded.tissue.graded->x.at_m);
    graded.options.grading->centre_m[0] = 0.07;  // the block ends at 60 mm
    CHECK_THROWS_AS(make_linear_tissue(graded.options, {}, {}), InputError);
}
