#include "mechanics/triangle_solid.h"

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

std::size_t along_u(int axis) { return static_cast<std::size_t>((axis + 1) % 3); }
std::size_t along_v(int axis) { return static_cast<std::size_t>((axis + 2) % 3); }

// First and last square that a triangle touches.
struct Squares {
    int u0, u1, v0, v1;
};

Squares squares_of(const Triangle& triangle, const TriangleBins& bins) {
    const auto range = [&](std::size_t side, std::size_t axis) {
        const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
        const auto square = [&](double at_m) {
            const double place = std::floor((at_m - bins.low_m[side]) * bins.per_m[side]);
            return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(bins.n[side] - 1)));
        };
        return std::array<int, 2>{square(low), square(high)};
    };
    const auto u = range(0, along_u(bins.axis)), v = range(1, along_v(bins.axis));
    return {u[0], u[1], v[0], v[1]};
}

TriangleBins empty_bins(int axis, int n, const std::array<double, 3>& low_m, const std::array<double, 3>& high_m) {
    TriangleBins bins;
    bins.axis = axis;
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
        const std::size_t c = side == 0 ? along_u(axis) : along_v(axis);
        const double length_m = high_m[c] - low_m[c];
        bins.n[side] = length_m > 0.0 ? n : 1;
        bins.low_m[side] = low_m[c];
        bins.per_m[side] = length_m > 0.0 ? n / length_m : 0.0;
    }
    return bins;
}

// A line entering (+1) or leaving (-1) the body.
struct Crossing {
    double at_m;
    int step;
};

// How often a triangle's outline, seen along the axis, goes round the line counter-clockwise: -1, 0 or 1.
int turns_about(const Triangle& triangle, std::size_t u, std::size_t v, double u_m, double v_m) {
    int turns = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& a = triangle[i];
        const auto& b = triangle[(i + 1) % 3];
        if ((a[v] > v_m) == (b[v] > v_m)) continue;
        const bool up = b[v] > a[v];
        const auto& low = up ? a : b;
        const auto& high = up ? b : a;
        if (low[u] + (v_m - low[v]) * ((high[u] - low[u]) / (high[v] - low[v])) > u_m) turns += up ? 1 : -1;
    }
    return turns;
}

double place_along(const Triangle& t, int axis, double u_m, double v_m) {
    const auto a = static_cast<std::size_t>(axis);
    const std::size_t u = along_u(axis), v = along_v(axis);
    const auto [low, high] = std::minmax({t[0][a], t[1][a], t[2][a]});
    const double bu = t[1][u] - t[0][u], bv = t[1][v] - t[0][v], ba = t[1][a] - t[0][a];
    const double cu = t[2][u] - t[0][u], cv = t[2][v] - t[0][v], ca = t[2][a] - t[0][a];
    const double na = bu * cv - bv * cu;
    if (na == 0.0) return low;
    const double at_m = t[0][a] - ((u_m - t[0][u]) * (bv * ca - ba * cv) + (v_m - t[0][v]) * (ba * cu - bu * ca)) / na;
    return std::isfinite(at_m) ? std::clamp(at_m, low, high) : low;
}

std::int64_t count_open_edges(const std::vector<Triangle>& triangles) {
    struct Edge {
        std::array<double, 3> low, high;
        int way;
        bool operator<(const Edge& other) const { return low != other.low ? low < other.low : high < other.high; }
    };
    std::vector<Edge> edges;
    edges.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& a = t[i];
            const auto& b = t[(i + 1) % 3];
            if (a != b) edges.push_back(a < b ? Edge{a, b, 1} : Edge{b, a, -1});
        }
    }
    std::sort(edges.begin(), edges.end());
    std::int64_t open = 0;
    for (std::size_t i = 0; i < edges.size();) {
        int sum = 0;
        std::size_t j = i;
        for (; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j)
            sum += edges[j].way;
        open += std::abs(sum);
        i = j;
    }
    return open;
}

double volume_of(const TriangleSolid& solid) {
    double six_m3 = 0.0;
    for (const Triangle& t : solid.triangles) {
        Triangle p = t;  // from the box's corner, so that far parts lose no digits
        for (auto& corner : p) {
            for (std::size_t c = 0; c < 3; ++c) corner[c] -= solid.low_m[c];
        }
        six_m3 += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) -
                  p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) + p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return six_m3 / 6.0;
}

// A grid of points over the box, off its corners by odd shares of the pitch, so that no surface lies on a row of them.
struct CheckGrid {
    double pitch_m = 0.0;
    std::array<double, 3> first_m{};
    std::array<int, 3> n{};
    std::vector<std::uint8_t> seen;                // of each point, bit a: the line along axis a is inside
    std::array<std::vector<std::uint8_t>, 3> bad;  // of each line along an axis

