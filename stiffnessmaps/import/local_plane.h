#pragma once
// The local linear regression that brings scattered samples onto a grid.

#include <cstddef>
#include <cstdint>

namespace palpa::stiffnessmaps {

// Sums of a weighted linear regression over (1, u, v, w): u and v in radii, w in thicknesses of the thicker of the two
// layers beside, all from the cell and layer whose force is wanted.
struct PlaneSums {
    double a[10] = {};     // upper triangle of the sum of weight b b^T
    double f[4] = {};      // sum of weight b force
    double force2 = 0.0;   // sum of weight force^2
    double weight2 = 0.0;  // sum of weight^2
    std::uint32_t n = 0;

    void add(double weight, double u, double v, double w, double force) {
        const double b[4] = {1.0, u, v, w};
        int k = 0;
        for (int i = 0; i < 4; ++i) {
            const double wb = weight * b[i];
            for (int j = i; j < 4; ++j) a[k++] += wb * b[j];
            f[i] += wb * force;
        }
        force2 += weight * force * force;
        weight2 += weight * weight;
        ++n;
    }
};

// Returns whether the samples lie on average more than half a radius or half a layer to one side, so that a value at
// the cell would be extrapolated; also if there are none.
bool one_sided(const PlaneSums& sums);

// Value at u = v = w = 0 of the plane through the samples, newtons.
//
//   F = f - s . c,    s = p + sum_k  q_k ((g - C p) . e_k / l_k) e_k,    q_k = max(0, 1 - (a_k sigma / t_k)^2)
//
// f, c: weighted means of the force and of (u, v, w); C: covariance of (u, v, w), with eigenvalues l_k and eigenvectors
// e_k; g: covariance of (u, v, w) with the force; t_k = |g - C p|_k sqrt(m / l_k) with m = (sum W)^2 / sum W^2 samples;
// sigma: deviation of the samples from the plane of least squares; a_k: needed2() in the source.
//
// So a plane without noise comes back exactly. A slope that noise alone may have made, and along which the cell is more
// than a deviation off the samples' mean, gives way to p, and so does a direction in which the samples do not differ:
// no slope over the place, and a force in proportion to depth. Samples that are no more than the plane has slopes and
// one tell no sigma; then q_k is 1 if the cell lies within three deviations of their mean along e_k, else 0.
// depth_w: depth of the layer in units of w.
double plane_value(const PlaneSums& sums, double depth_w);

}  // namespace palpa::stiffnessmaps
