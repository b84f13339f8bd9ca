#include "stiffnessmaps/import/gridding.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "files/input_error.h"
#include "files/text.h"
#include "stiffnessmaps/grid.h"
#include "stiffnessmaps/import/local_plane.h"
#include "stiffnessmaps/import/robust.h"

namespace palpa::stiffnessmaps {
namespace {

constexpr double kOffGrid = 0.1;  // of the pitch
constexpr double kMostPositions = 10000.0;

// Divides the plane into squares, to find places near each other.
struct SquareIndex {
    double side_m;
    static std::uint64_t key(std::int32_t i, std::int32_t j) {
        return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32) | static_cast<std::uint32_t>(j);
    }
    std::int32_t square(double place_m) const {
        constexpr double kFar = 1e9;
        return static_cast<std::int32_t>(std::floor(std::clamp(place_m / side_m, -kFar, kFar)));
    }
};

}  // namespace

std::optional<AxisFit> fit_axis(const std::vector<double>& places_m, double same_m) {
    std::vector<double> sorted = places_m;
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> middle_m;  // of each group
    for (std::size_t i = 0, from = 0; i < sorted.size(); ++i) {
        if (i + 1 < sorted.size() && sorted[i + 1] - sorted[i] <= same_m) continue;
        middle_m.push_back(std::accumulate(sorted.begin() + static_cast<std::ptrdiff_t>(from),
                                           sorted.begin() + static_cast<std::ptrdiff_t>(i) + 1, 0.0) /
                           static_cast<double>(i + 1 - from));
        from = i + 1;
    }
    std::vector<double> steps;
    for (std::size_t i = 1; i < middle_m.size(); ++i) steps.push_back(middle_m[i] - middle_m[i - 1]);
    AxisFit fit;
    fit.axis.origin_m = sorted.empty() ? 0.0 : sorted.front();
    if (steps.empty() && !sorted.empty() && sorted.back() - sorted.front() > 2.0 * same_m) return std::nullopt;
    if (steps.empty()) return fit;
    const double pitch_m = median(steps);  // a gap in the grid makes some steps longer, never most
    const double extent_m = sorted.back() - sorted.front();
    if (extent_m / pitch_m >= kMostPositions) return std::nullopt;

    // the phase that most places share, so that single places off the grid do not shift it
    double c = 0.0;
    double s = 0.0;
    for (const double place_m : sorted) {
        const double angle = 2.0 * std::numbers::pi * (place_m - sorted.front()) / pitch_m;
        c += std::cos(angle);
        s += std::sin(angle);
    }
    const double phase_m = sorted.front() + pitch_m * std::atan2(s, c) / (2.0 * std::numbers::pi);

    // least squares of position against index, over the places within a quarter pitch of theirs
    double n = 0.0;
    double sum_i = 0.0;
    double sum_ii = 0.0;
    double sum_p = 0.0;
    double sum_ip = 0.0;
    for (const double place_m : sorted) {
        const double i = std::round((place_m - phase_m) / pitch_m);
        if (std::abs((place_m - phase_m) / pitch_m - i) > 0.25) continue;
        n += 1.0;
        sum_i += i;
        sum_ii += i * i;
        sum_p += place_m - phase_m;
        sum_ip += i * (place_m - phase_m);
    }
    const double spread = n * sum_ii - sum_i * sum_i;
    const double best_m = spread > 0.0 ? (n * sum_ip - sum_i * sum_p) / spread : pitch_m;
    if (!(best_m > 0.5 * pitch_m)) return std::nullopt;
    const double zero_m = phase_m + (n > 0.0 ? (sum_p - best_m * sum_i) / n : 0.0);

    // indices start at the first place that lies on the axis
    double first = std::numeric_limits<double>::infinity();
    double last = -first;
    for (const double place_m : sorted) {
        const double i = (place_m - zero_m) / best_m;
        if (std::abs(i - std::round(i)) > kOffGrid) {
            ++fit.off;
            continue;
        }
        first = std::min(first, std::round(i));
        last = std::max(last, std::round(i));
    }
    if (!(last >= first) || last - first >= kMostPositions) return std::nullopt;
    fit.axis = {zero_m + best_m * first, best_m, 1 + static_cast<std::size_t>(last - first)};
    return fit;
}

