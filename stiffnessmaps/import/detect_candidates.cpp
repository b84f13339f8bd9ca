#include "stiffnessmaps/import/detect_candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "stiffnessmaps/grid.h"

namespace palpa::stiffnessmaps {
namespace {

constexpr double kLeastShare = 0.03;  // of the background

// Returns the local maxima that reach the threshold, the highest first.
std::vector<cv::Point> maxima(const StiffnessGrid& grid, const Detection& d) {
    std::vector<cv::Point> out;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            const double here = grid.excess(j, i);
            if (grid.there(j, i) == 0 || grid.known(j, i) != 0 || here <= 0.0 || here < threshold_at(grid, d, j, i))
                continue;
            bool highest = true;
            for (int b = std::max(0, j - 1); b <= std::min(grid.n_y - 1, j + 1); ++b) {
                for (int a = std::max(0, i - 1); a <= std::min(grid.n_x - 1, i + 1); ++a) {
                    highest = highest && !(grid.there(b, a) != 0 && grid.excess(b, a) > here);
                }
            }
            if (highest) out.emplace_back(i, j);
        }
    }
    std::sort(out.begin(), out.end(),
              [&](const cv::Point& a, const cv::Point& b) { return grid.excess(a) > grid.excess(b); });
    return out;
}

// Returns the cells at or above `level` that are connected with `seed`, as a mask of 255.
cv::Mat1b hang_together(const StiffnessGrid& grid, const cv::Point& seed, double level) {
    cv::Mat1b above;
    cv::compare(grid.excess, level, above, cv::CMP_GE);
    cv::bitwise_and(above, grid.there, above);
    above.setTo(0, grid.known);
    above(seed) = 255;
    constexpr int kHere = 100;
    cv::floodFill(above, seed, kHere, nullptr, 0, 0, 8 | cv::FLOODFILL_FIXED_RANGE);
    cv::compare(above, kHere, above, cv::CMP_EQ);
    return above;
}

// Measures the smallest rectangle around the cells, in metres.
void measure_rectangle(const StiffnessGrid& grid, const cv::Mat1b& mask, StiffRegion& region) {
    std::vector<cv::Point2f> corners;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            if (mask(j, i) == 0) continue;
            for (const double a : {-0.5, 0.5}) {
                for (const double b : {-0.5, 0.5}) {  // in mm, so that float keeps four decimals
                    corners.emplace_back(static_cast<float>(1e3 * grid.dx_m * (i + a)),
                                         static_cast<float>(1e3 * grid.dy_m * (j + b)));
                }
            }
        }
    }
    const cv::RotatedRect box = cv::minAreaRect(corners);
    region.length_m = 1e-3 * static_cast<double>(std::max(box.size.width, box.size.height));
    region.width_m = 1e-3 * static_cast<double>(std::min(box.size.width, box.size.height));
    double angle = static_cast<double>(box.angle) + (box.size.width >= box.size.height ? 0.0 : 90.0);
    while (angle > 90.0) angle -= 180.0;
    while (angle <= -90.0) angle += 180.0;
    region.angle_deg = angle;
}

StiffRegion measure(const StiffnessGrid& grid, const Map& map, const cv::Mat1b& mask, const cv::Point& peak) {
    StiffRegion region;
    double weight = 0.0;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            if (mask(j, i) == 0) continue;
            region.cells.push_back(static_cast<std::size_t>(j) * map.n_x + static_cast<std::size_t>(i));
            const double e = grid.excess(j, i);
            weight += e;
            region.x_m += e * map.x_of(static_cast<std::size_t>(i));
            region.y_m += e * map.y_of(static_cast<std::size_t>(j));
        }
    }
    const auto n = static_cast<double>(region.cells.size());
    region.x_m /= weight;
    region.y_m /= weight;
    region.mean_excess_N_per_m = weight / n;
    region.area_m2 = n * grid.dx_m * grid.dy_m;
    measure_rectangle(grid, mask, region);
    region.peak_x_m = map.x_of(static_cast<std::size_t>(peak.x));
    region.peak_y_m = map.y_of(static_cast<std::size_t>(peak.y));
    region.peak_N_per_m = grid.stiffness(peak);
    region.background_N_per_m = grid.background(peak);
    region.contrast = region.background_N_per_m > 0.0 ? region.peak_N_per_m / region.background_N_per_m : kMissing;
    region.at_edge = cv::countNonZero(mask & grid.edge) > 0;
    return region;
}

// Returns the mask with a margin of `by_m`, at least one cell.
cv::Mat1b widened(const StiffnessGrid& grid, const cv::Mat1b& mask, double by_m) {
    const auto cells = [&](double pitch_m) {
        return 2 * std::max(1, static_cast<int>(std::lround(by_m / pitch_m))) + 1;
    };
    cv::Mat1b out;
    cv::dilate(mask, out, cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(cells(grid.dx_m), cells(grid.dy_m))));
    return out;
}

// Returns the region with its slopes, the cells that say nothing about the background.
cv::Mat1b with_slopes(const StiffnessGrid& grid, const Detection& d, const cv::Mat1b& mask, const cv::Point& peak) {
    const double level = std::max(0.25 * grid.excess(peak), 2.0 * grid.spread_N_per_m);
    cv::Mat1b slopes = hang_together(grid, peak, std::min(level, 0.5 * grid.excess(peak)));
    slopes |= mask;
    return widened(grid, slopes, *d.options.smoothing_m);
}

// Returns whether a region stands out on all sides: at most a quarter of the cells around it are as stiff as it is on
// average. Cells that are stiffer than their background only because the stiffness bends there (such as towards a soft
// edge) fail this.
bool stands_out(const StiffnessGrid& grid, const Detection& d, const cv::Mat1b& mask) {
    cv::Mat1b around = widened(grid, mask, 2.0 * *d.options.smoothing_m);
    around.setTo(0, mask);
    cv::bitwise_and(around, grid.there, around);
    const double mean = cv::mean(grid.stiffness, mask)[0];
    const std::vector<double> values = values_in(grid.stiffness, around);
    const auto as_stiff = std::count_if(values.begin(), values.end(), [&](double k) { return k >= mean; });
    return !values.empty() && 4 * as_stiff <= static_cast<std::ptrdiff_t>(values.size());
}

}  // namespace

double threshold_at(const StiffnessGrid& grid, const Detection& d, int j, int i) {
    const double background = grid.background(j, i);
    if (d.options.threshold) return std::max(0.0, (*d.options.threshold - 1.0) * background);
    return std::max(kSpreads * grid.spread_N_per_m, kLeastShare * background);
}

std::vector<Candidate> candidates(const StiffnessGrid& grid, const Map& map, const Detection& d) {
    const double least_m2 = 0.25 * std::numbers::pi * *d.options.smallest_m * *d.options.smallest_m;
    std::vector<Candidate> out;
    cv::Mat1b taken(grid.n_y, grid.n_x, static_cast<unsigned char>(0));
    for (const cv::Point& peak : maxima(grid, d)) {
        if (taken(peak) != 0) continue;
        const cv::Mat1b mask =
            hang_together(grid, peak, std::max(0.5 * grid.excess(peak), threshold_at(grid, d, peak.y, peak.x)));
        const bool another = cv::countNonZero(mask & taken) > 0;
        taken |= mask;
        if (another) continue;
        StiffRegion region = measure(grid, map, mask, peak);
        if (region.cells.size() < kLeastCells || region.area_m2 < least_m2 || !stands_out(grid, d, mask)) continue;
        out.push_back({mask, with_slopes(grid, d, mask, peak), region});
    }
    return out;
}

}  // namespace palpa::stiffnessmaps
