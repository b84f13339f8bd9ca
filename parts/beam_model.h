#pragma once
// A part taken for a beam: from its clamp to its load, and the spring by which the paper replaces it.

#include <string>
#include <vector>

#include "mechanics/beam.h"
#include "parts/part_file.h"

namespace palpa::parts {

struct PartBeam {
    std::vector<mechanics::BeamPiece> pieces;
    bool clamped_low = true;
    double length_m = 0.0;
    double height_m = 0.0;  // the largest
    // cosine between the load and the direction in which the beam bends; displacements along the load have its square
    double across = 1.0;
    std::string why_not;  // why the part is no beam; "" if it is one
    std::string doubt;    // why its answer cannot be trusted all the same; "" if it can
};

// The middle of the part's stretch of its axis over which the load is spread; the part must name its axis.
double load_place_m(const Part& part, const PartLoad& load);

// Beams bend in the direction of the load's largest component. The clamp is one support that holds x, y and z: a side
// square to the axis, or a box, whose side towards the load counts. place_m: along the axis, instead of load_place_m().
// Doubts a load that is oblique across the section by more than kMostOblique, and one that is spread along the beam by more
// than kMostSpread of its distance from the clamp to either side. A load spread by a share k is (1 + k^3 / 5) times as far
// from where it was as the force in its middle, on a uniform beam.
inline constexpr double kMostOblique = 0.1;
inline constexpr double kMostSpread = 0.4;
PartBeam beam_of(const Part& part, const PartLoad& load, const std::optional<double>& place_m = {});

// What the load's part along the axis says against small displacements, "" for nothing or for a part that is no beam: pressed
// by a share k of its buckling load, a beam bends 1 / (1 - k) times as far sideways, pulled 1 / (1 + k) times (Timoshenko, Gere,
// Theory of Elastic Stability, sections 1.11 and 1.12); along the load, which the tip then also follows along the axis, it is
// up to 1.9 k. Doubts k above kMostAxial if the load has another part than that along the axis, and k above kMostColumn if it presses straight.
inline constexpr double kMostAxial = 0.015;
inline constexpr double kMostColumn = 0.5;
inline constexpr double kStraight = 1e-3;  // sine of the angle between the load and the axis
std::string axial_doubt(const Part& part, const PartLoad& load);

// Stiffness of the torsion spring by which the paper replaces a beam of pieces, force over displacement at the tip, as
// the paper uses it (N/m):
//   k_i = 2 D_i / l_i^2,   gamma_i = F L / k_i,   theta = sum_i ( l_i sum_{j<=i} gamma_j ) / L,   k = F / theta
// It is wrong: k_i is a force per angle of a single clamped piece, and is used as a moment per angle of every piece; every
// piece gets the moment of the clamp. One piece gives 2/3 of the stiffness 3 D / L^3, and cutting a uniform beam into n
// equal pieces multiplies that by 2 n^2 / (n + 1).
// Source: Yang, Lian, Chen, "Haptic evaluation of multi-material parts", equations (2) to (7); for layers, where they are one
//         piece with the D of bonded layers, it equals equation (12).
double paper_spring_N_per_m(const PartBeam& beam);

}  // namespace palpa::parts
