#include "mechanics/face_point.h"

#include <Eigen/LU>
#include <algorithm>

namespace palpa::mechanics {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

OnFace nearest_on_face(const Matrix3Xd& x, const Vector3d& place) {
    const bool quad = x.cols() == 4;
    const auto weights = [&](double r, double s) {
        Eigen::VectorXd w(x.cols());
        if (quad) {
            w << (1.0 - r) * (1.0 - s), r * (1.0 - s), r * s, (1.0 - r) * s;
        } else {
            w << 1.0 - r - s, r, s;
        }
        return w;
    };
    double r = quad ? 0.5 : 1.0 / 3.0;
    double s = r;
    for (int i = 0; i < 12; ++i) {  // Gauss-Newton on |X(r, s) - place|, clamped to the face
        Eigen::Matrix<double, 3, 2> J;
        J.col(0) = quad ? Vector3d((1.0 - s) * (x.col(1) - x.col(0)) + s * (x.col(2) - x.col(3)))
                        : Vector3d(x.col(1) - x.col(0));
        J.col(1) = quad ? Vector3d((1.0 - r) * (x.col(3) - x.col(0)) + r * (x.col(2) - x.col(1)))
                        : Vector3d(x.col(2) - x.col(0));
        const Eigen::Vector2d step = (J.transpose() * J).inverse() * (J.transpose() * (place - x * weights(r, s)));
        r = std::clamp(r + step(0), 0.0, 1.0);
        s = std::clamp(s + step(1), 0.0, quad ? 1.0 : 1.0 - r);
    }
    const Eigen::VectorXd weight = weights(r, s);
    return {weight, (x * weight - place).norm()};
}

Matrix3Xd corners_of_face_m(const Mesh& mesh, const Faces& faces, Index face) {
    Matrix3Xd x(3, faces.corners.rows());
    for (Index k = 0; k < x.cols(); ++k) x.col(k) = mesh.nodes_m.col(faces.corners(k, face));
    return x;
}

}  // namespace palpa::mechanics
