#pragma once
// Makes a map of arrays: one matrix file per depth (the form in which rolling indentation is published), one
// three-dimensional array, or one slice of stiffness or elasticity, which is turned into forces at stated depths.

#include <filesystem>
#include <vector>

#include "stiffnessmaps/import/options.h"

namespace palpa::stiffnessmaps {

// Files with "tangential", "shear" or "ft" in their names (or that options.tangential_x, _y name) hold the tangential
// force along x (along y if the name has "tangential_y"), positive where it opposes motion along the positive axis.
// Depths come from options.depths_m, in the order of the files, or from names such as "normal_3.5mm.csv". The spacing
// must be stated. Throws InputError.
Map import_matrices(const std::vector<std::filesystem::path>& files, const ImportOptions& options,
                    ImportReport& report);

// Returns the force of an indenter at a depth on an elastic half space of modulus E* = E / (1 - nu^2), N:
//   sphere    F = 4/3 E* sqrt(R) d^(3/2)   (Hertz 1881; for d well below R)
//   cylinder  F = pi/4 E* L d              (line contact of length L; Johnson, Contact Mechanics, 1985, section 4.2)
double elastic_force_N(double young_Pa, double depth_m, const ImportOptions& options);

}  // namespace palpa::stiffnessmaps
