#include "stiffnessmaps/import/detect_verdicts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "files/distributions.h"
#include "files/text.h"
#include "stiffnessmaps/grid.h"

namespace palpa::stiffnessmaps {
namespace {

constexpr double kOfNormal95 = 1.645;
constexpr double kSelection = 1.5;
constexpr double kClip = 1.5;

// Returns the sum of `values` under `shape` (0 and 1) placed on every cell.
cv::Mat1d laid_everywhere(const cv::Mat1d& values, const cv::Mat1d& shape) {
    cv::Mat1d sum;
    cv::filter2D(values, sum, CV_64F, shape, cv::Point(-1, -1), 0.0, cv::BORDER_CONSTANT);
    return sum;
}

cv::Mat1d as_ones(const cv::Mat1b& mask) {
    cv::Mat1d ones;
    mask.convertTo(ones, CV_64F, 1.0 / 255.0);
    return ones;
}

// Appends the mean excess under `shape` for every position with at least 3/4 of its cells on the rest of the map and at
// least `least_on_edge` of them along the edge.
void add_means(const StiffnessGrid& grid, const cv::Mat1d& shape, const cv::Mat1b& rest, double least_on_edge,
               std::vector<double>& means) {
    const cv::Mat1d ones = as_ones(rest);
    const cv::Mat1d count = laid_everywhere(ones, shape);
    cv::Mat1d excess;
    cv::multiply(grid.excess, ones, excess);
    const cv::Mat1d sum = laid_everywhere(excess, shape);
    const cv::Mat1d on_edge = laid_everywhere(as_ones(grid.edge), shape);
    constexpr double kHair = 1e-6;
    const double least = 0.75 * cv::sum(shape)[0] - kHair;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            if (count(j, i) >= least && on_edge(j, i) >= least_on_edge - kHair)
                means.push_back(sum(j, i) / count(j, i));
        }
    }
}

// Returns the mean excess under the region's shape wherever it fits on the rest of the map; or, with `at_edge`, only
// where at least 3/4 as many of its cells lie along the edge as the region has there, with the shape turned by quarter
// turns.
std::vector<double> means_elsewhere(const StiffnessGrid& grid, const cv::Mat1b& mask, const cv::Mat1b& rest,
                                    bool at_edge) {
    cv::Mat1d shape = as_ones(mask(cv::boundingRect(mask)));
    std::vector<double> means;
    if (!at_edge) {
        add_means(grid, shape, rest, 0.0, means);
        return means;
    }
    const double along = 0.75 * cv::countNonZero(both(mask, grid.edge));
    for (int quarter = 0; quarter < 4; ++quarter) {
        add_means(grid, shape, rest, along, means);
        cv::rotate(shape, shape, cv::ROTATE_90_CLOCKWISE);
    }
    return means;
}

// Fills in noise_N_per_m, against_edge and contrast_to_noise; NaN if there is too little to compare with.
void compare_with_rest(const StiffnessGrid& grid, const cv::Mat1b& mask, const cv::Mat1b& rest, StiffRegion& region) {
    region.noise_N_per_m = region.contrast_to_noise = kMissing;
    for (const bool at_edge : {false, true}) {
        if (at_edge && !region.at_edge) continue;
        std::vector<double> means = means_elsewhere(grid, mask, rest, at_edge);
        if (means.size() < 3) continue;
        const TwoSidedSpread spread = two_sided_spread(means);
        const double noise = std::max(std::min(spread.lower, spread.upper), part_of(means, 0.95) / kOfNormal95);
        region.against_edge = at_edge && !(noise <= region.noise_N_per_m);
        region.noise_N_per_m = std::fmax(region.noise_N_per_m, noise);
    }
    if (region.noise_N_per_m > 0.0) region.contrast_to_noise = region.mean_excess_N_per_m / region.noise_N_per_m;
}

