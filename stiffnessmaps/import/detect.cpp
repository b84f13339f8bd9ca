#include "stiffnessmaps/import/detect.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "files/input_error.h"
#include "files/text.h"
#include "stiffnessmaps/stiffness.h"

namespace palpa {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kOfNormal = 0.6745;      // upper quartile of a standard normal
constexpr double kOfNormal95 = 1.645;
constexpr double kSpreads = 3.0;
constexpr double kSelection = 1.5;
constexpr double kClip = 1.5;
constexpr double kLeastShare = 0.03;      // of the background
constexpr std::ptrdiff_t kFewCells = 30;     // fewer cannot tell a background from a region

struct Grid {
    int n_x = 0;
    int n_y = 0;
    double dx_m = 1.0;
    double dy_m = 1.0;
    cv::Mat1b there;       // 255: measured
    cv::Mat1d stiffness;   // smoothed, N/m; 0 where not measured
    cv::Mat1d background;
    cv::Mat1d excess;      // 0 where not measured
    cv::Mat1b plain;       // 255: measured and no soft outlier, such as ground beside the tissue's free edge
};

double quantile(std::vector<double>& values, double q) {
    const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

// Spread of normal noise from each side of the median.
struct Spread {
    double lower = 0.0;
    double upper = 0.0;
};
Spread spread_of(std::vector<double> values) {
    const double middle = quantile(values, 0.5);
    return {(middle - quantile(values, 0.25)) / kOfNormal, (quantile(values, 0.75) - middle) / kOfNormal};
}

std::vector<double> values_in(const cv::Mat1d& values, const cv::Mat1b& mask) {
    std::vector<double> out;
    for (int j = 0; j < values.rows; ++j) {
        for (int i = 0; i < values.cols; ++i) {
            if (mask(j, i) != 0) out.push_back(values(j, i));
        }
    }
    return out;
}

// Gaussian, normalised over the cells that are there.
cv::Mat1d smoothed(const cv::Mat1d& values, const cv::Mat1b& there, double sigma_x, double sigma_y) {
    cv::Mat1d weight(values.size(), 0.0);
    weight.setTo(1.0, there);
    cv::Mat1d sum = values.clone();
    sum.setTo(0.0, there == 0);
    if (sigma_x > 0.0 && sigma_y > 0.0) {
        cv::GaussianBlur(sum, sum, cv::Size(), sigma_x, sigma_y, cv::BORDER_CONSTANT);
        cv::GaussianBlur(weight, weight, cv::Size(), sigma_x, sigma_y, cv::BORDER_CONSTANT);
    }
    for (int j = 0; j < values.rows; ++j) {
        for (int i = 0; i < values.cols; ++i) sum(j, i) = there(j, i) != 0 ? sum(j, i) / weight(j, i) : 0.0;
    }
    return sum;
}

// z = a + b u + c v over the measured cells by iteratively reweighted least squares, Tukey's biweight at 4.685 spreads
// (95 % efficient for normal noise). u and v: cells from the middle of the grid, in halves of its size.
cv::Mat1d robust_plane(const Grid& grid) {
    const auto u_of = [&](int i) { return (2.0 * i - (grid.n_x - 1)) / std::max(1, grid.n_x); };
    const auto v_of = [&](int j) { return (2.0 * j - (grid.n_y - 1)) / std::max(1, grid.n_y); };
    Eigen::Vector3d plane(median_of(values_in(grid.stiffness, grid.there)), 0.0, 0.0);
    for (int round = 0; round < 20; ++round) {
        std::vector<double> off;
        for (int j = 0; j < grid.n_y; ++j) {
            for (int i = 0; i < grid.n_x; ++i) {
                if (grid.there(j, i) != 0) off.push_back(std::abs(grid.stiffness(j, i) - plane.dot(Eigen::Vector3d(1.0, u_of(i), v_of(j)))));
            }
        }
        const double reach = 4.685 * median_of(off) / kOfNormal;
        if (!(reach > 0.0)) break;
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        for (int j = 0; j < grid.n_y; ++j) {
            for (int i = 0; i < grid.n_x; ++i) {
                if (grid.there(j, i) == 0) continue;
                const Eigen::Vector3d p(1.0, u_of(i), v_of(j));
                const double e = (grid.stiffness(j, i) - plane.dot(p)) / reach;
                if (std::abs(e) >= 1.0) continue;
                const double w = (1.0 - e * e) * (1.0 - e * e);
                normal += w * p * p.transpose();
                right += w * grid.stiffness(j, i) * p;
            }
        }
        // least norm, so that a single row of cells has a plane too
        plane = normal.completeOrthogonalDecomposition().solve(right);
    }
    cv::Mat1d out(grid.n_y, grid.n_x);
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) out(j, i) = plane.dot(Eigen::Vector3d(1.0, u_of(i), v_of(j)));
    }
    return out;
}

