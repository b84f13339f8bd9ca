#pragma once
// A part as a straight beam that is clamped at one end: sections from its voxels, deflection in closed form.

#include <span>
#include <vector>

#include "mechanics/material.h"
#include "mechanics/voxels.h"

namespace palpa::mechanics {

// A layer of a section: one row of voxels square to the force, of all materials together.
//   axial: sum of E b, N/m;   shear: sum of G b, N/m   (b: width of a material in the row)
struct SectionRow {
    double low_m = 0.0;  // along the force
    double high_m = 0.0;
    double axial_N_per_m = 0.0;
    double shear_N_per_m = 0.0;
};

// Stiffness of a section against bending by a force along the rows' direction and against shear, by the transformed
// section:
//   z_n = sum E A z / sum E A,   D = sum E (I + A (z - z_n)^2)
//   1/kGA = 1/D^2 int Q^2 / (G b) dz,   Q(z) = int_z E b (z' - z_n) dz'
// The shear stiffness is that of equal energy: 5/6 G A for a rectangle of one material. The section is taken as symmetric
// about the plane of the load, and its materials as bonded.
// Source: Timoshenko, Gere, Mechanics of Materials, 2nd edition, sections 5.11 (transformed section) and 12.10 (shear by
//         energy); written for layers. Layers must be sorted and disjoint; a section without stiffness has D = 0.
struct Section {
    double axial_N = 0.0;       // sum E A
    double neutral_m = 0.0;     // z_n
    double bending_N_m2 = 0.0;  // D
    double shear_N = 0.0;       // kGA
};
Section section_of(std::span<const SectionRow> rows);

// Part of a beam with one section, from and to along the axis.
struct BeamPiece {
    double from_m = 0.0;
    double to_m = 0.0;
    Section section;
    double height_m = 0.0;  // along the force, over all that is filled
};

// Returns the pieces of a part from a plane to another along `axis` (0 x, 1 y, 2 z), for a force along `force_axis`.
// Neighbouring slices of voxels with equal sections are one piece. from_m < to_m. Throws MaterialError as cells_of() does,
// and MeshError for equal axes, for planes outside the voxels, and where the part has a gap between them.
std::vector<BeamPiece> beam_pieces(const Voxels& voxels, std::span<const Material> materials, int axis, int force_axis,
                                   double from_m, double to_m);

// Deflection and slope at the tip of a cantilever under a force F at the tip, in its direction, per newton:
//   tip = F sum [ (L - x0)^3 - (L - x1)^3 ] / (3 D)  ( + F sum (x1 - x0) / kGA )
//   slope = F sum [ (L - x0)^2 - (L - x1)^2 ] / (2 D)
// x0, x1: a piece's ends from the clamp. The terms in kGA are left out without `with_shear` (Euler-Bernoulli; with them
// Timoshenko). clamped_low: the clamp is at the first piece's end, else at the last one's. 0 pieces give 0.
struct BeamTip {
    double m_per_N = 0.0;
    double rad_per_N = 0.0;
};
BeamTip beam_tip(std::span<const BeamPiece> pieces, bool clamped_low, bool with_shear);

// Euler's load of the beam as a column: the least force at its tip, along its axis, under which it buckles (N), without
// shear. Between the clamp and the tip D y'' = -P y, y(x) = w(L) - w(x), y'(clamp) = 0, y(tip) = 0; a uniform column has
// pi^2 D / (4 L^2). Pieces must not be empty. Source: Timoshenko, Gere, Theory of Elastic Stability, 2nd edition, section
// 2.14 (a column of two sections), here for any number of them.
double euler_load_N(std::span<const BeamPiece> pieces, bool clamped_low);

// Returns the deflection per newton at a place along the axis, for a force at another place, both between the clamp and the
// free end or beyond it (m/N):
//   w(x) = int_0^min(x, a) (a - s)(x - s) / D ds  ( + min(x, a) / kGA )
// x, a: distances of the two places from the clamp; negative ones count as 0. The integrand is quadratic, for which
// Simpson's rule is exact. Both places at the tip: as beam_tip(). Source: unit load theorem, e.g. Timoshenko, Gere, Mechanics
// of Materials, section 9.3.
struct BeamPlaces {
    double load_m = 0.0;
    double at_m = 0.0;
};
double beam_deflection_m_per_N(std::span<const BeamPiece> pieces, bool clamped_low, const BeamPlaces& places,
                               bool with_shear);

}  // namespace palpa::mechanics
