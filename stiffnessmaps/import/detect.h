#pragma once
// Stiff regions of a map: where they are, how large, how much stiffer than what is around them, and whether the map's
// own variation allows the claim.
//
// 1. Stiffness of each cell, stiffness.h, smoothed by a Gaussian of half the indenter's radius: the tool cannot feel
//    anything finer.
// 2. Background: a robust plane (Tukey's biweight) plus the median of the rest within a window, taken twice; a region may
//    take up to half of the window. Excess = smoothed stiffness - background.
// 3. A region grows around each local maximum whose excess reaches the threshold: the connected cells (8 neighbours)
//    above half of its peak's excess, and above the threshold. Two maxima are two regions if the excess between them
//    falls below half of the lower one's. Smaller ones than `smallest_m` are left out.
//    Threshold: the larger of 3 spreads of the excess and 3 % of the background; or a given ratio to the background.
//    Spread: (quartile - median) / 0.6745 on the side where it is less: regions widen the upper side, soft edges the
//    lower one.
// 4. Noise: the region's own shape is laid everywhere on the rest of the map, and the mean excess under it collected
//    (at least 3/4 of its cells on the rest): the variation of areas of that size and shape, whatever its correlation.
//    Its spread is taken as in 3, or from its 95th percentile / 1.645 where that is more (heavy tails). For a region at
//    the edge of what was measured, where a tool turns or leaves the tissue and the background is known from one side
//    only, the spread of the areas along the edge counts if it is more.
//    contrast_to_noise = mean excess of the region / that spread. The rest: no soft outliers (a free edge), nothing of
//    the region and its slopes, and of other regions only those that are not sure.
// 5. A region is sure if that is more than the highest of so many independent areas reaches once in a thousand maps,
//    times 1.5 (a region is drawn around the highest cells, not laid anywhere). Independent areas: the map's area by the
//    larger of the region's and that over which the excess is alike (integral scales of its autocorrelation).
//    In maps of noise alone, white or correlated over up to 7 mm, none of 420 was sure, but 3 of 300 that were at most
//    17 x 30 mm; variation that is smooth over more than half of the window cannot be told from a nodule (4 of 100 at 12 mm).
// 6. Look again: sure regions and their slopes are set aside, as they raise the background and its spread around them,
//    and steps 2 to 5 are taken with the rest, for as long as another one turns out sure. Only sure ones are added, and
//    what an earlier look found keeps its figures. A map without a sure region is not looked at again.
//
// Uses OpenCV (core, imgproc); not for the web.

#include <optional>
#include <string>
#include <vector>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

struct DetectOptions {
    std::optional<double> threshold;  // stiffness / background from which a cell counts, > 1; empty: by the rule above
    double window_m = 20e-3;          // radius of the background's median
    std::optional<double> smoothing_m;  // sigma; empty: half the indenter's radius
    std::optional<double> smallest_m;   // diameter of the disc that has the least area; empty: the indenter's radius
    std::optional<double> deepest_m;    // leaves out deeper forces
};
inline constexpr double kLeastAreas = 3.0;
inline constexpr std::size_t kLeastCells = 3;  // of a region

struct StiffRegion {
    std::string id;    // D1, D2, ..., the clearest first
    double x_m = 0.0;  // centroid, weighted by the excess
    double y_m = 0.0;
    double length_m = 0.0;  // sides of the smallest rectangle around its cells, with the cells' own size
    double width_m = 0.0;
    double angle_deg = 0.0;  // of the long side, counter-clockwise from +x, in (-90, 90]
    double area_m2 = 0.0;
    double peak_x_m = 0.0;
    double peak_y_m = 0.0;
    double peak_N_per_m = 0.0;        // smoothed stiffness at its stiffest place
    double background_N_per_m = 0.0;  // there
    double contrast = 0.0;            // peak / background; NaN where the background is not above 0
    double mean_excess_N_per_m = 0.0;
    double noise_N_per_m = 0.0;      // NaN: no area of its size fits beside it
    bool against_edge = false;       // that noise is of areas along the map's edge
    double contrast_to_noise = 0.0;  // NaN likewise
    double needed = 0.0;             // contrast_to_noise from which it would be sure
    double areas = 0.0;              // independent ones in the map
    bool at_edge = false;            // reaches unmeasured ground: its size is a lower bound
    int look = 1;                    // 2, ...: found once the sure ones of the looks before were set aside
    bool sure = false;
    std::vector<std::string> warnings;  // why it is not sure, in words
    std::vector<std::size_t> cells;
};

struct Detection {
    DetectOptions options;                  // with nothing left open but the threshold
    double threshold = 0.0;                 // stiffness / background, in the median over the map
    double spread_N_per_m = 0.0;            // of the excess of single cells
    std::vector<double> stiffness_N_per_m;  // [n_y][n_x], smoothed; NaN = not measured
    std::vector<double> background_N_per_m;
    std::vector<StiffRegion> regions;
    std::vector<std::string> warnings;  // about the map as a whole; no region is sure then
    std::size_t sure() const;
};

// Throws InputError for a map without a measured cell, and for options that cannot be; `file` names the map there.
Detection detect_regions(const Map& map, const std::string& file, const DetectOptions& options);

// The sure regions as the map keeps them: placed nodules stay, detected ones of before go. Trials ask for placed ones
// alone where there are any (scene/plan.cpp).
void keep_regions(const Detection& detection, Map& map);

}  // namespace palpa::stiffnessmaps