// Median of the measured cells within a disc. Fine grids are read in strides, so that the disc is at most some 40 wide.
cv::Mat1d window_median(const cv::Mat1d& values, const Grid& grid, double radius_m) {
    const auto reach = [&](double pitch_m, int n) { return static_cast<int>(std::min(radius_m / pitch_m, static_cast<double>(n))); };
    const int reach_x = reach(grid.dx_m, grid.n_x);
    const int reach_y = reach(grid.dy_m, grid.n_y);
    const int stride_x = std::max(1, reach_x / 20);
    const int stride_y = std::max(1, reach_y / 20);
    cv::Mat1d out(grid.n_y, grid.n_x, 0.0);
    std::vector<double> window;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            if (grid.there(j, i) == 0) continue;
            window.clear();
            for (int b = j - reach_y / stride_y * stride_y; b <= j + reach_y; b += stride_y) {
                for (int a = i - reach_x / stride_x * stride_x; a <= i + reach_x; a += stride_x) {
                    if (b < 0 || b >= grid.n_y || a < 0 || a >= grid.n_x || grid.plain(b, a) == 0) continue;
                    if (std::hypot((a - i) * grid.dx_m, (b - j) * grid.dy_m) <= radius_m) window.push_back(values(b, a));
                }
            }
            out(j, i) = window.empty() ? values(j, i) : quantile(window, 0.5);
        }
    }
    return out;
}

double cell_spread_N_per_m(const Grid& grid) {
    const Spread spread = spread_of(values_in(grid.excess, grid.plain));
    return std::min(spread.lower, spread.upper);
}

Grid make_grid(const Map& map, const std::vector<double>& raw, const DetectOptions& options) {
    Grid grid;
    grid.n_x = static_cast<int>(map.n_x);
    grid.n_y = static_cast<int>(map.n_y);
    grid.dx_m = map.spacing_m[0];
    grid.dy_m = map.spacing_m[1];
    cv::Mat1d stiffness(grid.n_y, grid.n_x, 0.0);
    grid.there = cv::Mat1b(grid.n_y, grid.n_x, static_cast<unsigned char>(0));
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            const double k = raw[static_cast<std::size_t>(j) * map.n_x + static_cast<std::size_t>(i)];
            if (std::isnan(k)) continue;
            stiffness(j, i) = k;
            grid.there(j, i) = 255;
        }
    }
    const double sigma_m = *options.smoothing_m;
    grid.stiffness = smoothed(stiffness, grid.there, sigma_m / grid.dx_m, sigma_m / grid.dy_m);
    const cv::Mat1d plane = robust_plane(grid);
    cv::Mat1d rest;
    cv::subtract(grid.stiffness, plane, rest);
    cv::Mat1b missing;
    cv::compare(grid.there, 0, missing, cv::CMP_EQ);
    grid.plain = grid.there.clone();
    for (int pass = 0; pass < 3; ++pass) {  // soft outliers leave the windows, as a free edge would pull them down for a window's width
        cv::add(plane, window_median(rest, grid, options.window_m), grid.background);
        cv::subtract(grid.stiffness, grid.background, grid.excess);
        grid.excess.setTo(0.0, missing);
        cv::Mat1b soft;
        cv::compare(grid.excess, -kSpreads * cell_spread_N_per_m(grid), soft, cv::CMP_LT);
        grid.plain.setTo(0, soft);
    }
    return grid;
}