    std::size_t point(const std::array<int, 3>& at) const {
        return static_cast<std::size_t>(at[0]) +
               static_cast<std::size_t>(n[0]) *
                   (static_cast<std::size_t>(at[1]) + static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(at[2]));
    }
    std::size_t line(int axis, const std::array<int, 3>& at) const {
        const std::size_t u = along_u(axis), v = along_v(axis);
        return static_cast<std::size_t>(at[u]) + static_cast<std::size_t>(n[u]) * static_cast<std::size_t>(at[v]);
    }
};

CheckGrid check_grid(const TriangleSolid& solid, int most_along) {
    CheckGrid grid;
    double longest_m = 0.0;
    for (std::size_t c = 0; c < 3; ++c) longest_m = std::max(longest_m, solid.high_m[c] - solid.low_m[c]);
    grid.pitch_m = std::max(longest_m, 1e-12) / most_along;
    constexpr std::array<double, 3> kOff{0.4142135, 0.6180339, 0.5772156};
    for (std::size_t c = 0; c < 3; ++c) {
        grid.first_m[c] = solid.low_m[c] + (kOff[c] - 1.0) * grid.pitch_m;
        grid.n[c] = static_cast<int>(std::ceil((solid.high_m[c] - solid.low_m[c]) / grid.pitch_m)) + 2;
    }
    grid.seen.resize(static_cast<std::size_t>(grid.n[0]) * static_cast<std::size_t>(grid.n[1]) *
                     static_cast<std::size_t>(grid.n[2]));
    for (int axis = 0; axis < 3; ++axis)
        grid.bad[static_cast<std::size_t>(axis)].resize(grid.line(axis, {grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1}) +
                                                        1);
    return grid;
}

// Marks the points that the lines along an axis find inside. Returns how many lines were turned.
std::int64_t look_along(const TriangleSolid& solid, int axis, CheckGrid& grid) {
    const TriangleBins bins = bins_of(solid.triangles, axis, solid.low_m, solid.high_m);
    const auto a = static_cast<std::size_t>(axis);
    const std::size_t u = along_u(axis), v = along_v(axis);
    std::vector<Stretch> stretches;
    std::int64_t turned = 0;
    std::array<int, 3> at{};
    for (at[v] = 0; at[v] < grid.n[v]; ++at[v]) {
        for (at[u] = 0; at[u] < grid.n[u]; ++at[u]) {
            at[a] = 0;
            const LineCount count = stretches_of(solid, bins, grid.first_m[u] + at[u] * grid.pitch_m,
                                                 grid.first_m[v] + at[v] * grid.pitch_m, stretches);
            turned += count.turned ? 1 : 0;
            if (!count.closed) grid.bad[a][grid.line(axis, at)] = 1;
            for (const Stretch& stretch : stretches) {
                const auto place = [&](double m) {
                    return static_cast<int>(std::clamp(std::ceil((m - grid.first_m[a]) / grid.pitch_m), 0.0,
                                                       static_cast<double>(grid.n[a])));
                };
                for (at[a] = place(stretch.low_m); at[a] < place(stretch.high_m); ++at[a])
                    grid.seen[grid.point(at)] = static_cast<std::uint8_t>(grid.seen[grid.point(at)] | (1U << axis));
            }
        }
    }
    return turned;
}

}  // namespace

TriangleBins bins_of(const std::vector<Triangle>& triangles, int axis, const std::array<double, 3>& low_m,
                     const std::array<double, 3>& high_m) {
    // Large triangles lie in many squares: coarser until the lists are no longer than a few times the triangles'.
    int n = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(triangles.size()))), 1, 1024);
    TriangleBins bins;
    for (;; n = std::max(1, n / 2)) {
        bins = empty_bins(axis, n, low_m, high_m);
        std::size_t entries = 0;
        for (const Triangle& triangle : triangles) {
            const Squares s = squares_of(triangle, bins);
            entries += static_cast<std::size_t>(s.u1 - s.u0 + 1) * static_cast<std::size_t>(s.v1 - s.v0 + 1);
        }
        if (n == 1 || entries <= 8 * triangles.size() + 4096) break;
    }
    bins.first.assign(static_cast<std::size_t>(bins.n[0]) * static_cast<std::size_t>(bins.n[1]) + 1, 0);
    const auto for_each = [&](const Triangle& triangle, const auto& call) {
        const Squares s = squares_of(triangle, bins);
        for (int v = s.v0; v <= s.v1; ++v) {
            for (int u = s.u0; u <= s.u1; ++u) call(static_cast<std::size_t>(u + bins.n[0] * v));
        }
    };
    for (const Triangle& triangle : triangles)
        for_each(triangle, [&](std::size_t square) { ++bins.first[square + 1]; });
    for (std::size_t i = 1; i < bins.first.size(); ++i) bins.first[i] += bins.first[i - 1];
    bins.triangle.resize(bins.first.back());
    std::vector<std::uint32_t> next(bins.first.begin(), bins.first.end() - 1);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for_each(triangles[t],
                 [&](std::size_t square) { bins.triangle[next[square]++] = static_cast<std::uint32_t>(t); });
    }
    return bins;
}

