#pragma once
// How much of a tissue was palpated, and how deep: area examined per pressure level, as trainers of breast
// examination report it.

#include <vector>

namespace palpa::study {

// Thirds of the depth that the tissue is known for: light, medium and deep palpation.
enum class PalpationLevel { none, light, medium, deep };
inline constexpr int kPalpationLevels = 4;

struct Coverage {
    double x_m = 0.0;  // lower left corner
    double y_m = 0.0;
    double cell_m = 1e-3;
    int n_x = 0;
    int n_y = 0;
    double full_depth_m = 0.0;
    std::vector<float> depth_m;  // deepest press of each cell, x fastest; 0: never touched
};

// Throws nothing for sizes up to 1 m; larger sizes get larger cells (at most 512 a side).
Coverage make_coverage(double x_m, double y_m, double width_m, double height_m, double full_depth_m);

// Adds one press: it covers all cells whose centres lie within `radius_m` of (x, y), and the cell that holds (x, y).
// Allocates nothing.
void cover(double x_m, double y_m, double radius_m, double depth_m, Coverage& coverage);

PalpationLevel level_of(const Coverage& coverage, double depth_m);

// Share of the area that reached each level or a deeper one; [none] is the share that was never touched.
struct CoverageShares {
    double at_least[kPalpationLevels] = {0.0, 0.0, 0.0, 0.0};
};
CoverageShares shares_of(const Coverage& coverage);

// Deepest press within `radius_m` of a place; 0 if nothing there was touched.
double deepest_near(const Coverage& coverage, double x_m, double y_m, double radius_m);

const char* name_of(PalpationLevel level);

}  // namespace palpa::study
