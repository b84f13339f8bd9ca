#include "stiffnessmaps/import/detect.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "files/distributions.h"
#include "files/input_error.h"
#include "files/quantile.h"
#include "files/text.h"
#include "stiffnessmaps/import/detect_ground.h"
#include "stiffnessmaps/stiffness.h"

namespace palpa::stiffnessmaps {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kOfNormal95 = 1.645;
constexpr double kSelection = 1.5;
constexpr double kClip = 1.5;
constexpr double kLeastShare = 0.03;  // of the background
constexpr int kMostLooks = 5;
constexpr std::ptrdiff_t kFewCells = 30;  // fewer cannot tell a background from a region

// Excess from which a cell counts.
double threshold_at(const StiffnessGrid& grid, const Detection& d, int j, int i) {
    const double background = grid.background(j, i);
    if (d.options.threshold) return std::max(0.0, (*d.options.threshold - 1.0) * background);
    return std::max(kSpreads * grid.spread_N_per_m, kLeastShare * background);
}

// Local maxima that reach the threshold, the highest first.
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

// The cells at or above `level` that hang together with `seed`, as a mask of 255.
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

// Smallest rectangle around the cells, in metres.
void measure_rectangle(const StiffnessGrid& grid, const cv::Mat1b& mask, StiffRegion& region) {
    std::vector<cv::Point2f> corners;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            if (mask(j, i) == 0) continue;
            for (const double a : {-0.5, 0.5}) {
                for (const double b : {-0.5, 0.5}) {  // mm, so that float keeps four digits behind the point
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
    region.contrast = region.background_N_per_m > 0.0 ? region.peak_N_per_m / region.background_N_per_m : kNaN;
    region.at_edge = cv::countNonZero(mask & grid.edge) > 0;
    return region;
}

// With a margin, at least one cell.
cv::Mat1b widened(const StiffnessGrid& grid, const cv::Mat1b& mask, double by_m) {
    const auto cells = [&](double pitch_m) {
        return 2 * std::max(1, static_cast<int>(std::lround(by_m / pitch_m))) + 1;
    };
    cv::Mat1b out;
    cv::dilate(mask, out, cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(cells(grid.dx_m), cells(grid.dy_m))));
    return out;
}

// Sum of `values` under `shape` (0 and 1) laid on every cell.
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

// Appends the mean excess under `shape` wherever at least 3/4 of it fit on the rest of the map with at least
// `least_on_edge` of its cells along the edge.
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

// Mean excess under the region's shape wherever it fits on the rest of the map; or along the edge alone, with as much of it
// there as the region has, turned to each side of the map.
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

// Fills in noise_N_per_m, against_edge and contrast_to_noise; NaN where nothing can be said.
void compare_with_rest(const StiffnessGrid& grid, const cv::Mat1b& mask, const cv::Mat1b& rest, StiffRegion& region) {
    region.noise_N_per_m = region.contrast_to_noise = kNaN;
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

// What belongs to a region and its slopes, and says nothing about the background.
cv::Mat1b with_slopes(const StiffnessGrid& grid, const Detection& d, const cv::Mat1b& mask, const cv::Point& peak) {
    const double level = std::max(0.25 * grid.excess(peak), 2.0 * grid.spread_N_per_m);
    cv::Mat1b slopes = hang_together(grid, peak, std::min(level, 0.5 * grid.excess(peak)));
    slopes |= mask;
    return widened(grid, slopes, *d.options.smoothing_m);
}

// Whether it stands out on all sides: at most a quarter of the cells around it may be as stiff as it is on average. What
// is stiffer than its background only because the ground bends (towards a soft edge, say) fails this.
bool stands_out(const StiffnessGrid& grid, const Detection& d, const cv::Mat1b& mask) {
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

// Area over which the excess is alike: product of its integral scales along x and y (to the first zero of each
// autocorrelation). The regions are part of it: in a map that a region fills there is little to compare with.
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

// contrast_to_noise that the highest of `n` independent areas exceeds once in a thousand maps: Student's t with n - 1
// degrees of freedom, as the spread comes from the same few areas (Wallace's closed form, Ann. Math. Stat. 30 (1959)
// 1121), times what it gains as a region is drawn around the highest cells and not laid anywhere.
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

// Several nodules must not hide each other, and lumps of one kind of tissue must not lend each other credit: what stands
// out twice as far as is needed, with all candidates left out of the rest, is no background for the others; every other
// candidate is. At the edge none is left out beforehand: a rough rim is candidates all along.
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
    for (std::size_t before = found.size() + 1;
         before != outstanding.size();) {  // what turns out sure is no background either
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

// Candidates and their verdicts against the grid's present background.
std::vector<Candidate> look(const StiffnessGrid& grid, const Map& map, const Detection& d) {
    std::vector<Candidate> found = candidates(grid, map, d);
    judge_all(grid, d, found);
    return found;
}

// What is sure is set aside, slopes and all, so that it raises neither background nor spread, and the rest is looked at
// again for as long as something else turns out sure.
void look_again(const Map& map, const Detection& d, StiffnessGrid& grid, std::vector<Candidate>& found) {
    std::vector<Candidate> latest = found;
    for (int number = 2; number <= kMostLooks; ++number) {
        bool any = false;
        for (const Candidate& c : latest) {
            if (c.region.sure) grid.known.setTo(255, c.slopes);
            any = any || c.region.sure;
        }
        if (!any || cv::countNonZero(without(grid.there, grid.known)) < kFewCells) return;
        take_background(d.options, grid);
        latest = look(grid, map, d);
        for (Candidate& c : latest) {
            if (!c.region.sure) continue;
            c.region.look = number;
            found.erase(std::remove_if(found.begin(), found.end(),
                                       [&](const Candidate& old) {
                                           return !old.region.sure && cv::countNonZero(old.mask & c.mask) > 0;
                                       }),
                        found.end());
            found.push_back(c);
        }
    }
}

// What the map as a whole is told of: the first look's.
void note_ground(const StiffnessGrid& grid, Detection& d) {
    d.spread_N_per_m = grid.spread_N_per_m;
    std::vector<double> ratio;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            const bool there = grid.there(j, i) != 0;
            d.stiffness_N_per_m.push_back(there ? grid.stiffness(j, i) : kNaN);
            d.background_N_per_m.push_back(there ? grid.background(j, i) : kNaN);
            if (there) ratio.push_back(1.0 + threshold_at(grid, d, j, i) / grid.background(j, i));
        }
    }
    d.threshold = d.options.threshold.value_or(files::upper_median(std::move(ratio)));
}

void check_options(const DetectOptions& o) {
    const auto refuse = [](const char* name, double value, const char* expected) {
        throw files::bad_input("detect", name, files::short_number(value), expected);
    };
    if (o.threshold && !(*o.threshold > 1.0 && *o.threshold <= 1e6))
        refuse("threshold", *o.threshold, "a ratio above 1");
    if (!(o.window_m > 0.0 && o.window_m <= 1e3)) refuse("window", o.window_m, "a radius above 0");
    if (o.smoothing_m && !(*o.smoothing_m >= 0.0 && *o.smoothing_m <= 1.0))
        refuse("smoothing", *o.smoothing_m, "0 to 1000 mm");
    if (o.smallest_m && !(*o.smallest_m >= 0.0 && *o.smallest_m <= 1e3))
        refuse("smallest", *o.smallest_m, "at least 0");
}

}  // namespace

std::size_t Detection::sure() const {
    return static_cast<std::size_t>(
        std::count_if(regions.begin(), regions.end(), [](const StiffRegion& r) { return r.sure; }));
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
        throw files::bad_input(
            file, "", "no cell with a force down to " + files::short_number(1e3 * *d.options.deepest_m) + " mm",
            "at least one");
    }
    StiffnessGrid grid = make_grid(map, raw, d.options);
    if (measured < kFewCells) {
        d.warnings.push_back("only " + std::to_string(measured) +
                             " measured cells: too few to tell a background from a region");
    }
    take_background(d.options, grid);
    std::vector<Candidate> found = look(grid, map, d);
    note_ground(grid, d);
    look_again(map, d, grid, found);
    const auto weight = [](const Candidate& c) { return c.region.mean_excess_N_per_m * std::sqrt(c.region.area_m2); };
    std::stable_sort(found.begin(), found.end(),
                     [&](const Candidate& a, const Candidate& b) { return weight(a) > weight(b); });
    for (Candidate& c : found) {
        c.region.id = "D" + std::to_string(d.regions.size() + 1);
        d.regions.push_back(std::move(c.region));
    }
    return d;
}

void keep_regions(const Detection& detection, Map& map) {
    auto& nodules = map.nodules;
    nodules.erase(std::remove_if(nodules.begin(), nodules.end(), [](const Nodule& n) { return !n.placed; }),
                  nodules.end());
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

}  // namespace palpa::stiffnessmaps
