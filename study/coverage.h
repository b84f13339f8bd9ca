#pragma once
// How much of a tissue was palpated, and how deep: the area examined at each level of pressure, as trainers of breast
// examination report it.

#include <vector>

#include "study/score.h"

namespace palpa::study {

// Light, medium and deep palpation are the thirds of the depth up to which the tissue is known; none is no contact.
enum class PalpationLevel { none, light, medium, deep };
inline constexpr int kPalpationLevels = 4;

struct Coverage {
    double x_m = 0.0;  // lower left corner
    double y_m = 0.0;
    double cell_m = 1e-3;
    int n_x = 0;
    int n_y = 0;
    double full_depth_m = 0.0;   // the depth up to which the tissue is known
    std::vector<float> depth_m;  // n_x * n_y, greatest depth in each cell, x fastest; 0: never touched
    std::vector<bool> beyond;    // of each cell: that depth is only the one to which the tissue is known at that place
};

// Makes the grid of a tissue with its lower left corner at (x, y). Cells are 1 mm wide, and wider for tissues above 512
// mm, so that no side has more than 512.
Coverage make_coverage(double x_m, double y_m, double width_m, double height_m, double full_depth_m);

// Adds one press. It covers the cells whose centres lie within `radius_m` of (x, y) and the cell that holds (x, y).
// Allocates nothing. A depth that is not above 0, or any value that is not finite, adds nothing. beyond: the press was harder
// than the tissue is known for at this place, so that the true depth is greater.
void cover(double x_m, double y_m, double radius_m, double depth_m, Coverage& coverage, bool beyond = false);

PalpationLevel level_of(const Coverage& coverage, double depth_m);

// at_least[level]: the share of the area that was pressed at this level or deeper; at_least[none]: the share that was
// never touched.
struct CoverageShares {
    double at_least[kPalpationLevels] = {0.0, 0.0, 0.0, 0.0};
};
CoverageShares shares_of(const Coverage& coverage);

// Returns the greatest depth within `radius_m` of a place, or 0 if nothing there was touched.
double deepest_near(const Coverage& coverage, double x_m, double y_m, double radius_m);

// Returns the greatest depth on a target, or 0 if nothing of it was touched.
struct DeepestPress {
    double depth_m = 0.0;
    bool beyond = false;  // as in Coverage
};
DeepestPress deepest_on(const Coverage& coverage, const Target& target);

const char* name_of(PalpationLevel level);

}  // namespace palpa::study
