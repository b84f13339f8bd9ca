#include "stiffnessmaps/import/local_plane.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace palpa::stiffnessmaps {
namespace {

constexpr double kNoSpread = 1e-9;  // squared radii or layers: below it rounding makes the slope

// Squared deviations of the samples along a slope within which a cell may lie if nothing tells the noise: the value's
// error is then about twice that of one sample.
constexpr double kFarOff2 = 9.0;

// Returns the square of how many deviations of noise a slope has to stand out by, so that none that the noise made is
// followed far. `off2`: squared distance of the cell from the samples' mean along the slope, in their deviations, by
// which the slope's error grows; `free`: number of samples that the plane is not bound to, of which few may fit by chance.
// Compared on noisy planes and curves and on recordings held out in parts, 2026-11.
double needed2(double off2, double free) {
    return 12.0 * std::max(off2 - 1.0, 0.0) * (1.0 + std::pow(10.0 / free, 4.0));
}

// Means and covariances of the samples of one cell and layer.
struct Moments {
    Eigen::Vector3d c;
    Eigen::Vector3d g;
    Eigen::Matrix3d C;
    double f = 0.0;
    double force_variance = 0.0;
};

Moments moments_of(const PlaneSums& s) {
    Moments m;
    m.c = Eigen::Vector3d(s.a[1], s.a[2], s.a[3]) / s.a[0];
    m.f = s.f[0] / s.a[0];
    m.g = Eigen::Vector3d(s.f[1], s.f[2], s.f[3]) / s.a[0] - m.f * m.c;
    int k = 4;
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) m.C(i, j) = m.C(j, i) = s.a[k++] / s.a[0] - m.c(i) * m.c(j);
    }
    m.force_variance = std::max(s.force2 / s.a[0] - m.f * m.f, 0.0);
    return m;
}

}  // namespace

bool one_sided(const PlaneSums& s) {
    constexpr double kOneSided = 0.5;
    if (!(s.a[0] > 0.0)) return true;
    const double beside = std::hypot(s.a[1], s.a[2]);
    return beside > kOneSided * s.a[0] || std::abs(s.a[3]) > kOneSided * s.a[0];
}

double plane_value(const PlaneSums& s, double depth_w) {
    const Moments m = moments_of(s);
    const Eigen::Vector3d p(0.0, 0.0, m.f / (depth_w + m.c.z()));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of_C(m.C);
    const Eigen::Vector3d& spread = of_C.eigenvalues();
    const Eigen::Vector3d along_c = of_C.eigenvectors().transpose() * m.c;
    const Eigen::Vector3d along_g = of_C.eigenvectors().transpose() * m.g;
    const Eigen::Vector3d rest = along_g - spread.cwiseProduct(of_C.eigenvectors().transpose() * p);

    double unexplained = m.force_variance;
    double free = static_cast<double>(s.n) - 1.0;
    for (int k = 0; k < 3; ++k) {
        if (!(spread(k) > kNoSpread)) continue;
        unexplained -= along_g(k) * along_g(k) / spread(k);
        free -= 1.0;
    }
    const double sigma2 = free > 0.0 ? std::max(unexplained, 0.0) * static_cast<double>(s.n) / free : 0.0;
    const double samples = s.a[0] * s.a[0] / s.weight2;

    double value = m.f - p.dot(m.c);
    for (int k = 0; k < 3; ++k) {
        if (!(spread(k) > kNoSpread)) continue;
        const double off2 = along_c(k) * along_c(k) / spread(k);
        if (free <= 0.0 && off2 > kFarOff2) continue;
        const double t2 = samples * rest(k) * rest(k) / spread(k);
        const double noise2 = free > 0.0 ? needed2(off2, free) * sigma2 : 0.0;
        if (t2 <= noise2) continue;
        value -= (1.0 - noise2 / t2) * rest(k) / spread(k) * along_c(k);
    }
    return value;
}

}  // namespace palpa::stiffnessmaps
