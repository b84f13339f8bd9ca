#pragma once
// The tissue's surface under a contact, in either of two forms: a curve that is the same all around the contact, or
// nodes on a grid. For pictures, and for displays that want it at places of their own.

#include <Eigen/Core>
#include <optional>

#include "avatar/surface.h"

namespace palpa::scene {

struct SurfaceShape {
    std::optional<avatar::SurfaceCurve> curve;           // around centre_m
    Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();  // on the tissue
    Eigen::Index n_x = 0;                                // nodes, x fastest, the first one at the origin; 0: none
    Eigen::Index n_y = 0;
    Eigen::Vector2d spacing_m = Eigen::Vector2d::Zero();
    Eigen::VectorXd sink_m;  // of the nodes, downwards
};

// Sink at any place of the tissue: linear between the nodes; beside the grid as at its edge.
double sink_at_m(const SurfaceShape& shape, const Eigen::Vector2d& p_m);

}  // namespace palpa::scene
