// The pressure of a finger pad on a grid of rectangles.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/disc_integral.h"
#include "mechanics/finger.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Shares = std::array<double, 4>;  // of the corners (0,0), (1,0), (1,1), (0,1)

// A rectangle, relative to the disc's middle.
struct Rectangle {
    double left = 0.0;
    double right = 0.0;
    double low = 0.0;
    double high = 0.0;
};

double square(double x) { return x * x; }

bool is_beside(const Rectangle& a, double R) {
    const double dx = std::max({a.left, -a.right, 0.0});
    const double dy = std::max({a.low, -a.high, 0.0});
    return square(dx) + square(dy) >= R * R;
}

bool is_inside(const Rectangle& a, double R) {
    return square(std::max(-a.left, a.right)) + square(std::max(-a.low, a.high)) <= R * R;
}

// Integrals of (1 - r^2/R^2) N_i over a rectangle inside the disc: degree 3 along each axis, so that two Gauss points
// along each are exact.
Shares inside_shares(const Rectangle& a, double R) {
    constexpr double kNear = 0.5 - 0.5 / std::numbers::sqrt3;
    Shares out{};
    const double area = (a.right - a.left) * (a.high - a.low);
    for (const double r : {kNear, 1.0 - kNear}) {
        for (const double s : {kNear, 1.0 - kNear}) {
            const double x = a.left + r * (a.right - a.left);
            const double y = a.low + s * (a.high - a.low);
            const double p = 0.25 * area * (1.0 - (x * x + y * y) / (R * R));
            out[0] += p * (1.0 - r) * (1.0 - s);
            out[1] += p * r * (1.0 - s);
            out[2] += p * r * s;
            out[3] += p * (1.0 - r) * s;
        }
    }
    return out;
}

// The same over the part of a rectangle inside the disc, from the moments of the pressure.
Shares rim_shares(const Rectangle& a, double R, Eigen::Matrix2Xd& corner_m) {
    corner_m << a.left, a.right, a.right, a.left, a.low, a.low, a.high, a.high;
    const DiscMoments m = disc_moments(corner_m, R);
    const double width = a.right - a.left;
    const double height = a.high - a.low;
    const double r = (m(1) - a.left * m(0)) / width;
    const double s = (m(2) - a.low * m(0)) / height;
    const double rs = (m(4) - a.low * m(1) - a.left * m(2) + a.left * a.low * m(0)) / (width * height);
    return {m(0) - r - s + rs, r - rs, rs, s - rs};
}

}  // namespace

void parabola_on_grid(const Vector2d& place_m, double diameter_m, FingerWork& work) {
    const double R = 0.5 * diameter_m;
    const GridAxis& x = work.grid.x;
    const GridAxis& y = work.grid.y;
    const int i0 = cell_of(x, place_m.x() - R);
    const int i1 = cell_of(x, place_m.x() + R);
    const int j0 = cell_of(y, place_m.y() - R);
    const int j1 = cell_of(y, place_m.y() + R);
    const int n = i1 - i0 + 2;  // nodes along x
    const int n_x = static_cast<int>(x.at_m.size());
    work.run.clear();
    for (int j = j0; j <= j1 + 1; ++j) work.run.push_back({i0 + n_x * j, n, n * (j - j0)});
    work.force_N.head(n * (j1 - j0 + 2)).setZero();
    const double Pmax = 2.0 / (std::numbers::pi * R * R);
    double sum = 0.0;
    for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i) {
            const Rectangle a{x.at_m(i) - place_m.x(), x.at_m(i + 1) - place_m.x(), y.at_m(j) - place_m.y(),
                              y.at_m(j + 1) - place_m.y()};
            if (is_beside(a, R)) continue;
            const Shares share = is_inside(a, R) ? inside_shares(a, R) : rim_shares(a, R, work.corner_m);
            const int at = n * (j - j0) + i - i0;
            work.force_N(at) += Pmax * share[0];
            work.force_N(at + 1) += Pmax * share[1];
            work.force_N(at + n + 1) += Pmax * share[2];
            work.force_N(at + n) += Pmax * share[3];
            sum += Pmax * (share[0] + share[1] + share[2] + share[3]);
        }
    }
    work.share = std::clamp(sum, 0.0, 1.0);
}

}  // namespace palpa::mechanics
