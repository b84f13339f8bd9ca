#pragma once
// Figures of maps, by gnuplot: forces in viridis (perceptually uniform, readable without colour vision), differences in
// blue to red around white, axes in mm to one scale, hatching where nothing was measured.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "stiffnessmaps/compare.h"
#include "stiffnessmaps/import/detect.h"

namespace palpa::figures {

enum class PlotWhat { all, matrices, stiffness, slice, curves, nodules };

struct PlotOptions {
    PlotWhat what = PlotWhat::all;
    std::vector<Eigen::Vector2d> at_m;  // of the curves; empty: the stiffest cell and one of middling stiffness
    std::optional<double> force_N;      // of the depth slice; empty: half of the middling force at the deepest matrix
};

// Throws InputError for another ending than .png, .svg, .pdf and for a place beside the map; std::runtime_error if gnuplot
// is missing or cannot write.
void plot_map(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection, const PlotOptions& options,
              const std::filesystem::path& file);

// Both maps at the deepest common depth, and their difference.
void plot_difference(const stiffnessmaps::MapDifference& difference, const std::filesystem::path& file);

}  // namespace palpa::figures
