#pragma once
// Figures of maps, by gnuplot: forces in viridis (perceptually uniform, readable for colour-blind people), differences
// in blue to red around white, both axes in mm and to the same scale, hatching where nothing was measured, or where the
// force of the depth slice is not reached.

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
    // Places of the curves; empty: the peaks of the first three regions (the stiffest cell without any), and a cell of
    // median stiffness.
    std::vector<Eigen::Vector2d> at_m;
    // Force of the depth slice; empty: half of the median force at the deepest layers.
    std::optional<double> force_N;
};

// Throws InputError for another ending than .png, .svg, .pdf, for a place off the map, and for fewer than 4 places (except
// for curves); std::runtime_error if gnuplot is missing or fails.
void plot_map(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection, const PlotOptions& options,
              const std::filesystem::path& file);

// Draws both maps at their deepest common depth, and their difference. Throws as plot_map() does.
void plot_difference(const stiffnessmaps::MapDifference& difference, const std::filesystem::path& file);

}  // namespace palpa::figures
