#pragma once
// Arrays become a map: one matrix file per depth (the form in which rolling indentation is published), one
// three-dimensional array, or one slice of stiffness or elasticity that is turned into forces at stated
// depths.

#include <filesystem>
#include <vector>

#include "stiffnessmaps/import/options.h"

namespace palpa::stiffnessmaps {

// Files whose name says tangential (or that options.tangential_x, _y name) hold the tangential force along x
// (along y where the name ends in y), positive where it opposes motion along +. Depths come from
// options.depths_m, in the files' order, or from names such as "normal_3.5mm.csv". Spacing must be stated.
// Throws InputError.
Map import_matrices(const std::vector<std::filesystem::path>& files, const ImportOptions& options,
                    ImportReport& report);

// Force of an indenter at a depth on an elastic half space of modulus E* = E / (1 - nu^2):
//   sphere    F = 4/3 E* sqrt(R) d^(3/2)   (Hertz 1881; for d well below R)
//   cylinder  F = pi/4 E* L d              (line contact, length L; Johnson, Contact Mechanics, 1985,
//   section 4.2)
double elastic_force_N(double young_Pa, double depth_m, const ImportOptions& options);

}  // namespace palpa::stiffnessmaps
