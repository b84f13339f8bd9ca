#include "mechanics/loads.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "mechanics/disc_integral.h"
#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::Matrix2Xd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// Integrals over a triangle of the shape functions N_i = al + be x + ga y times the pressure whose moments are m.
Eigen::Vector3d triangle_shares(const Matrix2Xd& x, const DiscMoments& m) {
    Eigen::Matrix3d basis;
    basis << Eigen::RowVector3d::Ones(), x;  // rows 1, x, y; columns corners
    return basis.inverse() * m.head<3>();
}

bool is_parallelogram(const Matrix2Xd& x) {
    const Vector2d skew = x.col(0) - x.col(1) + x.col(2) - x.col(3);
    return skew.norm() < 1e-10 * (x.col(2) - x.col(0)).norm();
}

// The same over a parallelogram. With r = a . (X - x0) and s = b . (X - x0) from 0 to 1 along its edges, the bilinear
// shape functions (1-r)(1-s), r(1-s), r s, (1-r) s are polynomials of the second degree in X.
Eigen::Vector4d parallelogram_shares(const Matrix2Xd& x, const DiscMoments& m) {
    Eigen::Matrix2d edges;
    edges << x.col(1) - x.col(0), x.col(3) - x.col(0);
    const Eigen::Matrix2d inverse = edges.inverse();
    const Vector2d origin = -inverse * x.col(0);  // (r, s) at X = 0
    const auto first = [&](int i) { return origin(i) * m(0) + inverse(i, 0) * m(1) + inverse(i, 1) * m(2); };
    const double r = first(0);
    const double s = first(1);
    const double rs =
        origin(0) * origin(1) * m(0) + (origin(0) * inverse(1, 0) + origin(1) * inverse(0, 0)) * m(1) +
        (origin(0) * inverse(1, 1) + origin(1) * inverse(0, 1)) * m(2) + inverse(0, 0) * inverse(1, 0) * m(3) +
        (inverse(0, 0) * inverse(1, 1) + inverse(0, 1) * inverse(1, 0)) * m(4) + inverse(0, 1) * inverse(1, 1) * m(5);
    return {m(0) - r - s + rs, r - rs, rs, s - rs};
}

// Integrals of (1 - r^2/R^2) N_i over the part of the face inside the disc; x is relative to the disc's centre.
VectorXd face_shares(const Matrix2Xd& x, double R, LoadShare share) {
    const DiscMoments m = disc_moments(x, R);
    const Index n = x.cols();
    if (share == LoadShare::thirds) return VectorXd::Constant(n, m(0) / static_cast<double>(n));
    if (n == 3) return triangle_shares(x, m);
    if (is_parallelogram(x)) return parallelogram_shares(x, m);
    VectorXd sum = VectorXd::Zero(4);
    constexpr int kHalves[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
    for (const auto& half : kHalves) {
        Matrix2Xd corner(2, 3);
        for (int k = 0; k < 3; ++k) corner.col(k) = x.col(half[k]);
        const Eigen::Vector3d part = triangle_shares(corner, disc_moments(corner, R));
        for (int k = 0; k < 3; ++k) sum(half[k]) += 0.5 * part(k);
    }
    return sum;
}

}  // namespace

