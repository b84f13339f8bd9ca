#pragma once
// What the voxels of a part say against taking it for a beam: sections that a beam of one plane does not know.

#include <array>
#include <string>

#include "parts/part_file.h"

namespace palpa::parts {

// Where the beam is: from its clamp to its load along `axis`, bending along `bends` (0 x, 1 y, 2 z).
struct BeamPlace {
    int axis = 0;
    int bends = 2;
    double low_m = 0.0;
    double high_m = 0.0;
};

// Returns the first of these, "" for none. All sums are weighted by Young's modulus.
// - more than kMostOdd of the length has sections of several pieces that do not touch: they bend one by one
// - so much of it has sections turned against the plane of the load, Iyz > kMostTurned sqrt(Iyy Izz): the beam gives way
//   sideways too, 1 / (1 - Iyz^2 / (Iyy Izz)) times as far (Timoshenko, Gere, Mechanics of Materials, section 6.8)
// - the middles of the sections stray by more than kMostStray of the length, to and fro or to one side: a curved or folded bar,
//   or one with teeth, that does not bend as its sections would
// - so much of it has sections that fill less than kOpen of the box around them, with more than kMostUnlike unlike its mirror
//   image in the plane of the load: a channel or an angle is twisted unless the load passes its shear centre
// - a patch pulls further beside the sections' middle than half their width: the beam is twisted
// - the sections are wider than kPlate times the length and Poisson's ratio is above 0.2: a plate, up to
//   1 / (1 - nu^2) times as stiff
inline constexpr double kMostOdd = 0.05;
inline constexpr double kMostTurned = 0.25;
inline constexpr double kPlate = 0.6;
inline constexpr double kMostStray = 0.25;
inline constexpr double kOpen = 0.6;
inline constexpr double kMostUnlike = 0.2;
std::string section_doubt(const Part& part, const PartLoad& load, const BeamPlace& place);

}  // namespace palpa::parts
