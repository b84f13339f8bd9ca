#include "mechanics/face_point.h"

#include <Eigen/LU>
#include <algorithm>

namespace palpa::mechanics {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

// The nearest point on the edge from corner k to the next.
OnFace nearest_on_edge(const Matrix3Xd& x, Index k, const Vector3d& place) {
    const Index next = (k + 1) % x.cols();
    const Vector3d along = x.col(next) - x.col(k);
    const double length2 = along.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp(along.dot(place - x.col(k)) / length2, 0.0, 1.0) : 0.0;
    OnFace out{Eigen::VectorXd::Zero(x.cols()), (x.col(k) + t * along - place).norm()};
    out.weight(k) = 1.0 - t;
    out.weight(next) = t;
    return out;
}

}  // namespace

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
    OnFace nearest{weights(r, s), 0.0};
    nearest.away_m = (x * nearest.weight - place).norm();
    if (r > 0.0 && s > 0.0 && (quad ? std::max(r, s) : r + s) < 1.0) return nearest;
    for (Index k = 0; k < x.cols(); ++k) {  // clamping r and s one by one is not the nearest point of a skew face
        const OnFace on_edge = nearest_on_edge(x, k, place);
        if (on_edge.away_m < nearest.away_m) nearest = on_edge;
    }
    return nearest;
}

Matrix3Xd corners_of_face_m(const Mesh& mesh, const Faces& faces, Index face) {
    Matrix3Xd x(3, faces.corners.rows());
    for (Index k = 0; k < x.cols(); ++k) x.col(k) = mesh.nodes_m.col(faces.corners(k, face));
    return x;
}

}  // namespace palpa::mechanics