PressureLoad parabolic_load(const Mesh& mesh, const Faces& outer, const ParabolicPressure& pressure, LoadShare share) {
    const double R = 0.5 * pressure.diameter_m;
    if (!(R > 0.0) || !std::isfinite(R) || !std::isfinite(pressure.force_N) || !std::isfinite(pressure.centre_m[0]) ||
        !std::isfinite(pressure.centre_m[1])) {
        throw LoadError(text("parabolic pressure: diameter ", pressure.diameter_m, " m, force ", pressure.force_N,
                             " N, centre ", pressure.centre_m[0], ", ", pressure.centre_m[1],
                             " m; wanted finite numbers and a diameter > 0"));
    }
    const int axis = axis_of(pressure.side);
    const int first = axis == 0 ? 1 : 0;
    const int second = axis == 2 ? 1 : 2;
    const double inward = is_max(pressure.side) ? -1.0 : 1.0;
    const double Pmax = 2.0 * pressure.force_N / (std::numbers::pi * R * R);

    PressureLoad load{Eigen::Matrix3Xd::Zero(3, mesh.nodes_m.cols()), 0.0, false};
    const Faces faces = faces_on(mesh, outer, pressure.side);
    for (Index f = 0; f < faces.cell.size(); ++f) {
        Matrix2Xd x(2, faces.corners.rows());
        for (Index k = 0; k < x.cols(); ++k) {
            const int node = faces.corners(k, f);
            x.col(k) << mesh.nodes_m(first, node) - pressure.centre_m[0],
                mesh.nodes_m(second, node) - pressure.centre_m[1];
        }
        if ((x.row(0).minCoeff() > R) || (x.row(0).maxCoeff() < -R) || (x.row(1).minCoeff() > R) ||
            (x.row(1).maxCoeff() < -R))
            continue;
        // projected along the axis, the corners on some sides run clockwise: `sign` undoes the negative area
        const Vector2d a = x.col(1) - x.col(0);
        const Vector2d b = x.col(2) - x.col(0);
        const double sign = a.x() * b.y() - a.y() * b.x() < 0.0 ? -1.0 : 1.0;
        const VectorXd shares = sign * Pmax * face_shares(x, R, share);
        for (Index k = 0; k < x.cols(); ++k) load.force_N(axis, faces.corners(k, f)) += inward * shares(k);
        load.applied_N += shares.sum();
    }
    load.partial = std::abs(load.applied_N - pressure.force_N) > 1e-9 * std::abs(pressure.force_N);
    return load;
}

Eigen::Matrix3Xd traction_load(const Mesh& mesh, const Faces& faces, const std::array<double, 3>& traction_Pa) {
    const Eigen::Vector3d t(traction_Pa[0], traction_Pa[1], traction_Pa[2]);
    if (!t.allFinite()) throw LoadError(text("traction ", t.transpose(), " Pa is not finite"));
    return t * tributary_area_m2(mesh, faces).transpose();
}

Eigen::Matrix3Xd pressure_load(const Mesh& mesh, const Faces& faces, double pressure_Pa) {
    if (!std::isfinite(pressure_Pa)) throw LoadError(text("pressure ", pressure_Pa, " Pa is not finite"));
    Eigen::Matrix3Xd force_N = Eigen::Matrix3Xd::Zero(3, mesh.nodes_m.cols());
    for (Index f = 0; f < faces.cell.size(); ++f) {
        const auto x = [&](Index k) -> Eigen::Vector3d { return mesh.nodes_m.col(faces.corners(k, f)); };
        if (faces.corners.rows() == 3) {
            const Eigen::Vector3d area = 0.5 * (x(1) - x(0)).cross(x(2) - x(0));
            for (Index k = 0; k < 3; ++k) force_N.col(faces.corners(k, f)) -= pressure_Pa / 3.0 * area;
            continue;
        }
        for (int g = 0; g < 4; ++g) {
            const double r = 0.5 + (g % 2 == 0 ? -0.5 : 0.5) / std::numbers::sqrt3;
            const double s = 0.5 + (g / 2 == 0 ? -0.5 : 0.5) / std::numbers::sqrt3;
            const Eigen::Vector3d along_r = (1.0 - s) * (x(1) - x(0)) + s * (x(2) - x(3));
            const Eigen::Vector3d along_s = (1.0 - r) * (x(3) - x(0)) + r * (x(2) - x(1));
            const Eigen::Vector3d area = 0.25 * along_r.cross(along_s);
            const double N[4] = {(1.0 - r) * (1.0 - s), r * (1.0 - s), r * s, (1.0 - r) * s};
            for (Index k = 0; k < 4; ++k) force_N.col(faces.corners(k, f)) -= pressure_Pa * N[k] * area;
        }
    }
    return force_N;
}

double mean_displacement_m(const PressureLoad& load, const Eigen::Matrix3Xd& u_m) {
    return load.force_N.cwiseProduct(u_m).sum() / load.applied_N;
}

}  // namespace palpa::mechanics