// Excess from which a cell counts.
double threshold_at(const Grid& grid, const Detection& d, int j, int i) {
    const double background = grid.background(j, i);
    if (d.options.threshold) return std::max(0.0, (*d.options.threshold - 1.0) * background);
    return std::max(kSpreads * d.spread_N_per_m, kLeastShare * background);
}

// Local maxima that reach the threshold, the highest first.
std::vector<cv::Point> maxima(const Grid& grid, const Detection& d) {
    std::vector<cv::Point> out;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            const double here = grid.excess(j, i);
            if (grid.there(j, i) == 0 || here <= 0.0 || here < threshold_at(grid, d, j, i)) continue;
            bool highest = true;
            for (int b = std::max(0, j - 1); b <= std::min(grid.n_y - 1, j + 1); ++b) {
                for (int a = std::max(0, i - 1); a <= std::min(grid.n_x - 1, i + 1); ++a) {
                    highest = highest && !(grid.there(b, a) != 0 && grid.excess(b, a) > here);
                }
            }
            if (highest) out.emplace_back(i, j);
        }
    }
    std::sort(out.begin(), out.end(), [&](const cv::Point& a, const cv::Point& b) { return grid.excess(a) > grid.excess(b); });
    return out;
}

// The cells at or above `level` that hang together with `seed`, as a mask of 255.
cv::Mat1b hang_together(const Grid& grid, const cv::Point& seed, double level) {
    cv::Mat1b above;
    cv::compare(grid.excess, level, above, cv::CMP_GE);
    cv::bitwise_and(above, grid.there, above);
    above(seed) = 255;
    constexpr int kHere = 100;
    cv::floodFill(above, seed, kHere, nullptr, 0, 0, 8 | cv::FLOODFILL_FIXED_RANGE);
    cv::compare(above, kHere, above, cv::CMP_EQ);
    return above;
}

bool reaches_edge(const Grid& grid, const cv::Mat1b& mask) {
    cv::Mat1b missing;
    cv::copyMakeBorder(grid.there == 0, missing, 1, 1, 1, 1, cv::BORDER_CONSTANT, 255);
    cv::dilate(missing, missing, cv::Mat::ones(3, 3, CV_8U));
    return cv::countNonZero(missing(cv::Rect(1, 1, grid.n_x, grid.n_y)) & mask) > 0;
}

// Smallest rectangle around the cells, in metres.
void measure_rectangle(const Grid& grid, const cv::Mat1b& mask, StiffRegion& region) {
    std::vector<cv::Point2f> corners;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            if (mask(j, i) == 0) continue;
            for (const double a : {-0.5, 0.5}) {
                for (const double b : {-0.5, 0.5}) {  // mm, so that float keeps four digits behind the point
                    corners.emplace_back(static_cast<float>(1e3 * grid.dx_m * (i + a)), static_cast<float>(1e3 * grid.dy_m * (j + b)));
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

StiffRegion measure(const Grid& grid, const Map& map, const cv::Mat1b& mask, const cv::Point& peak) {
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
    region.contrast = region.background_N_per_m > 0.0 ? region.peak_N_per_m / region.background_N_per_m : kNaN;
    region.at_edge = reaches_edge(grid, mask);
    return region;
}

// With a margin, at least one cell.
cv::Mat1b widened(const Grid& grid, const cv::Mat1b& mask, double by_m) {
    const auto cells = [&](double pitch_m) { return 2 * std::max(1, static_cast<int>(std::lround(by_m / pitch_m))) + 1; };
    cv::Mat1b out;
    cv::dilate(mask, out, cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(cells(grid.dx_m), cells(grid.dy_m))));
    return out;
}

// Mean excess under the region's shape wherever it fits on the rest of the map.
std::vector<double> means_elsewhere(const Grid& grid, const cv::Mat1b& mask, const cv::Mat1b& rest) {
    cv::Mat1d shape;
    mask(cv::boundingRect(mask)).convertTo(shape, CV_64F, 1.0 / 255.0);
    cv::Mat1d ones;
    rest.convertTo(ones, CV_64F, 1.0 / 255.0);
    cv::Mat1d count;
    cv::Mat1d sum;
    cv::filter2D(ones, count, CV_64F, shape, cv::Point(-1, -1), 0.0, cv::BORDER_CONSTANT);
    cv::filter2D(grid.excess.mul(ones), sum, CV_64F, shape, cv::Point(-1, -1), 0.0, cv::BORDER_CONSTANT);
    const double least = 0.75 * cv::sum(shape)[0] - 1e-6;
    std::vector<double> means;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            if (count(j, i) >= least) means.push_back(sum(j, i) / count(j, i));
        }
    }
    return means;
}