// Returns the area over which the excess is correlated: the product of its integral scales along x and y (up to the
// first zero of each autocorrelation). Regions are included: a map that a region fills has little to compare it with.
double alike_m2(const StiffnessGrid& grid, double clip_N_per_m) {
    const auto clipped = [&](int j, int i) { return std::clamp(grid.excess(j, i), -clip_N_per_m, clip_N_per_m); };
    const auto scale = [&](int a, int b, int n) {  // in cells
        double at_zero = 0.0;
        double sum = 1.0;
        for (int lag = 0; lag < n; ++lag) {
            double product = 0.0;
            double count = 0.0;
            for (int j = 0; j + b * lag < grid.n_y; ++j) {
                for (int i = 0; i + a * lag < grid.n_x; ++i) {
                    if (grid.plain(j, i) == 0 || grid.plain(j + b * lag, i + a * lag) == 0) continue;
                    product += clipped(j, i) * clipped(j + b * lag, i + a * lag);
                    count += 1.0;
                }
            }
            if (lag == 0) at_zero = product / count;
            if (lag == 0 && !(at_zero > 0.0)) break;
            if (lag > 0 && !(product > 0.0)) break;
            if (lag > 0) sum += 2.0 * product / count / at_zero;
        }
        return sum;
    };
    return scale(1, 0, grid.n_x) * grid.dx_m * scale(0, 1, grid.n_y) * grid.dy_m;
}

// Returns the contrast_to_noise that the highest of `n` independent areas exceeds once in a thousand maps, times
// kSelection, since a region is drawn around the highest cells and not placed anywhere. It is Student's t with n - 1
// degrees of freedom, as the spread comes from the same few areas (Wallace's closed form, Ann. Math. Stat. 30 (1959)
// 1121).
double needed_contrast(double n) {
    const double freedom = std::max(1.0, n - 1.0);
    const double z = -files::normal_quantile(1e-3 / n) * (8.0 * freedom + 3.0) / (8.0 * freedom + 1.0);
    return kSelection * std::sqrt(freedom * std::expm1(z * z / freedom));
}

void judge(const StiffnessGrid& grid, const cv::Mat1b& mask, const cv::Mat1b& rest, StiffRegion& region) {
    region.warnings.clear();
    compare_with_rest(grid, mask, rest, region);
    const double plain_m2 = cv::countNonZero(grid.plain) * grid.dx_m * grid.dy_m;
    region.areas = plain_m2 / std::max(alike_m2(grid, kClip * grid.spread_N_per_m), region.area_m2);
    region.needed = needed_contrast(region.areas);
    if (!(region.areas >= kLeastAreas) || std::isnan(region.noise_N_per_m)) {
        region.warnings.push_back("the map holds only " + files::short_number(region.areas) +
                                  " independent areas to tell how much the background varies (" +
                                  files::short_number(kLeastAreas) + " are needed)");
    } else if (region.noise_N_per_m > 0.0 && region.contrast_to_noise < region.needed) {
        region.warnings.push_back("stands out by only " + files::short_number(region.contrast_to_noise) +
                                  " times what areas of its size vary by " +
                                  (region.against_edge ? "at the map's edge" : "elsewhere") + " (" +
                                  files::short_number(region.needed) + " are needed in this map)");
    }
    region.sure = region.warnings.empty();
}

}  // namespace

void judge_all(const StiffnessGrid& grid, const Detection& d, std::vector<Candidate>& found) {
    const auto rest_without = [&](const auto& left_out) {
        cv::Mat1b rest = grid.plain.clone();
        for (const Candidate& c : found) {
            if (left_out(c)) rest.setTo(0, c.slopes);
        }
        return rest;
    };
    const cv::Mat1b without_all = rest_without([](const Candidate&) { return true; });
    std::vector<const Candidate*> outstanding;
    for (const Candidate& c : found) {
        if (c.region.at_edge) continue;
        StiffRegion region = c.region;
        judge(grid, c.mask, without_all, region);
        if (region.sure && region.contrast_to_noise >= 2.0 * region.needed) outstanding.push_back(&c);
    }
    const auto settled = [&](const Candidate& c) {
        return std::find(outstanding.begin(), outstanding.end(), &c) != outstanding.end();
    };
    // a region that turns out sure is no background for the others, so they are judged again
    for (std::size_t before = found.size() + 1; before != outstanding.size();) {
        before = outstanding.size();
        for (Candidate& c : found) {
            if (c.region.sure) continue;
            judge(grid, c.mask, rest_without([&](const Candidate& other) { return &other == &c || settled(other); }),
                  c.region);
        }
        for (const Candidate& c : found) {
            if (c.region.sure && !settled(c)) outstanding.push_back(&c);
        }
    }
    for (Candidate& c : found) c.region.sure = c.region.sure && d.warnings.empty();
}

}  // namespace palpa::stiffnessmaps
