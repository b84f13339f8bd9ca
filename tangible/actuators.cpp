#include "tangible/actuators.h"

#include <Eigen/Geometry>

namespace palpa::tangible {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using mechanics::add_block;
using mechanics::BandMatrix;

Vector3d place_of(const PathPoint& point, const Places& x) {
    if (point.node.empty()) return point.at_m;
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < point.node.size(); ++i) sum += point.weight[i] * x(point.node[i]);
    return sum;
}

Matrix3d cross_of(const Vector3d& v) {
    Matrix3d out;
    out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return out;
}

// Adds w_i w_j * block for all pairs of nodes of two points; of one point with itself each pair once.
void add_pairs(const PathPoint& p, const PathPoint& q, const Matrix3d& block, BandMatrix& K) {
    const auto free_nodes = static_cast<int>(K.size() / 3);
    const bool same = &p == &q;
    for (std::size_t i = 0; i < p.node.size(); ++i) {
        for (std::size_t j = 0; j < q.node.size(); ++j) {
            const int a = p.node[i];
            const int b = q.node[j];
            if (a >= free_nodes || b >= free_nodes || (same && a < b)) continue;
            const double w = p.weight[i] * q.weight[j];
            // a node that two points share stands in the block and in its transpose
            if (!same && a == b)
                add_block(a, b, w * (block + block.transpose()), K);
            else
                add_block(a, b, w * block, K);
        }
    }
}

// Calls visit(weight, corners) for the triangles of the faces; corners are three node numbers.
template <class Visit>
void for_each_triangle(const mechanics::Faces& faces, Visit&& visit) {
    constexpr std::array<std::array<int, 3>, 4> kOfQuad{{{0, 1, 2}, {0, 2, 3}, {1, 2, 3}, {0, 1, 3}}};
    const bool quads = faces.corners.rows() == 4;
    for (Index face = 0; face < faces.corners.cols(); ++face) {
        for (std::size_t t = 0; t < (quads ? 4U : 1U); ++t) {
            const std::array<int, 3> corners{faces.corners(kOfQuad[t][0], face), faces.corners(kOfQuad[t][1], face),
                                             faces.corners(kOfQuad[t][2], face)};
            visit(quads ? 0.5 : 1.0, corners);
        }
    }
}

// Where volumes are counted from: in the plane of an open rim, whose disc then adds nothing.
Vector3d origin_of(const SoftActuator& cavity) { return cavity.path.empty() ? Vector3d::Zero() : cavity.path[0].at_m; }

// dL/d(place of point k) of a cable.
Vector3d pull_on(const SoftActuator& cable, std::size_t k, const Places& x) {
    const Vector3d here = place_of(cable.path[k], x);
    Vector3d sum = Vector3d::Zero();
    if (k > 0) sum += (here - place_of(cable.path[k - 1], x)).normalized();
    if (k + 1 < cable.path.size()) sum += (here - place_of(cable.path[k + 1], x)).normalized();
    return sum;
}

}  // namespace

double coordinate(const SoftActuator& actuator, const Places& x) noexcept {
    double q = 0.0;
    if (actuator.kind == ActuatorKind::cable) {
        for (std::size_t k = 0; k + 1 < actuator.path.size(); ++k)
            q += (place_of(actuator.path[k], x) - place_of(actuator.path[k + 1], x)).norm();
        return q;
    }
    const Vector3d o = origin_of(actuator);
    for_each_triangle(actuator.faces, [&](double weight, const std::array<int, 3>& n) {
        const Vector3d a = x(n[0]) - o;
        const Vector3d b = x(n[1]) - o;
        const Vector3d c = x(n[2]) - o;
        q += weight / 6.0 * a.dot(b.cross(c));
    });
    return q;
}

void add_gradient(const SoftActuator& actuator, const Places& x, int free_nodes, double factor,
                  Eigen::Ref<Eigen::VectorXd> out) noexcept {
    if (actuator.kind == ActuatorKind::cable) {
        for (std::size_t k = 0; k < actuator.path.size(); ++k) {
            const PathPoint& point = actuator.path[k];
            if (point.node.empty()) continue;
            const Vector3d pull = factor * pull_on(actuator, k, x);
            for (std::size_t i = 0; i < point.node.size(); ++i) {
                if (point.node[i] < free_nodes) out.segment<3>(3 * point.node[i]) += point.weight[i] * pull;
            }
        }
        return;
    }
    const Vector3d o = origin_of(actuator);
    for_each_triangle(actuator.faces, [&](double weight, const std::array<int, 3>& n) {
        const std::array<Vector3d, 3> corner{x(n[0]) - o, x(n[1]) - o, x(n[2]) - o};
        for (std::size_t k = 0; k < 3; ++k) {
            if (n[k] < free_nodes)
                out.segment<3>(3 * n[k]) += factor * weight / 6.0 * corner[(k + 1) % 3].cross(corner[(k + 2) % 3]);
        }
    });
}

void add_hessian(const SoftActuator& actuator, const Places& x, double factor, BandMatrix& K) noexcept {
    if (actuator.kind == ActuatorKind::cable) {
        for (std::size_t k = 0; k + 1 < actuator.path.size(); ++k) {
            const PathPoint& p = actuator.path[k];
            const PathPoint& q = actuator.path[k + 1];
            const Vector3d along = place_of(p, x) - place_of(q, x);
            const double length = along.norm();
            const Vector3d t = along / length;
            const Matrix3d block = factor / length * (Matrix3d::Identity() - t * t.transpose());
            add_pairs(p, p, block, K);
            add_pairs(q, q, block, K);
            add_pairs(p, q, -block, K);
        }
        return;
    }
    const auto free_nodes = static_cast<int>(K.size() / 3);
    const Vector3d o = origin_of(actuator);
    for_each_triangle(actuator.faces, [&](double weight, const std::array<int, 3>& n) {
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = n[k];
            const int b = n[(k + 1) % 3];
            if (a >= free_nodes || b >= free_nodes) continue;
            // d(x_b x x_c)/dx_b = -[x_c]
            add_block(a, b, -factor * weight / 6.0 * cross_of(x(n[(k + 2) % 3]) - o), K);
        }
    });
}

void add_squared_gradient(const SoftActuator& cable, const Places& x, double factor, BandMatrix& K) noexcept {
    for (std::size_t k = 0; k < cable.path.size(); ++k) {
        const Vector3d here = pull_on(cable, k, x);
        add_pairs(cable.path[k], cable.path[k], factor * here * here.transpose(), K);
        for (std::size_t l = k + 1; l < cable.path.size(); ++l)
            add_pairs(cable.path[k], cable.path[l], factor * here * pull_on(cable, l, x).transpose(), K);
    }
}

std::vector<std::vector<int>> coupled_nodes(const SoftActuator& actuator, bool squared) {
    std::vector<std::vector<int>> out;
    std::vector<int> all;
    for (std::size_t k = 0; k + 1 < actuator.path.size(); ++k) {
        std::vector<int> nodes = actuator.path[k].node;
        nodes.insert(nodes.end(), actuator.path[k + 1].node.begin(), actuator.path[k + 1].node.end());
        all.insert(all.end(), nodes.begin(), nodes.end());
        out.push_back(std::move(nodes));
    }
    if (squared) out.push_back(std::move(all));
    for (Index face = 0; face < actuator.faces.corners.cols(); ++face) {
        const auto corners = actuator.faces.corners.col(face);
        out.emplace_back(corners.begin(), corners.end());
    }
    return out;
}

}  // namespace palpa::tangible
