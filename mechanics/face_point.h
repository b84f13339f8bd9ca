#pragma once
// The point of a face, a triangle or a bilinear quad, that is nearest to a given place.

#include <Eigen/Core>

#include "mechanics/mesh.h"

namespace palpa::mechanics {

struct OnFace {
    Eigen::VectorXd weight;  // of the face's corners, each 0..1, with sum 1
    double away_m = 0.0;     // distance of the point from the place
};

// corners_m: 3 x 3 or 3 x 4, in the order of Faces. Exact on triangles and parallelograms, and where the nearest point
// lies on an edge; inside other quads as exact as twelve steps of Gauss-Newton.
OnFace nearest_on_face(const Eigen::Matrix3Xd& corners_m, const Eigen::Vector3d& place_m);

// Returns the corners of a face, 3 x 3 or 3 x 4.
Eigen::Matrix3Xd corners_of_face_m(const Mesh& mesh, const Faces& faces, Eigen::Index face);

}  // namespace palpa::mechanics
