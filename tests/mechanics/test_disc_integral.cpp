#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <random>

#include "mechanics/disc_integral.h"

using namespace palpa::mechanics;

namespace {

// The same by brute force: midpoints of a fine polar grid, corners tested by winding.
DiscMoments by_sampling(const Eigen::Matrix2Xd& corners, double R) {
    DiscMoments sum = DiscMoments::Zero();
    const int nr = 600;
    const int nt = 1800;
    for (int i = 0; i < nr; ++i) {
        for (int j = 0; j < nt; ++j) {
            const double r = R * (i + 0.5) / nr;
            const double t = 2.0 * std::numbers::pi * (j + 0.5) / nt;
            const Eigen::Vector2d x(r * std::cos(t), r * std::sin(t));
            bool inside = true;
            for (Eigen::Index k = 0; k < corners.cols(); ++k) {
                const Eigen::Vector2d a = corners.col(k);
                const Eigen::Vector2d b = corners.col((k + 1) % corners.cols());
                inside = inside && (b - a).x() * (x - a).y() - (b - a).y() * (x - a).x() >= 0.0;
            }
            if (!inside) continue;
            DiscMoments m;
            m << 1.0, x.x(), x.y(), x.x() * x.x(), x.x() * x.y(), x.y() * x.y();
            sum += (1.0 - r * r / (R * R)) * r * (R / nr) * (2.0 * std::numbers::pi / nt) * m;
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("disc integral: a polygon that holds the disc gives the whole") {
    const double R = 0.7;
    Eigen::Matrix2Xd square(2, 4);
    square << -1, 1, 1, -1, -1, -1, 1, 1;
    DiscMoments whole;
    whole << std::numbers::pi * R * R / 2, 0, 0, std::numbers::pi * std::pow(R, 4) / 12, 0,
        std::numbers::pi * std::pow(R, 4) / 12;
    CHECK((disc_moments(square, R) - whole).norm() < 1e-15);
    Eigen::Matrix2Xd clockwise = square.rowwise().reverse();
    CHECK((disc_moments(clockwise, R) + whole).norm() < 1e-15);
    Eigen::Matrix2Xd far = square.colwise() + Eigen::Vector2d(5.0, 1.0);
    CHECK(disc_moments(far, R).norm() < 1e-15);
}

TEST_CASE("disc integral: random triangles and quads against brute force") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    for (int trial = 0; trial < 12; ++trial) {
        Eigen::Matrix2Xd corners(2, 3);
        for (int i = 0; i < 6; ++i) corners.data()[i] = place(random);
        const Eigen::Vector2d a = corners.col(1) - corners.col(0);
        const Eigen::Vector2d b = corners.col(2) - corners.col(0);
        if (a.x() * b.y() - a.y() * b.x() < 0.0) corners.col(1).swap(corners.col(2));
        CAPTURE(trial);
        CHECK((disc_moments(corners, 0.6) - by_sampling(corners, 0.6)).norm() < 2e-4);
    }
}
