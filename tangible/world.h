#pragma once
// The virtual world of a soft device: the scene's tissue under a finger, which is a sphere or a point that stays on its
// surface (the god-object). It turns the depth of the finger into the force that the device is to push back with.

#include "scene/plan.h"

namespace palpa::tangible {

struct World {
    const scene::Tissue* tissue = nullptr;  // of the scene's plan, which must outlive this
    double force_N_per_N = 1.0;  // the device's force over that of the prepared tissue: both scales of the scene
    double finger_share = 1.0;   // force_scale: what of a press on the tissue is one on the device
    double depth_scale = 1.0;    // depth in the tissue over that of the device
};
World make_world(const scene::Scene& scene, const scene::Plan& plan);

struct WorldForce {
    double force_N = 0.0;        // on the finger
    double slope_N_per_m = 0.0;  // of it, over the depth in the device
    double depth_m = 0.0;        // that was asked of the tissue
    double proxy_m = 0.0;        // of the god-object
    bool saturated = false;      // the tissue is not known as deep as that
    bool inexact = false;        // the tissue's contact did not settle
};

// depth_m: of the finger in the device, from its rest. Allocates nothing and does not throw.
WorldForce world_force(const World& world, const Eigen::Vector2d& place_m, double depth_m, scene::TissueWork& work);

}  // namespace palpa::tangible
