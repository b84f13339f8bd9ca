#include "tangible/bearings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mechanics/face_point.h"

namespace palpa::tangible {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// The middles of `count` equal parts of 0..1. What only touches part of a face is no polynomial, so that rules of higher
// order gain nothing.
double middle_of_part(int part, int count) { return (part + 0.5) / count; }

void add_points_of_quad(const Bearing& bearing, const Matrix3Xd& corner_m, const std::array<int, 4>& node,
                        std::vector<BearingPoint>& out) {
    // the first count goes along the edge that lies more across the axis
    const Vector3d first_edge = (corner_m.col(1) - corner_m.col(0)).normalized();
    const Vector3d other_edge = (corner_m.col(3) - corner_m.col(0)).normalized();
    const bool first_across = std::abs(first_edge.dot(bearing.axis)) <= std::abs(other_edge.dot(bearing.axis));
    const int n_u = bearing.points[first_across ? 0 : 1];
    const int n_v = bearing.points[first_across ? 1 : 0];
    for (int i = 0; i < n_u; ++i) {
        for (int j = 0; j < n_v; ++j) {
            const double u = middle_of_part(i, n_u);
            const double v = middle_of_part(j, n_v);
            const Vector3d du =
                (1.0 - v) * (corner_m.col(1) - corner_m.col(0)) + v * (corner_m.col(2) - corner_m.col(3));
            const Vector3d dv =
                (1.0 - u) * (corner_m.col(3) - corner_m.col(0)) + u * (corner_m.col(2) - corner_m.col(1));
            const std::array<double, 4> weight{(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v};
            out.push_back({node, weight, du.cross(dv).norm() / (n_u * n_v)});
        }
    }
}

// Six points on a triangle. Source: Strang & Fix, degree 4 (Dunavant, IJNME 21, 1985, rule 4).
void add_points_of_triangle(const Matrix3Xd& corner_m, const std::array<int, 4>& node, std::vector<BearingPoint>& out) {
    const double area_m2 =
        0.5 * Vector3d(corner_m.col(1) - corner_m.col(0)).cross(Vector3d(corner_m.col(2) - corner_m.col(0))).norm();
    constexpr std::array<std::array<double, 2>, 2> kRule{
        {{0.223381589678011, 0.445948490915965}, {0.109951743655322, 0.091576213509771}}};
    for (const auto& [share, a] : kRule) {
        for (std::size_t k = 0; k < 3; ++k) {
            std::array<double, 4> weight{a, a, a, 0.0};
            weight[k] = 1.0 - 2.0 * a;
            out.push_back({node, weight, share * area_m2});
        }
    }
}

struct Penetration {
    double depth_m = 0.0;
    double distance_m = 0.0;
    Vector3d away = Vector3d::Zero();  // unit, from the axis
};

Penetration penetration_of(const Bearing& bearing, const BearingPoint& point, const Places& x) {
    Vector3d here = Vector3d::Zero();
    for (std::size_t k = 0; k < 4; ++k) here += point.weight[k] * x(point.node[k]);
    Vector3d across = here - bearing.point_m;
    across -= across.dot(bearing.axis) * bearing.axis;
    const double distance_m = across.norm();
    // on the axis itself no direction is better than another
    const Vector3d away = distance_m > 0.0 ? Vector3d(across / distance_m) : bearing.axis.unitOrthogonal();
    return {bearing.radius_m - distance_m, distance_m, away};
}

}  // namespace

std::vector<BearingPoint> bearing_points(const Bearing& bearing, const mechanics::Mesh& mesh,
                                         const std::vector<int>& place_of) {
    std::vector<BearingPoint> out;
    const auto place = [&](int node) { return place_of[static_cast<std::size_t>(node)]; };
    if (bearing.by_nodes) {
        const Eigen::VectorXd area_m2 = mechanics::tributary_area_m2(mesh, bearing.faces);
        for (const int node : mechanics::nodes_of(bearing.faces))
            out.push_back({{place(node), place(node), place(node), place(node)}, {1.0, 0.0, 0.0, 0.0}, area_m2(node)});
        return out;
    }
    for (Index face = 0; face < bearing.faces.corners.cols(); ++face) {
        const Matrix3Xd corner_m = mechanics::corners_of_face_m(mesh, bearing.faces, face);
        const bool quad = corner_m.cols() == 4;
        std::array<int, 4> node{};
        for (Index k = 0; k < 4; ++k)
            node[static_cast<std::size_t>(k)] = place(bearing.faces.corners(quad ? k : std::min<Index>(k, 2), face));
        if (quad)
            add_points_of_quad(bearing, corner_m, node, out);
        else
            add_points_of_triangle(corner_m, node, out);
    }
    return out;
}

Push push_of(const Bearing& b, double d) noexcept {
    const double k = b.stiffness_Pa_per_m;
    const double s = b.start_m;
    if (!(d > 0.0)) return {};
    if (d < s) return {k * d * d * d / (6.0 * s), k * d * d / (2.0 * s), k * d / s};
    return {k * (0.5 * d * d - 0.5 * s * d + s * s / 6.0), k * (d - 0.5 * s), k};
}

double bearing_energy_J(const Bearing& bearing, std::span<const BearingPoint> points, std::span<const double> shift_m,
                        const Places& x) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Penetration there = penetration_of(bearing, points[i], x);
        sum += points[i].area_m2 * push_of(bearing, there.depth_m + shift_m[i]).energy_J_per_m2;
    }
    return sum;
}

void add_bearing(const Bearing& bearing, std::span<const BearingPoint> points, std::span<const double> shift_m,
                 const Places& x, Matrix3Xd& gradient_N, mechanics::BandMatrix* K) noexcept {
    const auto free_nodes = K != nullptr ? static_cast<int>(K->size() / 3) : 0;
    const Matrix3d plane = Matrix3d::Identity() - bearing.axis * bearing.axis.transpose();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const BearingPoint& point = points[i];
        const Penetration there = penetration_of(bearing, point, x);
        const Push push = push_of(bearing, there.depth_m + shift_m[i]);
        if (push.pressure_Pa == 0.0) continue;
        for (std::size_t k = 0; k < 4; ++k)
            gradient_N.col(point.node[k]) -= point.area_m2 * push.pressure_Pa * point.weight[k] * there.away;
        if (K == nullptr) continue;
        const Matrix3d across = there.away * there.away.transpose();
        const Matrix3d block = point.area_m2 * (push.slope_Pa_per_m * across -
                                                push.pressure_Pa / std::max(there.distance_m, 1e-9) * (plane - across));
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b < 4; ++b) {
                const double w = point.weight[a] * point.weight[b];
                if (w == 0.0 || point.node[a] < point.node[b] || point.node[a] >= free_nodes) continue;
                mechanics::add_block(point.node[a], point.node[b], w * block, *K);
            }
        }
    }
}

double move_shifts(const Bearing& bearing, std::span<const BearingPoint> points, const Places& x,
                   std::span<double> shift_m) noexcept {
    double most = 0.0;
    if (!bearing.constraint) return most;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double now = std::max(0.0, shift_m[i] + penetration_of(bearing, points[i], x).depth_m);
        most = std::max(most, std::abs(now - shift_m[i]));
        shift_m[i] = now;
    }
    return most;
}

}  // namespace palpa::tangible