std::optional<std::size_t> index_on(const GridAxis& axis, double place_m) {
    const double at = (place_m - axis.origin_m) / axis.pitch_m;
    const double i = std::round(at);
    if (!(std::abs(at - i) <= kOffGrid) || i < 0.0 || i >= static_cast<double>(axis.n)) return std::nullopt;
    return static_cast<std::size_t>(i);
}

GridAxis covering_axis(double lowest_m, double highest_m, double pitch_m) {
    const double steps = std::min(std::floor((highest_m - lowest_m) / pitch_m + 1e-6), 1e7);
    const double rest_m = (highest_m - lowest_m) - steps * pitch_m;
    return {lowest_m + 0.5 * rest_m, pitch_m, 1 + static_cast<std::size_t>(std::max(steps, 0.0))};
}

double neighbour_distance_m(const std::vector<double>& x_m, const std::vector<double>& y_m) {
    const std::size_t n = x_m.size();
    if (n < 2) return 0.0;
    const auto [x_low, x_high] = std::minmax_element(x_m.begin(), x_m.end());
    const auto [y_low, y_high] = std::minmax_element(y_m.begin(), y_m.end());
    const double area = std::max(*x_high - *x_low, 1e-6) * std::max(*y_high - *y_low, 1e-6);
    const double line = std::max(*x_high - *x_low, *y_high - *y_low) / static_cast<double>(n);
    const SquareIndex index{std::max({std::sqrt(area / static_cast<double>(n)), line, 1e-7})};
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> squares;
    for (std::size_t i = 0; i < n; ++i) {
        squares[SquareIndex::key(index.square(x_m[i]), index.square(y_m[i]))].push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<double> nearest_m;
    const std::size_t step = 1 + n / 20000;  // the median needs no more
    for (std::size_t i = 0; i < n; i += step) {
        double best = std::numeric_limits<double>::infinity();
        for (std::int32_t b = -1; b <= 1; ++b) {
            for (std::int32_t a = -1; a <= 1; ++a) {
                const auto at = squares.find(SquareIndex::key(index.square(x_m[i]) + a, index.square(y_m[i]) + b));
                if (at == squares.end()) continue;
                std::size_t looked_at = 0;
                for (const std::uint32_t j : at->second) {
                    if (j == i) continue;
                    if (++looked_at > 1000) break;  // very many places in one square
                    best = std::min(best, std::hypot(x_m[i] - x_m[j], y_m[i] - y_m[j]));
                }
            }
        }
        nearest_m.push_back(std::isfinite(best) ? best : 2.0 * index.side_m);
    }
    return median(std::move(nearest_m));
}

std::size_t group_count(const std::vector<double>& x_m, const std::vector<double>& y_m, double link_m) {
    const SquareIndex index{std::max(link_m, 1e-7)};
    std::unordered_map<std::uint64_t, std::size_t> squares;  // number of places in each square
    for (std::size_t i = 0; i < x_m.size(); ++i)
        ++squares[SquareIndex::key(index.square(x_m[i]), index.square(y_m[i]))];
    const std::size_t enough = std::max<std::size_t>(4, x_m.size() / 20);
    std::size_t groups = 0;
    std::vector<std::uint64_t> to_visit;
    while (!squares.empty()) {
        std::size_t places = 0;
        to_visit.push_back(squares.begin()->first);
        places += squares.begin()->second;
        squares.erase(squares.begin());
        while (!to_visit.empty()) {
            const std::uint64_t here = to_visit.back();
            to_visit.pop_back();
            const auto i = static_cast<std::int32_t>(here >> 32);
            const auto j = static_cast<std::int32_t>(here & 0xffffffffu);
            for (std::int32_t b = -1; b <= 1; ++b) {
                for (std::int32_t a = -1; a <= 1; ++a) {
                    const auto next = squares.find(SquareIndex::key(i + a, j + b));
                    if (next == squares.end()) continue;
                    places += next->second;
                    to_visit.push_back(next->first);
                    squares.erase(next);
                }
            }
        }
        groups += places >= enough;
    }
    return groups;
}

bool inside_region(const std::optional<std::array<double, 4>>& region_m, double x_m, double y_m) {
    if (!region_m) return true;
    const auto& [x_from, x_to, y_from, y_to] = *region_m;
    return x_m >= x_from && x_m <= x_to && y_m >= y_from && y_m <= y_to;
}

void check_grid(const GridAxis& x, const GridAxis& y, std::size_t n_depths, const std::string& file) {
    constexpr std::size_t kMostValues = 20'000'000;
    const double values = static_cast<double>(x.n) * static_cast<double>(y.n) * static_cast<double>(n_depths);
    if (values <= static_cast<double>(kMostValues)) return;
    throw files::bad_input(file, "",
                           std::to_string(x.n) + " x " + std::to_string(y.n) + " cells of " +
                               files::short_number(1e3 * x.pitch_m) + " x " + files::short_number(1e3 * y.pitch_m) +
                               " mm and " + std::to_string(n_depths) + " depths",
                           "a grid of at most 20 million forces (is a position far off the others? else --pitch-mm, "
                           "--region-mm)");
}

namespace {

struct LayerRange {
    double below_m;  // distance to the next shallower layer, where the weight reaches 0
    double above_m;  // distance to the next deeper layer
};

std::vector<LayerRange> layer_ranges(const std::vector<double>& depths_m) {
    std::vector<LayerRange> out;
    for (std::size_t k = 0; k < depths_m.size(); ++k) {
        const double below = depths_m[k] - (k > 0 ? depths_m[k - 1] : 0.0);
        out.push_back({below, k + 1 < depths_m.size() ? depths_m[k + 1] - depths_m[k] : below});
    }
    return out;
}

// Returns the distance of a depth from a layer as a share of that to the next layer, negative if shallower. Beyond -1
// and 1 the depth does not count for the layer.
double layers_off(const std::vector<double>& depths_m, const LayerRange& range, std::size_t layer, double depth_m) {
    const double off_m = depth_m - depths_m[layer];
    return off_m / (off_m < 0.0 ? range.below_m : range.above_m);
}

// Calls visit(cell, u, v) for every cell within the radius; (u, v) points from the cell to the place, in radii.
template <class Visit>
void visit_cells(const GridPlan& plan, double x_m, double y_m, Visit visit) {
    const auto first = [&](const GridAxis& axis, double place_m) {
        return static_cast<std::size_t>(
            std::max(0.0, std::ceil((place_m - plan.radius_m - axis.origin_m) / axis.pitch_m)));
    };
    for (std::size_t j = first(plan.y, y_m); j < plan.y.n && plan.y.at(j) <= y_m + plan.radius_m; ++j) {
        const double v = (y_m - plan.y.at(j)) / plan.radius_m;
        for (std::size_t i = first(plan.x, x_m); i < plan.x.n && plan.x.at(i) <= x_m + plan.radius_m; ++i) {
            const double u = (x_m - plan.x.at(i)) / plan.radius_m;
            if (u * u + v * v < 1.0) visit(j * plan.x.n + i, u, v);
        }
    }
}

// The force at each cell and layer by local regression (or inverse distance); samples whose value is NaN do not count.
template <class Value>
std::vector<float> by_planes(const Samples& samples, const GridPlan& plan, const std::vector<Value>& values,
                             bool inverse) {
    if (values.empty()) return {};
    const auto ranges = layer_ranges(plan.depths_m);
    std::vector<float> out;
    for (std::size_t layer = 0; layer < plan.depths_m.size(); ++layer) {
        const double thickness_m = std::max(ranges[layer].below_m, ranges[layer].above_m);
        std::vector<PlaneSums> sums(plan.n_cells());
        for (std::size_t s = 0; s < samples.size(); ++s) {
            const double w = layers_off(plan.depths_m, ranges[layer], layer, samples.depth_m[s]);
            const double value = static_cast<double>(values[s]);
            if (std::isnan(value) || !(std::abs(w) < 1.0)) continue;
            const double off = (samples.depth_m[s] - plan.depths_m[layer]) / thickness_m;
            const double carried = inverse ? plan.depths_m[layer] / samples.depth_m[s] : 1.0;
            visit_cells(plan, samples.x_m[s], samples.y_m[s], [&](std::size_t cell, double u, double v) {
                const double rr = u * u + v * v;
                const double near = inverse ? 1.0 / (rr + 0.01) : (1.0 - rr) * (1.0 - rr);
                sums[cell].add(near * (1.0 - std::abs(w)), u, v, off, carried * value);
            });
        }
        for (const PlaneSums& sum : sums) {
            double force_N = kMissing;
            if (sum.n >= plan.least && !one_sided(sum))
                force_N = inverse ? sum.f[0] / sum.a[0] : plane_value(sum, plan.depths_m[layer] / thickness_m);
            out.push_back(static_cast<float>(force_N));
        }
    }
    return out;
}

std::vector<float> by_medians(const Samples& samples, const GridPlan& plan) {
    const auto ranges = layer_ranges(plan.depths_m);
    struct Entry {
        std::uint32_t slot;
        float force_N;
    };
    std::vector<Entry> entries;
    for (std::size_t s = 0; s < samples.size(); ++s) {
        const auto nearest = [](const GridAxis& axis, double place_m) {
            return std::round((place_m - axis.origin_m) / axis.pitch_m);
        };
        const double i = nearest(plan.x, samples.x_m[s]);
        const double j = nearest(plan.y, samples.y_m[s]);
        if (i < 0.0 || j < 0.0 || i >= static_cast<double>(plan.x.n) || j >= static_cast<double>(plan.y.n)) continue;
        const std::size_t cell = static_cast<std::size_t>(j) * plan.x.n + static_cast<std::size_t>(i);
        for (std::size_t layer = 0; layer < plan.depths_m.size(); ++layer) {
            const double depth_m = samples.depth_m[s];
            if (!(std::abs(layers_off(plan.depths_m, ranges[layer], layer, depth_m)) <= 0.5)) continue;
            entries.push_back({static_cast<std::uint32_t>(layer * plan.n_cells() + cell),
                               static_cast<float>(samples.force_N[s] * plan.depths_m[layer] / depth_m)});
            break;
        }
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.slot != b.slot ? a.slot < b.slot : a.force_N < b.force_N;
    });
    std::vector<float> out(plan.n_cells() * plan.depths_m.size(), kMissing);
    for (std::size_t i = 0; i < entries.size();) {
        std::size_t end = i;
        while (end < entries.size() && entries[end].slot == entries[i].slot) ++end;
        if (end - i >= plan.least) out[entries[i].slot] = entries[i + (end - i) / 2].force_N;
        i = end;
    }
    return out;
}

}  // namespace

Gridded grid_samples(const Samples& samples, const GridPlan& plan) {
    Gridded out;
    const bool inverse = plan.method == Gridding::inverse_distance;
    out.normal_N = plan.method == Gridding::median ? by_medians(samples, plan)
                                                   : by_planes(samples, plan, samples.force_N, inverse);
    out.tangential_x_N = by_planes(samples, plan, samples.tangential_x_N, false);
    out.tangential_y_N = by_planes(samples, plan, samples.tangential_y_N, false);
    return out;
}

}  // namespace palpa::stiffnessmaps
