#pragma once
// The smoothed stiffness of a map's cells, and the background from which regions stand out: steps 1 and 2 of detect.h.
// Only detect*.cpp use it.

#include <opencv2/core.hpp>
#include <vector>

#include "stiffnessmaps/import/detect.h"

namespace palpa::stiffnessmaps {

inline constexpr double kOfNormal = 0.6745;  // upper quartile of a standard normal
inline constexpr double kSpreads = 3.0;      // above which a cell stands out

struct StiffnessGrid {  // all [n_y][n_x]; masks hold 0 or 255
    int n_x = 0;
    int n_y = 0;
    double dx_m = 1.0;
    double dy_m = 1.0;
    cv::Mat1b there;              // measured
    cv::Mat1b edge;               // measured, beside a cell that is not or beside the grid's border
    cv::Mat1d stiffness;          // smoothed, N/m; 0 where not measured
    cv::Mat1b known;              // in a region that an earlier look found, and left out now
    cv::Mat1d background;         // N/m
    cv::Mat1d excess;             // stiffness - background, N/m; 0 where not measured
    cv::Mat1b plain;              // measured, not known, and no soft outlier, such as a free edge
    double spread_N_per_m = 0.0;  // of the excess of plain cells
};

// Fills all but what take_background computes. `raw_N_per_m`: see stiffness.h; `options`: with all defaults filled in.
StiffnessGrid make_grid(const Map& map, const std::vector<double>& raw_N_per_m, const DetectOptions& options);

// Computes background, excess, plain cells and their spread from the cells that are measured and not known. At least
// one such cell is needed.
void take_background(const DetectOptions& options, StiffnessGrid& grid);

// The standard deviation of normal noise, estimated from each side of the median.
struct TwoSidedSpread {
    double lower = 0.0;
    double upper = 0.0;
};
TwoSidedSpread two_sided_spread(std::vector<double> values);

double part_of(std::vector<double>& values, double share);  // by QuantileType::lower; reorders `values`
std::vector<double> values_in(const cv::Mat1d& values, const cv::Mat1b& mask);
cv::Mat1b both(const cv::Mat1b& a, const cv::Mat1b& b);
cv::Mat1b without(const cv::Mat1b& mask, const cv::Mat1b& left_out);

}  // namespace palpa::stiffnessmaps
