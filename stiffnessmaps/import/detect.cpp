#include "stiffnessmaps/import/detect.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "files/input_error.h"
#include "files/quantile.h"
#include "files/text.h"
#include "stiffnessmaps/grid.h"
#include "stiffnessmaps/import/detect_verdicts.h"
#include "stiffnessmaps/stiffness.h"

namespace palpa::stiffnessmaps {
namespace {

constexpr int kMostLooks = 5;
constexpr std::ptrdiff_t kFewCells = 30;  // fewer cells do not suffice to tell a background from a region

// Finds the candidates and judges them against the grid's present background.
std::vector<Candidate> look(const StiffnessGrid& grid, const Map& map, const Detection& d) {
    std::vector<Candidate> found = candidates(grid, map, d);
    judge_all(grid, d, found);
    return found;
}

// Step 6 of detect.h: sets sure regions and their slopes aside, so that they raise neither background nor spread, and
// searches the rest again, as long as another region turns out sure, up to kMostLooks times in all.
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

// Stores what the report says of the map as a whole: the background and spread of the first look.
void note_ground(const StiffnessGrid& grid, Detection& d) {
    d.spread_N_per_m = grid.spread_N_per_m;
    std::vector<double> ratio;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            const bool there = grid.there(j, i) != 0;
            d.stiffness_N_per_m.push_back(there ? grid.stiffness(j, i) : kMissing);
            d.background_N_per_m.push_back(there ? grid.background(j, i) : kMissing);
            if (there) ratio.push_back(1.0 + threshold_at(grid, d, j, i) / grid.background(j, i));
        }
    }
    d.threshold = d.options.threshold.value_or(files::upper_median(std::move(ratio)));
}

void check_options(const DetectOptions& o) {
    const auto refuse = [](const char* name, double value, const char* expected) {
        throw files::bad_input(name, "", files::short_number(value), expected);
    };
    if (o.threshold && !(*o.threshold > 1.0 && *o.threshold <= 1e6))
        refuse("--threshold", *o.threshold, "a ratio above 1");
    if (!(o.window_m > 0.0 && o.window_m <= 1e3)) refuse("--window-mm", o.window_m, "a radius above 0");
    if (o.smoothing_m && !(*o.smoothing_m >= 0.0 && *o.smoothing_m <= 1.0))
        refuse("--smoothing-mm", *o.smoothing_m, "0 to 1000 mm");
    if (o.smallest_m && !(*o.smallest_m >= 0.0 && *o.smallest_m <= 1e3))
        refuse("--smallest-mm", *o.smallest_m, "at least 0");
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
    if (std::none_of(raw.begin(), raw.end(), [](double k) { return k > 0.0; })) {
        throw files::bad_input(
            file, "", "no cell that resists (greatest force " + files::short_number(force_range(map).highest_N) + " N)",
            "forces above 0: pressing is positive");
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
    if (std::erase_if(nodules, [](const Nodule& n) { return !n.placed; }) > 0 && nodules.empty())
        map.nodules_known = false;  // an earlier detection alone had named some
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
        constexpr double kLong = 1.5;  // length / width from which a region is stored as long
        if (region.length_m >= kLong * region.width_m) {
            nodule.diameter_m = region.width_m;
            nodule.length_m = region.length_m;
            nodule.angle_deg = region.angle_deg;
        } else {
            nodule.diameter_m = std::sqrt(4.0 * region.area_m2 / std::numbers::pi);
        }
        nodules.push_back(nodule);
        map.nodules_known = true;
    }
}

}  // namespace palpa::stiffnessmaps
