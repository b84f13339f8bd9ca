#include <doctest/doctest.h>

#include "tests/close_to.h"
#include "tests/tangible/small_strip.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;

TEST_CASE("virtual world: force and slope carry the scene's scales, and nothing pulls") {
    KnownTissue known(0.02, 3.0);
    scene::TissueWork work = scene::make_work(known.tissue);
    const scene::ForceCurve& curve = *scene::curve_of(known.tissue);
    const WorldForce plain = world_force(known.world, {0.0, 0.0}, 3e-3, work);
    CHECK(plain.force_N == close_to(scene::force_at_N(curve, 3e-3)));
    CHECK(plain.proxy_m == 3e-3);
    known.world.force_N_per_N = 2.0;
    known.world.depth_scale = 0.5;
    const WorldForce scaled = world_force(known.world, {0.0, 0.0}, 6e-3, work);
    CHECK(scaled.force_N == close_to(2.0 * plain.force_N));
    CHECK(scaled.slope_N_per_m == close_to(plain.slope_N_per_m));
    CHECK(world_force(known.world, {0.0, 0.0}, -1e-3, work).force_N == 0.0);
    CHECK(world_force(known.world, {0.0, 0.0}, 1.0, work).saturated);
}

TEST_CASE("virtual world: a press on the tissue is one on the device by the scene's force_scale") {
    scene::Scene scene = scene::read_scene(kAssets / "scenes" / "default.json", kAssets);
    const scene::Plan plan = scene::make_plan(scene);
    scene.stiffness_scale = 3.0;
    scene.tangible.emplace().force_scale = 0.25;
    const World world = make_world(scene, plan);
    CHECK(world.finger_share == 0.25);  // the tissue's own stiffness is in its depth already
    CHECK(world.force_N_per_N == 0.75);
}

TEST_CASE("virtual world: a map's force at a depth is the force that reaches this depth") {
    const scene::Scene scene = scene::read_scene(kAssets / "scenes" / "default.json", kAssets);
    const scene::Plan plan = scene::make_plan(scene);
    const World world = make_world(scene, plan);
    scene::TissueWork work = scene::make_work(plan.tissue);
    const WorldForce force = world_force(world, plan.area.centre_m, 4e-3, work);
    REQUIRE(force.force_N > 0.0);
    scene::Contact contact;
    scene::answer(plan.tissue, scene::StageId::depth, {plan.area.centre_m, force.force_N, {}, true, 1.0}, work,
                  contact);
    CHECK(contact.depth_m == close_to(4e-3).epsilon(1e-6));
}
