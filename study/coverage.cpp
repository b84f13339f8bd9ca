#include "study/coverage.h"

#include <algorithm>
#include <cmath>

namespace palpa::study {
namespace {

struct CellRange {
    int low_x, high_x, low_y, high_y;
};

CellRange cells_near(const Coverage& c, double x_m, double y_m, double radius_m) {
    const auto cell = [&](double offset_m, int n) {
        return static_cast<int>(std::clamp(std::floor(offset_m / c.cell_m), 0.0, n - 1.0));
    };
    return {cell(x_m - radius_m - c.x_m, c.n_x), cell(x_m + radius_m - c.x_m, c.n_x),
            cell(y_m - radius_m - c.y_m, c.n_y), cell(y_m + radius_m - c.y_m, c.n_y)};
}

bool holds(const Coverage& c, int i, int j, double x_m, double y_m, double radius_m) {
    const double dx = x_m - (c.x_m + (i + 0.5) * c.cell_m);
    const double dy = y_m - (c.y_m + (j + 0.5) * c.cell_m);
    constexpr double kRounding = 1.0 + 1e-9;  // a place on the border belongs to all cells beside it
    const bool inside_cell = std::max(std::abs(dx), std::abs(dy)) <= 0.5 * kRounding * c.cell_m;
    return inside_cell || dx * dx + dy * dy <= radius_m * radius_m;
}

std::size_t cell_index(const Coverage& c, int i, int j) { return static_cast<std::size_t>(j * c.n_x + i); }

}  // namespace

Coverage make_coverage(double x_m, double y_m, double width_m, double height_m, double full_depth_m) {
    constexpr double kMostCells = 512.0;
    Coverage c;
    c.x_m = x_m;
    c.y_m = y_m;
    c.full_depth_m = full_depth_m;
    c.cell_m = std::max(c.cell_m, std::max(width_m, height_m) / kMostCells);
    c.n_x = std::max(1, static_cast<int>(std::ceil(width_m / c.cell_m - 1e-9)));
    c.n_y = std::max(1, static_cast<int>(std::ceil(height_m / c.cell_m - 1e-9)));
    c.depth_m.assign(static_cast<std::size_t>(c.n_x * c.n_y), 0.0f);
    c.beyond.assign(c.depth_m.size(), false);
    return c;
}

void cover(double x_m, double y_m, double radius_m, double depth_m, Coverage& c, bool beyond) {
    if (!(depth_m > 0.0) || !std::isfinite(x_m + y_m + radius_m + depth_m)) return;
    const CellRange range = cells_near(c, x_m, y_m, radius_m);
    const auto depth = static_cast<float>(depth_m);
    for (int j = range.low_y; j <= range.high_y; ++j) {
        for (int i = range.low_x; i <= range.high_x; ++i) {
            const std::size_t cell = cell_index(c, i, j);
            // most cells were as deep at the last sample
            const float deepest = c.depth_m[cell];
            if (deepest > depth || (deepest == depth && c.beyond[cell] >= beyond)) continue;
            if (!holds(c, i, j, x_m, y_m, radius_m)) continue;
            c.depth_m[cell] = depth;
            c.beyond[cell] = beyond;
        }
    }
}

PalpationLevel level_of(const Coverage& c, double depth_m) {
    if (!(depth_m > 0.0)) return PalpationLevel::none;
    if (depth_m < c.full_depth_m / 3.0) return PalpationLevel::light;
    return depth_m < 2.0 * c.full_depth_m / 3.0 ? PalpationLevel::medium : PalpationLevel::deep;
}

CoverageShares shares_of(const Coverage& c) {
    int cells[kPalpationLevels] = {};  // counted, so that all are exactly 1
    for (const float depth_m : c.depth_m) {
        const auto level = static_cast<int>(level_of(c, static_cast<double>(depth_m)));
        if (level == 0) ++cells[0];
        for (int l = 1; l <= level; ++l) ++cells[l];
    }
    CoverageShares shares;
    for (int l = 0; l < kPalpationLevels; ++l) shares.at_least[l] = cells[l] / static_cast<double>(c.depth_m.size());
    return shares;
}

double deepest_near(const Coverage& c, double x_m, double y_m, double radius_m) {
    float deepest_m = 0.0f;
    const CellRange range = cells_near(c, x_m, y_m, radius_m);
    for (int j = range.low_y; j <= range.high_y; ++j) {
        for (int i = range.low_x; i <= range.high_x; ++i) {
            if (holds(c, i, j, x_m, y_m, radius_m)) deepest_m = std::max(deepest_m, c.depth_m[cell_index(c, i, j)]);
        }
    }
    return static_cast<double>(deepest_m);
}

DeepestPress deepest_on(const Coverage& c, const Target& target) {
    const double radius_m = 0.5 * target.diameter_m;
    float deepest_m = 0.0f;
    bool beyond = false;
    const CellRange range = cells_near(c, target.x_m, target.y_m, std::max(radius_m, 0.5 * target.length_m));
    for (int j = range.low_y; j <= range.high_y; ++j) {
        for (int i = range.low_x; i <= range.high_x; ++i) {
            const MarkedPlace centre{c.x_m + (i + 0.5) * c.cell_m, c.y_m + (j + 0.5) * c.cell_m};
            const bool on = distance_m(target, centre) <= radius_m;
            const std::size_t cell = cell_index(c, i, j);
            if ((!on && !holds(c, i, j, target.x_m, target.y_m, radius_m)) || c.depth_m[cell] < deepest_m) continue;
            beyond = c.beyond[cell] || (beyond && c.depth_m[cell] == deepest_m);
            deepest_m = c.depth_m[cell];
        }
    }
    return {static_cast<double>(deepest_m), beyond};
}

const char* name_of(PalpationLevel level) {
    constexpr const char* kNames[kPalpationLevels] = {"none", "light", "medium", "deep"};
    return kNames[static_cast<int>(level)];
}

}  // namespace palpa::study