// Fills in noise_N_per_m, contrast_to_noise and areas; NaN where nothing can be said.
void compare_with_rest(const Grid& grid, const cv::Mat1b& mask, const cv::Mat1b& rest, StiffRegion& region) {
    std::vector<double> means = means_elsewhere(grid, mask, rest);
    region.noise_N_per_m = region.contrast_to_noise = kNaN;
    if (means.size() < 3) return;
    const Spread spread = spread_of(means);
    region.noise_N_per_m = std::max(std::min(spread.lower, spread.upper), quantile(means, 0.95) / kOfNormal95);
    if (region.noise_N_per_m > 0.0) region.contrast_to_noise = region.mean_excess_N_per_m / region.noise_N_per_m;
}

// What belongs to a region and its slopes, and says nothing about the background.
cv::Mat1b with_slopes(const Grid& grid, const Detection& d, const cv::Mat1b& mask, const cv::Point& peak) {
    const double level = std::max(0.25 * grid.excess(peak), 2.0 * d.spread_N_per_m);
    cv::Mat1b slopes = hang_together(grid, peak, std::min(level, 0.5 * grid.excess(peak)));
    slopes |= mask;
    return widened(grid, slopes, *d.options.smoothing_m);
}

// Whether it stands out on all sides: at most a quarter of the cells around it may be as stiff as it is on average. What
// is stiffer than its background only because the ground bends (towards a soft edge, say) fails this.
bool stands_out(const Grid& grid, const Detection& d, const cv::Mat1b& mask) {
    cv::Mat1b around = widened(grid, mask, 2.0 * *d.options.smoothing_m);
    around.setTo(0, mask);
    cv::bitwise_and(around, grid.there, around);
    const double mean = cv::mean(grid.stiffness, mask)[0];
    const std::vector<double> values = values_in(grid.stiffness, around);
    const auto as_stiff = std::count_if(values.begin(), values.end(), [&](double k) { return k >= mean; });
    return !values.empty() && 4 * as_stiff <= static_cast<std::ptrdiff_t>(values.size());
}

struct Candidate {
    cv::Mat1b mask;
    cv::Mat1b slopes;
    StiffRegion region;
};

std::vector<Candidate> candidates(const Grid& grid, const Map& map, const Detection& d) {
    const double least_m2 = 0.25 * std::numbers::pi * *d.options.smallest_m * *d.options.smallest_m;
    std::vector<Candidate> out;
    cv::Mat1b taken(grid.n_y, grid.n_x, static_cast<unsigned char>(0));
    for (const cv::Point& peak : maxima(grid, d)) {
        if (taken(peak) != 0) continue;
        const cv::Mat1b mask = hang_together(grid, peak, std::max(0.5 * grid.excess(peak), threshold_at(grid, d, peak.y, peak.x)));
        const bool another = cv::countNonZero(mask & taken) > 0;
        taken |= mask;
        if (another) continue;
        StiffRegion region = measure(grid, map, mask, peak);
        if (region.cells.size() < kLeastCells || region.area_m2 < least_m2 || !stands_out(grid, d, mask)) continue;
        out.push_back({mask, with_slopes(grid, d, mask, peak), region});
    }
    return out;
}

