#pragma once
// Finds the regular grid that places lie on, and brings scattered samples onto one.

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

// Finds the regular axis that most places lie on: its pitch is first the median step between groups of places, in which each
// is at most same_m from the next; origin and pitch are then fitted by least squares. `off` counts places farther than a
// tenth of the pitch from it. Returns nothing if there is none, or if it had more than 10000 positions.
struct AxisFit {
    GridAxis axis;
    std::size_t off = 0;
};
std::optional<AxisFit> fit_axis(const std::vector<double>& places_m, double same_m = 1e-5);

// Returns the index of the nearest position on the axis; nothing if it is farther than a tenth of the pitch, or
// outside.
std::optional<std::size_t> index_on(const GridAxis& axis, double place_m);

// Returns an axis with this pitch, centred on the extent of the places.
GridAxis covering_axis(double lowest_m, double highest_m, double pitch_m);

// Returns the median distance from a place to its nearest neighbour; 0 if there is only one place.
double neighbour_distance_m(const std::vector<double>& x_m, const std::vector<double>& y_m);

// Returns how many separate groups the places form that hold at least a twentieth of the places each. Places less than
// `link_m` apart belong to one group. More than one group means two grids in one file.
std::size_t group_count(const std::vector<double>& x_m, const std::vector<double>& y_m, double link_m);

// Forces at places and depths. The tangential forces are empty, or NaN where the tool did not move along the positive
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
    double radius_m = 1e-3;  // within which a cell takes samples
    Gridding method = Gridding::plane;
    std::size_t least = 1;  // number of samples that a force needs
    std::size_t n_cells() const { return x.n * y.n; }
};

struct Gridded {
    std::vector<float> normal_N;  // [depth][y][x], NaN = missing
    std::vector<float> tangential_x_N;
    std::vector<float> tangential_y_N;
};

// Each cell uses the samples within R = `radius_m` of it and within one layer's distance D of its depth, by
//   plane             local linear regression over x, y and depth (local_plane.h), weights
//                     (1 - r^2/R^2)^2 (1 - |d - d_k|/D)
//   inverse_distance  weighted mean of force d_k/d, weights (1 - |d - d_k|/D) / (r^2 + (0.1 R)^2)
//   median            of force d_k/d over the samples that are nearest to this cell and layer
// Nothing is extrapolated: a cell is missing if it has fewer than `least` samples. With plane and inverse_distance it
// is also missing if they lie on average more than half the radius to one side, or more than half a layer deeper or
// shallower. Tangential forces are always brought onto the grid by plane.
Gridded grid_samples(const Samples& samples, const GridPlan& plan);

// Returns whether a place lies in `region_m` (x from, x to, y from, y to, as in --region-mm); without a region every
// place does.
bool inside_region(const std::optional<std::array<double, 4>>& region_m, double x_m, double y_m);

// Throws InputError for a grid of more than 20 million forces.
void check_grid(const GridAxis& x, const GridAxis& y, std::size_t n_depths, const std::string& file);

}  // namespace palpa::stiffnessmaps
