#pragma once
// Stiff regions of a map: where they are, how large, how much stiffer than their surroundings, and whether the map's
// own variation allows the claim.
//
// 1. Stiffness of each cell (stiffness.h), smoothed by a Gaussian of half the indenter's radius: the tool cannot feel
//    anything finer.
// 2. Background: a robust plane (Tukey's biweight) plus the median of the residuals within a window. The median is
//    computed three times; cells that are softer than the background by 3 spreads are left out from the next time on.
//    A region may cover up to half of the window. Excess = smoothed stiffness - background.
// 3. A region grows around each local maximum whose excess reaches the threshold: the connected cells (8 neighbours)
//    above half of its peak's excess, and above the threshold. Two maxima are two regions if the excess between them
//    falls below half of the lower one's. Left out are regions smaller than `smallest_m` or than kLeastCells cells, and
//    those around which more than a quarter of the cells are as stiff as the region on average.
//    Threshold: the larger of 3 spreads of the excess and 3 % of the background; or a given ratio to the background.
//    Spread: (quartile - median) / 0.6745 on the side where it is less: regions widen the upper side, soft edges the
//    lower one.
// 4. Noise: the region's own shape is placed everywhere on the rest of the map (at least 3/4 of its cells on the rest),
//    and the mean excess under it is collected: the variation of areas of that size and shape, whatever its
//    correlation. The noise is the spread of these means as in 3, or their 95th percentile / 1.645 if that is more
//    (heavy tails). For a region at the edge of what was measured, where a tool turns or leaves the tissue and the
//    background is known from one side only, the noise of areas along the edge counts if it is more.
//    contrast_to_noise = mean excess of the region / noise. The rest of the map leaves out soft outliers (a free edge),
//    the region with its slopes, and the other regions that are sure.
// 5. A region is sure if its contrast_to_noise is above 1.5 times the value that the highest of so many independent
//    areas exceeds once in a thousand maps (1.5, since a region is drawn around the highest cells, not placed
//    anywhere).
//    Number of independent areas: the map's area divided by the region's area, or by the area over which the excess is
//    correlated (integral scales of its autocorrelation) if that is larger.
//    In maps of noise alone, white or correlated over up to 7 mm, no region was sure in 420 maps, but in 3 of 300 maps
//    of at most 17 x 30 mm; variation that is smooth over more than half of the window cannot be told from a nodule (4
//    of 100 maps at 12 mm).
// 6. Further looks: sure regions and their slopes are set aside, as they raise the background and the spread around
//    them, and steps 2 to 5 are repeated on the rest, as long as another region turns out sure (five looks at most).
//    Only sure regions are added, and what an earlier look found keeps its values. A map without a sure region is not
//    searched again.
//
// Uses OpenCV (core, imgproc); not for the web.

#include <optional>
#include <string>
#include <vector>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

struct DetectOptions {
    std::optional<double> threshold;    // stiffness / background from which a cell counts, > 1; empty: as in step 3
    double window_m = 20e-3;            // radius of the background's median
    std::optional<double> smoothing_m;  // sigma; empty: half the indenter's radius
    std::optional<double> smallest_m;   // diameter of the smallest disc that counts; empty: the indenter's radius
    std::optional<double> deepest_m;    // forces at greater depths are left out; empty: none
};
inline constexpr double kLeastAreas = 3.0;     // independent areas that a verdict needs
inline constexpr std::size_t kLeastCells = 3;  // that a region needs

struct StiffRegion {
    std::string id;    // D1, D2, ..., the clearest first
    double x_m = 0.0;  // centroid, weighted by the excess
    double y_m = 0.0;
    double length_m = 0.0;  // sides of the smallest rectangle around its cells
    double width_m = 0.0;
    double angle_deg = 0.0;  // of the long side, counter-clockwise from +x, in (-90, 90]
    double area_m2 = 0.0;
    double peak_x_m = 0.0;
    double peak_y_m = 0.0;
    double peak_N_per_m = 0.0;        // smoothed stiffness where it is greatest
    double background_N_per_m = 0.0;  // at the same place
    double contrast = 0.0;            // peak / background; NaN if the background is not above 0
    double mean_excess_N_per_m = 0.0;
    double noise_N_per_m = 0.0;      // NaN: the rest of the map has no room for areas of its size
    bool against_edge = false;       // the noise is that of areas along the map's edge
    double contrast_to_noise = 0.0;  // NaN without noise_N_per_m
    double needed = 0.0;             // contrast_to_noise that a sure region needs
    double areas = 0.0;              // number of independent areas in the map
    bool at_edge = false;            // reaches unmeasured cells, so its size is a lower bound
    int look = 1;                    // 2 and up: found with the sure regions of earlier looks set aside
    bool sure = false;
    std::vector<std::string> warnings;  // why it is not sure, in words
    std::vector<std::size_t> cells;     // indices into the map, row-major
};

struct Detection {
    DetectOptions options;                  // with all defaults filled in but the threshold
    double threshold = 0.0;                 // stiffness / background, median over the map
    double spread_N_per_m = 0.0;            // of the excess of single cells
    std::vector<double> stiffness_N_per_m;  // [n_y][n_x], smoothed; NaN = not measured
    std::vector<double> background_N_per_m;
    std::vector<StiffRegion> regions;
    std::vector<std::string> warnings;  // about the whole map; if there are any, no region is sure
    std::size_t sure() const;
};

// Throws InputError for a map without a measured cell and for impossible options; `file` names the map in the message.
Detection detect_regions(const Map& map, const std::string& file, const DetectOptions& options);

// Stores the sure regions as detected nodules of the map, in place of earlier detected ones; placed nodules stay. If a
// map has placed nodules, trials ask for those alone (scene/plan.cpp).
void keep_regions(const Detection& detection, Map& map);

}  // namespace palpa::stiffnessmaps