// Area over which the excess is alike: product of its integral scales along x and y (to the first zero of each
// autocorrelation). The regions are part of it: in a map that a region fills there is little to compare with.
double alike_m2(const Grid& grid, double clip_N_per_m) {
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

// The value that a standard normal exceeds with a probability.
double normal_above(double probability) {
    double low = 0.0;
    double high = 40.0;
    for (int k = 0; k < 100; ++k) {
        const double z = 0.5 * (low + high);
        (0.5 * std::erfc(z / std::numbers::sqrt2) > probability ? low : high) = z;
    }
    return low;
}

// contrast_to_noise that the highest of `n` independent areas exceeds once in a thousand maps: Student's t with n - 1
// degrees of freedom, as the spread comes from the same few areas (Wallace's closed form, Ann. Math. Stat. 30 (1959)
// 1121), times what it gains as a region is drawn around the highest cells and not laid anywhere.
double needed_contrast(double n) {
    const double freedom = std::max(1.0, n - 1.0);
    const double z = normal_above(1e-3 / n) * (8.0 * freedom + 3.0) / (8.0 * freedom + 1.0);
    return kSelection * std::sqrt(freedom * std::expm1(z * z / freedom));
}

void judge(const Grid& grid, const Detection& d, const cv::Mat1b& mask, const cv::Mat1b& rest, StiffRegion& region) {
    region.warnings.clear();
    compare_with_rest(grid, mask, rest, region);
    const double plain_m2 = cv::countNonZero(grid.plain) * grid.dx_m * grid.dy_m;
    region.areas = plain_m2 / std::max(alike_m2(grid, kClip * d.spread_N_per_m), region.area_m2);
    region.needed = needed_contrast(region.areas);
    if (!(region.areas >= kLeastAreas) || std::isnan(region.noise_N_per_m)) {
        region.warnings.push_back("the map holds only " + short_number(region.areas) +
                                  " independent areas to tell how much the background varies (" + short_number(kLeastAreas) + " are needed)");
    } else if (region.noise_N_per_m > 0.0 && region.contrast_to_noise < region.needed) {
        region.warnings.push_back("stands out by only " + short_number(region.contrast_to_noise) + " times what areas of its size vary by elsewhere (" +
                                  short_number(region.needed) + " are needed in this map)");
    }
    region.sure = region.warnings.empty();
}

// Several nodules must not hide each other, and lumps of one kind of tissue must not lend each other credit: what stands
// out twice as far as is needed, with all candidates left out of the rest, is no background for the others; every other
// candidate is.
void judge_all(const Grid& grid, const Detection& d, std::vector<Candidate>& found) {
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
        StiffRegion region = c.region;
        judge(grid, d, c.mask, without_all, region);
        if (region.sure && region.contrast_to_noise >= 2.0 * region.needed) outstanding.push_back(&c);
    }
    const auto settled = [&](const Candidate& c) { return std::find(outstanding.begin(), outstanding.end(), &c) != outstanding.end(); };
    for (std::size_t before = found.size() + 1; before != outstanding.size();) {  // what turns out sure is no background either
        before = outstanding.size();
        for (Candidate& c : found) {
            if (c.region.sure) continue;
            judge(grid, d, c.mask, rest_without([&](const Candidate& other) { return &other == &c || settled(other); }), c.region);
        }
        for (const Candidate& c : found) {
            if (c.region.sure && !settled(c)) outstanding.push_back(&c);
        }
    }
    for (Candidate& c : found) c.region.sure = c.region.sure && d.warnings.empty();
}

