#include "mechanics/disc_integral.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpa::mechanics {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Adds the integrals over the triangle (0, p, q) of a piece p -> q inside the disc.
void add_fan(const Vector2d& p, const Vector2d& q, double radius_m, DiscMoments& sum) {
    const double root = std::sqrt(15.0);
    const std::array<double, 2> outer{(6.0 + root) / 21.0, (6.0 - root) / 21.0};
    const std::array<double, 2> weight{(155.0 + root) / 1200.0, (155.0 - root) / 1200.0};
    const double area = 0.5 * cross(p, q);
    const auto add = [&](double of_p, double of_q, double w) {
        const Vector2d x = of_p * p + of_q * q;
        const double value = w * area * (1.0 - x.squaredNorm() / (radius_m * radius_m));
        DiscMoments m;
        m << 1.0, x.x(), x.y(), x.x() * x.x(), x.x() * x.y(), x.y() * x.y();
        sum += value * m;
    };
    add(1.0 / 3.0, 1.0 / 3.0, 9.0 / 40.0);
    for (std::size_t k = 0; k < 2; ++k) {
        const double a = outer[k];
        add(a, a, weight[k]);
        add(1.0 - 2.0 * a, a, weight[k]);
        add(a, 1.0 - 2.0 * a, weight[k]);
    }
}

// Adds the integrals over the sector of a piece p -> q outside the disc.
void add_sector(const Vector2d& p, const Vector2d& q, double R, DiscMoments& sum) {
    const double theta = std::atan2(cross(p, q), p.dot(q));
    const double t = std::atan2(p.y(), p.x());
    const double u = t + theta;
    // differences as products, so that a narrow sector loses no digits
    const double half = std::sin(0.5 * theta);
    const double middle = t + 0.5 * theta;
    const double d_sin = 2.0 * half * std::cos(middle);
    const double d_cos = -2.0 * half * std::sin(middle);
    const double d_sin2 = 2.0 * std::sin(theta) * std::cos(t + u);  // sin 2u - sin 2t
    const double d_sin_sq = std::sin(theta) * std::sin(t + u);      // sin^2 u - sin^2 t
    const double R2 = R * R;
    const double R4 = R2 * R2 / 12.0;
    DiscMoments m;
    m << 0.25 * R2 * theta, 2.0 / 15.0 * R2 * R * d_sin, -2.0 / 15.0 * R2 * R * d_cos,
        R4 * (0.5 * theta + 0.25 * d_sin2), 0.5 * R4 * d_sin_sq, R4 * (0.5 * theta - 0.25 * d_sin2);
    sum += m;
}

// Cuts the edge a -> b where it crosses the circle and adds its pieces.
void add_edge(const Vector2d& a, const Vector2d& b, double R, DiscMoments& sum) {
    // |a + s d|^2 = R^2 for s in (0, 1); the discriminant A R^2 - (a x d)^2 has no cancellation near tangency
    const Vector2d d = b - a;
    const double A = d.squaredNorm();
    if (A == 0.0) return;
    const double B = a.dot(d);
    const double C = a.squaredNorm() - R * R;
    const double chord = A * R * R - cross(a, d) * cross(a, d);
    std::array<double, 4> cut{0.0, 1.0, 1.0, 1.0};
    std::size_t last = 0;
    if (chord > 0.0) {
        const double q = -(B + std::copysign(std::sqrt(chord), B));
        std::array<double, 2> roots{q / A, q != 0.0 ? C / q : 0.0};
        std::sort(roots.begin(), roots.end());
        for (const double s : roots) {
            if (s > cut[last] && s < 1.0) cut[++last] = s;
        }
    }
    cut[++last] = 1.0;
    for (std::size_t k = 0; k < last; ++k) {
        const Vector2d p = a + cut[k] * d;
        const Vector2d q = a + cut[k + 1] * d;
        const bool inside = (0.5 * (p + q)).squaredNorm() < R * R;
        if (inside)
            add_fan(p, q, R, sum);
        else
            add_sector(p, q, R, sum);
    }
}

}  // namespace

DiscMoments disc_moments(const Eigen::Matrix2Xd& corners_m, double radius_m) {
    DiscMoments sum = DiscMoments::Zero();
    const Eigen::Index n = corners_m.cols();
    for (Eigen::Index k = 0; k < n; ++k) add_edge(corners_m.col(k), corners_m.col((k + 1) % n), radius_m, sum);
    return sum;
}

}  // namespace palpa::mechanics
