#pragma once
// The tissue's surface under a contact, in one of two forms: a curve that is the same all around the contact, or nodes
// on a grid. It is made for pictures, and for shape displays, which ask for the sink at places of their own.

#include <Eigen/Core>
#include <optional>

#include "avatar/surface.h"
#include "scene/cues.h"

namespace palpa::scene {

struct SurfaceShape {
    std::optional<avatar::SurfaceCurve> curve;           // around centre_m; absent: the nodes
    Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();  // place on the tissue
    Eigen::Index n_x = 0;                                // nodes along x and y, the first one at the origin; 0: none
    Eigen::Index n_y = 0;
    Eigen::Vector2d spacing_m = Eigen::Vector2d::Zero();
    Eigen::VectorXd sink_m;  // of the nodes, downwards, n_x * n_y values, x fastest
    CueValues cues;          // what is drawn with it
};

// Returns the sink (m, downwards) at any place of the tissue: linear between the nodes; beside the grid as at its edge.
double sink_at_m(const SurfaceShape& shape, const Eigen::Vector2d& p_m);

}  // namespace palpa::scene
