#include <doctest/doctest.h>
#include <random>

#include "mechanics/face_point.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

// The least distance to points that are spread over the face, for both kinds of faces.
double least_distance_m(const Eigen::Matrix3Xd& x, const Eigen::Vector3d& place, int n) {
    double least = 1e300;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= (x.cols() == 4 ? n : n - i); ++j) {
            const double r = static_cast<double>(i) / n;
            const double s = static_cast<double>(j) / n;
            const Eigen::Vector3d p = x.cols() == 4
                                          ? Eigen::Vector3d((1 - r) * (1 - s) * x.col(0) + r * (1 - s) * x.col(1) +
                                                            r * s * x.col(2) + (1 - r) * s * x.col(3))
                                          : Eigen::Vector3d((1 - r - s) * x.col(0) + r * x.col(1) + s * x.col(2));
            least = std::min(least, (p - place).norm());
        }
    }
    return least;
}

}  // namespace

TEST_CASE("face point: beside the long edge of a triangle the nearest point lies on that edge") {
    Eigen::Matrix3Xd x(3, 3);
    x << 0, 1, 0,  //
        0, 0, 1,   //
        0, 0, 0;
    const OnFace found = nearest_on_face(x, {1.0, 1.0, 0.0});
    CHECK(found.away_m == close_to(std::sqrt(0.5)));
    CHECK(found.weight.sum() == close_to(1.0));
    CHECK((x * found.weight - Eigen::Vector3d(0.5, 0.5, 0.0)).norm() < 1e-12);
}

TEST_CASE("face point: no point of a skew triangle or parallelogram is nearer than the one found") {
    const unsigned seed = 20;
    INFO("seed ", seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto point = [&] { return Eigen::Vector3d(any(random), any(random), any(random)); };
    for (int i = 0; i < 60; ++i) {
        const bool quad = i % 2 == 0;
        Eigen::Matrix3Xd x(3, quad ? 4 : 3);
        x.col(0) = point();
        x.col(1) = point();
        x.col(2) = point();
        if (quad) x.col(3) = x.col(0) + x.col(2) - x.col(1);
        const Eigen::Vector3d place = 2.0 * point();
        const OnFace found = nearest_on_face(x, place);
        CHECK(found.weight.minCoeff() > -1e-9);
        CHECK(found.away_m == close_to((x * found.weight - place).norm()));
        CHECK(found.away_m < least_distance_m(x, place, 200) + 1e-9);
    }
}