void check_options(const DetectOptions& o) {
    const auto refuse = [](const char* name, double value, const char* expected) {
        throw bad_input("detect", name, short_number(value), expected);
    };
    if (o.threshold && !(*o.threshold > 1.0 && *o.threshold <= 1e6)) refuse("threshold", *o.threshold, "a ratio above 1");
    if (!(o.window_m > 0.0 && o.window_m <= 1e3)) refuse("window", o.window_m, "a radius above 0");
    if (o.smoothing_m && !(*o.smoothing_m >= 0.0 && *o.smoothing_m <= 1.0)) refuse("smoothing", *o.smoothing_m, "0 to 1000 mm");
    if (o.smallest_m && !(*o.smallest_m >= 0.0 && *o.smallest_m <= 1e3)) refuse("smallest", *o.smallest_m, "at least 0");
}

}  // namespace

std::size_t Detection::sure() const {
    return static_cast<std::size_t>(std::count_if(regions.begin(), regions.end(), [](const StiffRegion& r) { return r.sure; }));
}

Detection detect_regions(const Map& map, const std::string& file, const DetectOptions& options) {
    check_options(options);
    Detection d;
    d.options = options;
    d.options.smoothing_m = options.smoothing_m.value_or(0.5 * map.indenter_radius_m);
    d.options.smallest_m = options.smallest_m.value_or(map.indenter_radius_m);
    d.options.deepest_m = options.deepest_m.value_or(map.depths_m.back());
    const std::vector<double> raw = stiffness_N_per_m(map, *d.options.deepest_m);
    const auto measured = std::count_if(raw.begin(), raw.end(), [](double k) { return !std::isnan(k); });
    if (measured == 0) {
        throw bad_input(file, "", "no cell with a force down to " + short_number(1e3 * *d.options.deepest_m) + " mm", "at least one");
    }
    const Grid grid = make_grid(map, raw, d.options);
    d.spread_N_per_m = cell_spread_N_per_m(grid);
    cv::Mat1d ratio(grid.n_y, grid.n_x, 0.0);
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) ratio(j, i) = 1.0 + threshold_at(grid, d, j, i) / grid.background(j, i);
    }
    d.threshold = d.options.threshold.value_or(median_of(values_in(ratio, grid.there)));
    if (measured < kFewCells) {
        d.warnings.push_back("only " + std::to_string(measured) + " measured cells: too few to tell a background from a region");
    }
    std::vector<Candidate> found = candidates(grid, map, d);
    judge_all(grid, d, found);
    const auto weight = [](const Candidate& c) { return c.region.mean_excess_N_per_m * std::sqrt(c.region.area_m2); };
    std::stable_sort(found.begin(), found.end(), [&](const Candidate& a, const Candidate& b) { return weight(a) > weight(b); });
    for (Candidate& c : found) {
        c.region.id = "D" + std::to_string(d.regions.size() + 1);
        d.regions.push_back(std::move(c.region));
    }
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            d.stiffness_N_per_m.push_back(grid.there(j, i) != 0 ? grid.stiffness(j, i) : kNaN);
            d.background_N_per_m.push_back(grid.there(j, i) != 0 ? grid.background(j, i) : kNaN);
        }
    }
    return d;
}

void keep_regions(const Detection& detection, Map& map) {
    auto& nodules = map.nodules;
    nodules.erase(std::remove_if(nodules.begin(), nodules.end(), [](const Nodule& n) { return !n.placed; }), nodules.end());
    const auto named = [&](const std::string& id) {
        return std::any_of(nodules.begin(), nodules.end(), [&](const Nodule& n) { return n.id == id; });
    };
    for (const StiffRegion& region : detection.regions) {
        if (!region.sure) continue;
        Nodule nodule;
        nodule.id = region.id;
        while (named(nodule.id)) nodule.id += "'";
        nodule.placed = false;
        nodule.x_m = region.x_m;
        nodule.y_m = region.y_m;
        constexpr double kLong = 1.5;  // length / width of what is stored as long
        if (region.length_m >= kLong * region.width_m) {
            nodule.diameter_m = region.width_m;
            nodule.length_m = region.length_m;
            nodule.angle_deg = region.angle_deg;
        } else {
            nodule.diameter_m = std::sqrt(4.0 * region.area_m2 / std::numbers::pi);
        }
        nodules.push_back(nodule);
    }
}

}  // namespace palpa
