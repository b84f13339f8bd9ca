// The optional effects on the avatar: a strength of zero equals absence, and what a finger drags along.

#include <doctest/doctest.h>

#include "files/text.h"
#include "scene/advance.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

struct Stroke {
    Scene scene;
    Plan plan;
    State state;
    double pressure = 0.7;
    std::vector<Avatar> avatars;  // after each sample, and 0.2 s later if no other sample came

    Stroke(const std::string& avatar, Tool tool) {
        const TemporaryFolder folder;
        write_text_atomically(folder / "s.json", R"({"name": "n", "tissue": {"map": "silicone.map"})" + avatar + "}");
        scene = read_scene(folder / "s.json", kAssets);
        plan = make_plan(scene);
        state = start(scene, plan, {1280, 800});
        for (int i = 0; i <= 240; ++i) feed(i, tool);
    }

    // Over nodule A at 30 mm/s.
    void feed(int i, Tool tool) {
        const Eigen::Vector2d px = px_of_tissue(state.view, {0.015 + 0.03 * i / 240.0, 0.035});
        Sample sample;
        sample.t_host_s = i / 240.0;
        sample.pointer_id = 3;
        sample.tool = tool;
        sample.phase = i == 0 ? Phase::down : Phase::move;
        sample.x_px = px.x();
        sample.y_px = px.y();
        sample.pressure = pressure;
        advance(scene, plan, sample, state);
        avatars.push_back(state.avatar);
        avatars.push_back(avatar_at(scene, state, sample.t_host_s + 0.2));
    }
};

bool same(const Avatar& a, const Avatar& b) {
    return a.p_m == b.p_m && a.lag_m == b.lag_m && a.texture_m == b.texture_m && a.delay_s == b.delay_s;
}

bool same(const Stroke& a, const Stroke& b) {
    return std::equal(a.avatars.begin(), a.avatars.end(), b.avatars.begin(), b.avatars.end(),
                      [](const Avatar& x, const Avatar& y) { return same(x, y); }) &&
           a.state.contact.tangential_N == b.state.contact.tangential_N &&
           a.state.extremes.lag_m == b.state.extremes.lag_m &&
           a.plan.sample_stages.size() == b.plan.sample_stages.size();
}

double greatest_m(const Stroke& stroke, Eigen::Vector2d Avatar::*which) {
    double greatest = 0.0;
    for (const Avatar& avatar : stroke.avatars) greatest = std::max(greatest, (avatar.*which).norm());
    return greatest;
}

const std::string kRatio = R"({"display_ratio": {"preset": "strong"})";
const std::string kDelay = R"({"delay": {"preset": "strong"})";

}  // namespace

TEST_CASE("effects: a strength of zero equals absence to the last bit") {
    const Stroke none("", Tool::finger);
    CHECK(none.state.extremes.lag_m == 0.0);
    for (const char* law : {"display_ratio", "delay"}) {
        CAPTURE(law);
        const std::string begin = std::string(R"(, "avatar": {")") + law + R"(": {"preset": "strong")";
        CHECK(same(Stroke(begin + R"(, "strength": 0, "smoothing_mm": 2}})", Tool::finger), none));
        const Stroke plain(begin + "}}", Tool::finger);
        CHECK(plain.state.extremes.lag_m > 1e-3);
        CHECK_FALSE(same(plain, none));
        CHECK(same(Stroke(begin + R"(}, "texture_drag": {"strength": 0}})", Tool::finger), plain));
    }
}

TEST_CASE("effects: a finger drags the texture along by what the avatar loses, a pen does not") {
    for (const std::string& law : {kRatio, kDelay}) {
        CAPTURE(law);
        const Stroke lagging(", \"avatar\": " + law + "}", Tool::finger);
        const Stroke whole(", \"avatar\": " + law + R"(, "texture_drag": {}})", Tool::finger);
        const Stroke part(", \"avatar\": " + law + R"(, "texture_drag": {"strength": 0.25}})", Tool::finger);
        REQUIRE(lagging.avatars.size() == whole.avatars.size());
        for (std::size_t i = 0; i < lagging.avatars.size(); ++i) {
            const Eigen::Vector2d lag_m = lagging.avatars[i].lag_m;
            CHECK(whole.avatars[i].lag_m.norm() == 0.0);
            CHECK(whole.avatars[i].texture_m == lag_m);
            CHECK((part.avatars[i].texture_m - 0.25 * lag_m).norm() < 1e-15);
            CHECK((part.avatars[i].lag_m + part.avatars[i].texture_m - lag_m).norm() < 1e-15);
        }
        CHECK(greatest_m(whole, &Avatar::texture_m) > 1e-3);
        CHECK(whole.state.extremes.lag_m == lagging.state.extremes.lag_m);
        const Stroke pen(", \"avatar\": " + law + R"(, "texture_drag": {}})", Tool::pen);
        CHECK(greatest_m(pen, &Avatar::texture_m) == 0.0);
        CHECK(greatest_m(pen, &Avatar::lag_m) == greatest_m(whole, &Avatar::texture_m));
    }
}

TEST_CASE("effects: per newton, a place lags alike whether it is pressed with 1 N or 3 N") {
    const auto lag_m = [](const char* keys, double force_N) {
        Stroke stroke(std::string(R"(, "avatar": {"display_ratio": {"preset": "strong")") + keys + "}}", Tool::pen);
        stroke.state = start(stroke.scene, stroke.plan, {1280, 800});
        stroke.pressure = calibration::level_at_force(stroke.plan.profile, force_N);
        for (int i = 0; i <= 240; ++i) stroke.feed(i, Tool::pen);
        return stroke.state.extremes.lag_m;
    };
    CHECK(lag_m("", 3.0) > 3.0 * lag_m("", 1.0));
    CHECK(lag_m(R"(, "per_newton": true)", 3.0) < 2.0 * lag_m(R"(, "per_newton": true)", 1.0));
    CHECK(lag_m(R"(, "per_newton": true)", 1.0) == close_to(lag_m("", 1.0)).epsilon(1e-6));
    // a press of less than 0.5 N counts as one of 0.5 N, so that nothing is divided by next to nothing
    const double light_m = lag_m(R"(, "strength": 40, "per_newton": true)", 0.25);
    CHECK(light_m > 1e-4);
    CHECK(light_m == close_to(lag_m(R"(, "strength": 80)", 0.25)).epsilon(1e-6));
}

TEST_CASE("effects: the lift of the finger lets the texture go at once") {
    Stroke stroke(", \"avatar\": " + kRatio + R"(, "texture_drag": {}})", Tool::finger);
    Sample lift;
    lift.t_host_s = 1.01;
    lift.pointer_id = 3;
    lift.tool = Tool::finger;
    lift.phase = Phase::up;
    advance(stroke.scene, stroke.plan, lift, stroke.state);
    CHECK(stroke.state.avatar.texture_m.norm() == 0.0);
    CHECK(avatar_at(stroke.scene, stroke.state, 1.1).texture_m.norm() == 0.0);
}

TEST_CASE("effects: dragging the texture is a stage of its own, after the law") {
    const Stroke stroke(", \"avatar\": " + kDelay + R"(, "texture_drag": {"strength": 0.5}})", Tool::finger);
    const Stage& last = stroke.plan.sample_stages.back();
    CHECK(last.id == StageId::texture_drag);
    CHECK(last.fidelity == "under a finger, 50 % of the lag goes to the texture");
    CHECK(stroke.state.meters[static_cast<std::size_t>(StageId::texture_drag)].calls() == 241);
}
