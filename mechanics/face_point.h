#pragma once
// The place of a face, a triangle or a bilinear quad, that is nearest to a given one.

#include <Eigen/Core>

#include "mechanics/mesh.h"

namespace palpa::mechanics {

struct OnFace {
    Eigen::VectorXd weight;  // on the face's corners, each 0..1, their sum 1
    double away_m = 0.0;
};

// corners_m: 3 x 3 or 3 x 4, in the order of Faces. Exact on faces that are flat; on warped quads as far as
// twelve steps of Gauss-Newton go.
OnFace nearest_on_face(const Eigen::Matrix3Xd& corners_m, const Eigen::Vector3d& place_m);

Eigen::Matrix3Xd corners_of_face_m(const Mesh& mesh, const Faces& faces, Eigen::Index face);

}  // namespace palpa::mechanics
