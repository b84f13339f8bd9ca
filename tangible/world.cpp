#include "tangible/world.h"

#include <algorithm>

namespace palpa::tangible {

World make_world(const scene::Scene& scene, const scene::Plan& plan) {
    World world;
    world.tissue = &plan.tissue;
    world.force_N_per_N = scene.stiffness_scale;
    if (scene.tangible) {
        world.finger_share = scene.tangible->force_scale;
        world.force_N_per_N *= world.finger_share;
        world.depth_scale = scene.tangible->depth_scale;
    }
    return world;
}

WorldForce world_force(const World& world, const Eigen::Vector2d& place_m, double depth_m, scene::TissueWork& work) {
    WorldForce out;
    out.depth_m = world.depth_scale * depth_m;
    const scene::Push push = scene::push_to(*world.tissue, place_m, out.depth_m, work);
    out.force_N = std::max(0.0, world.force_N_per_N * push.force_N);
    out.slope_N_per_m = world.force_N_per_N * world.depth_scale * push.slope_N_per_m;
    out.proxy_m = push.depth_m;
    out.saturated = push.saturated;
    out.inexact = push.inexact;
    return out;
}

}  // namespace palpa::tangible
