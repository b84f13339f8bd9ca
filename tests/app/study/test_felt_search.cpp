// What a searching hand feels of places that are stiffer than others.

#include <cmath>
#include <doctest/doctest.h>

#include "app/scene_choices.h"
#include "app/study/felt_search.h"
#include "scene/tissue.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::study;
using namespace palpa::app;
using namespace palpa::test;

namespace {

StudyScene default_tissue() {
    StudyScene out;
    out.scene = load_scene("");
    out.plan = std::make_shared<const scene::Plan>(scene::make_plan(out.scene));
    return out;
}

// The contact of a touch with this force.
scene::State pressed(const StudyScene& scene, const Eigen::Vector2d& place_m, double force_N) {
    scene::State state;
    scene::Press press;
    press.p_m = place_m;
    press.force_N = force_N;
    press.down = true;
    scene::TissueWork work = make_work(scene.plan->tissue);
    answer(scene.plan->tissue, scene::StageId::depth, press, work, state.contact);
    state.touch.down = true;
    state.touch.force_N = force_N;
    return state;
}

Eigen::Vector2d nodule_m(const StudyScene& scene) { return {scene.plan->nodules[0].x_m, scene.plan->nodules[0].y_m}; }

}  // namespace

TEST_CASE("felt search: a cast lets the hand sink by what the place's own stiffness says, and is not seen") {
    const StudyScene scene = default_tissue();
    const FeltSearch cast(scene, felt_by_hand);
    const double force_N = 1.5;
    const Eigen::Vector2d middle_m = scene.plan->area.centre_m;
    const scene::State plain = pressed(scene, middle_m, force_N);
    const Sight there = cast.sight(plain);
    CHECK_FALSE(there.lag_shown);
    CHECK(there.dent_shown);
    CHECK(there.depth_m / plain.contact.depth_m == close_to(1.0).epsilon(0.01));
    const scene::State stiff = pressed(scene, nodule_m(scene), force_N);
    REQUIRE(stiff.contact.depth_m < 0.95 * plain.contact.depth_m);
    // the force that reaches the nodule's depth in the middle, by bisection
    double low_N = 0.0, high_N = force_N;
    for (int i = 0; i < 40; ++i) {
        const double mean_N = 0.5 * (low_N + high_N);
        (pressed(scene, middle_m, mean_N).contact.depth_m < stiff.contact.depth_m ? low_N : high_N) = mean_N;
    }
    const double ratio = force_N / low_N;
    CHECK(cast.sight(stiff).depth_m / plain.contact.depth_m == close_to(1.0 / ratio).epsilon(0.02));
    CHECK(cast.sd() == close_to(0.1815).epsilon(0.01));  // of hand and fingertip joined
}

TEST_CASE("felt search: a display at its limit feels alike everywhere, and one that shows nothing tells nothing") {
    const StudyScene scene = default_tissue();
    const FeltSearch saturated(scene, [](double) { return felt_by_hand(0.7); });
    const double there = saturated.sight(pressed(scene, scene.plan->area.centre_m, 1.5)).depth_m;
    CHECK(saturated.sight(pressed(scene, nodule_m(scene), 1.5)).depth_m / there == close_to(1.0).epsilon(1e-9));
    const FeltSearch broken(scene, [](double) { return FeltStiffness{}; });
    CHECK(broken.felt_ln(3.0) == 0.0);
    scene::State lifted = pressed(scene, nodule_m(scene), 1.5);
    lifted.touch.down = false;
    CHECK_FALSE(saturated.sight(lifted).dent_shown);
}

TEST_CASE("felt search: what is displayed too softly is felt too softly, between the tabulated ratios too") {
    const StudyScene scene = default_tissue();
    const FeltSearch soft(scene, [](double ratio) { return felt_by_hand(std::sqrt(ratio)); });
    for (const double ratio : {0.6, 1.0, 1.2, 3.3}) {
        CAPTURE(ratio);
        CHECK(std::abs(soft.felt_ln(ratio) - 0.5 * std::log(ratio)) < 1e-4);
    }
}
