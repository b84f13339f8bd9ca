#pragma once
// Places on a regular grid, and scattered samples brought onto one.

#include <optional>
#include <string>
#include <vector>

#include "stiffnessmaps/import/options.h"

namespace palpa::stiffnessmaps {

struct GridAxis {
    double origin_m = 0.0;
    double pitch_m = 1e-3;
    std::size_t n = 1;
    double at(std::size_t i) const { return origin_m + pitch_m * static_cast<double>(i); }
};

// The regular axis that most places lie on: the pitch is the median step between places that differ, the
// origin and pitch then the best fit. `off` counts places farther than a tenth of the pitch from it. Empty if
// there is none (more than 10000 positions).
struct AxisFit {
    GridAxis axis;
    std::size_t off = 0;
};
std::optional<AxisFit> fit_axis(const std::vector<double>& places_m);

// The nearest position on the axis; empty if it is farther than a tenth of the pitch, or outside.
std::optional<std::size_t> index_on(const GridAxis& axis, double place_m);

// An axis with this pitch, centred on what the places cover.
GridAxis covering_axis(double lowest_m, double highest_m, double pitch_m);

// Median distance from a place to its nearest neighbour; 0 if there is only one.
double neighbour_distance_m(const std::vector<double>& x_m, const std::vector<double>& y_m);

// How many separate groups the places form that hold at least a twentieth of them each: places less than
// `link_m` apart are of one group. More than one: two grids in one file.
std::size_t group_count(const std::vector<double>& x_m, const std::vector<double>& y_m, double link_m);

// Forces at places and depths. The tangential forces are empty, or NaN where the motion was not along + the
// axis.
struct Samples {
    std::vector<double> x_m;
    std::vector<double> y_m;
    std::vector<double> depth_m;
    std::vector<double> force_N;
    std::vector<float> tangential_x_N;
    std::vector<float> tangential_y_N;
    std::size_t size() const { return x_m.size(); }
};

struct GridPlan {
    GridAxis x;
    GridAxis y;
    std::vector<double> depths_m;
    double radius_m = 1e-3;
    Gridding method = Gridding::plane;
    std::size_t least = 1;  // samples that a force needs
    std::size_t n_cells() const { return x.n * y.n; }
};

struct Gridded {
    std::vector<float> normal_N;  // [depth][y][x], NaN where there was nothing to draw from
    std::vector<float> tangential_x_N;
    std::vector<float> tangential_y_N;
};

// Each cell draws from the samples within `radius_m` of it and within one layer's distance of its depth, by
//   plane             local linear regression over x, y and depth, weights (1 - r^2/R^2)^2 (1 - |d - d_k|/D)
//   inverse_distance  weighted mean of force d_k/d, weights (1 - |d - d_k|/D) / (r^2 + (0.1 R)^2)
//   median            of force d_k/d over the samples that are nearest to this cell and layer
// A cell is missing where it has fewer than `least` samples, or where they lie on average more than half the
// radius away on one side, or more than half a layer deeper or shallower: nothing is extrapolated.
Gridded grid_samples(const Samples& samples, const GridPlan& plan);

// Whether --region-mm, x from, x to, y from, y to, lets a place in; without one everything is in.
bool inside_region(const std::optional<std::array<double, 4>>& region_m, double x_m, double y_m);

// Refuses a grid that no map should have.
void check_grid(const GridAxis& x, const GridAxis& y, std::size_t n_depths, const std::string& file);

}  // namespace palpa::stiffnessmaps