TriangleSolid make_solid(std::vector<Triangle> triangles) {
    if (triangles.empty() || triangles.size() > kMostTriangles)
        throw MeshError(text(triangles.size(), " triangles, must be 1 to ", kMostTriangles), {});
    TriangleSolid solid{std::move(triangles), {}, {}, {}};
    solid.low_m = solid.high_m = solid.triangles[0][0];
    for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
        for (const auto& corner : solid.triangles[t]) {
            for (std::size_t c = 0; c < 3; ++c) {
                if (!(std::abs(corner[c]) < 1e9))
                    throw MeshError(text("triangle ", t, " has a corner that is not finite, or beyond 1e9 m"), {});
                solid.low_m[c] = std::min(solid.low_m[c], corner[c]);
                solid.high_m[c] = std::max(solid.high_m[c], corner[c]);
            }
        }
    }
    solid.along_x = bins_of(solid.triangles, 0, solid.low_m, solid.high_m);
    return solid;
}

LineCount stretches_of(const TriangleSolid& solid, const TriangleBins& bins, double u_m, double v_m,
                       std::vector<Stretch>& out) {
    out.clear();
    const std::size_t u = along_u(bins.axis), v = along_v(bins.axis);
    const bool beside = u_m < solid.low_m[u] || u_m > solid.high_m[u] || v_m < solid.low_m[v] || v_m > solid.high_m[v];
    if (beside) return {};
    const auto bin = [&](std::size_t side, double at_m) {
        const double place = std::floor((at_m - bins.low_m[side]) * bins.per_m[side]);
        return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bins.n[side] - 1)));
    };
    const std::size_t here = bin(0, u_m) + static_cast<std::size_t>(bins.n[0]) * bin(1, v_m);
    static thread_local std::vector<Crossing> crossings;
    crossings.clear();
    for (std::uint32_t i = bins.first[here]; i < bins.first[here + 1]; ++i) {
        const Triangle& triangle = solid.triangles[bins.triangle[i]];
        // a triangle that faces along the axis is left, and is seen counter-clockwise
        if (const int turns = turns_about(triangle, u, v, u_m, v_m); turns != 0)
            crossings.push_back({place_along(triangle, bins.axis, u_m, v_m), -turns});
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return a.at_m != b.at_m ? a.at_m < b.at_m : a.step > b.step;
    });
    int depth = 0;
    LineCount count;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        depth += crossings[i].step;
        const auto a = static_cast<std::size_t>(bins.axis);
        const double end_m = i + 1 < crossings.size() ? crossings[i + 1].at_m : solid.high_m[a];
        count.turned = count.turned || (depth < 0 && end_m > crossings[i].at_m);
        if (depth <= 0 || !(end_m > crossings[i].at_m)) continue;
        if (!out.empty() && out.back().high_m == crossings[i].at_m) {
            out.back().high_m = end_m;
        } else {
            out.push_back({crossings[i].at_m, end_m});
        }
    }
    count.closed = depth == 0;
    return count;
}

SolidCheck check_solid(const TriangleSolid& solid, int most_along) {
    SolidCheck check;
    check.volume_m3 = volume_of(solid);
    check.open_edges = count_open_edges(solid.triangles);
    CheckGrid grid = check_grid(solid, most_along);
    std::int64_t turned = 0;
    for (int axis = 0; axis < 3; ++axis) turned += look_along(solid, axis, grid);
    std::array<int, 3> at{};
    for (at[2] = 0; at[2] < grid.n[2]; ++at[2]) {
        for (at[1] = 0; at[1] < grid.n[1]; ++at[1]) {
            const std::size_t row = grid.point({0, at[1], at[2]});
            for (at[0] = 0; at[0] < grid.n[0]; ++at[0]) {
                const std::uint8_t seen = grid.seen[row + static_cast<std::size_t>(at[0])];
                if (seen == 0 || seen == 7) continue;
                for (int axis = 0; axis < 3; ++axis) grid.bad[static_cast<std::size_t>(axis)][grid.line(axis, at)] = 1;
            }
        }
    }
    std::int64_t open = 0, lines = 0;
    for (const auto& bad : grid.bad) {
        open += std::count(bad.begin(), bad.end(), std::uint8_t{1});
        lines += static_cast<std::int64_t>(bad.size());
    }
    check.open_share = static_cast<double>(open) / static_cast<double>(lines);
    check.turned_share = static_cast<double>(turned) / static_cast<double>(lines);
    return check;
}

}  // namespace palpa::mechanics
