#pragma once
// The energy of a bearing (device_file.h), its gradient and tangent.
//
// At a point x of a face, of area A (at rest), with the distance r of x from the bearing's axis, the penetration is
// d = R - r + shift, and the energy A phi(d) with phi' = p(d), the pressure. The shift, 0 for a penalty, is what makes a
// constraint of it: at its fixed point, shift = max(0, shift + d0) with d0 = R - r, the body touches without penetrating.

#include "mechanics/band_matrix.h"
#include "tangible/device_model.h"
#include "tangible/places.h"

namespace palpa::tangible {

// Points with their shares of the area: of faces, or of nodes. place_of: node of the file -> node of the model.
std::vector<BearingPoint> bearing_points(const Bearing& bearing, const mechanics::Mesh& mesh,
                                         const std::vector<int>& place_of);

// phi and its derivatives at a penetration.
struct Push {
    double energy_J_per_m2 = 0.0;
    double pressure_Pa = 0.0;
    double slope_Pa_per_m = 0.0;
};
Push push_of(const Bearing& bearing, double penetration_m) noexcept;

double bearing_energy_J(const Bearing& bearing, std::span<const BearingPoint> points, std::span<const double> shift_m,
                        const Places& x) noexcept;
// Adds gradient (3 x n_nodes) and, unless null, tangent of one bearing. shift_m: one per point.
void add_bearing(const Bearing& bearing, std::span<const BearingPoint> points, std::span<const double> shift_m,
                 const Places& x, Eigen::Matrix3Xd& gradient_N, mechanics::BandMatrix* K) noexcept;

// Moves the shifts of a constraint; returns the greatest change.
double move_shifts(const Bearing& bearing, std::span<const BearingPoint> points, const Places& x,
                   std::span<double> shift_m) noexcept;

}  // namespace palpa::tangible
