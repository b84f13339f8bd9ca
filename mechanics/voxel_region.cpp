#include "mechanics/voxel_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/index.h"

namespace palpa::mechanics {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

// Part of a line along x, m; empty unless low < high.
struct Interval {
    double low_m = -kEndless;
    double high_m = kEndless;
};
constexpr Interval kNowhere{kEndless, -kEndless};

Interval overlap(const Interval& a, const Interval& b) {
    return {std::max(a.low_m, b.low_m), std::min(a.high_m, b.high_m)};
}

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// a x^2 + 2 b x + c <= 0 with a >= 0
Interval below_zero(double a, double b, double c) {
    if (!(a > 0.0)) return c <= 0.0 ? Interval{} : kNowhere;
    const double root = b * b - a * c;
    if (!(root >= 0.0)) return kNowhere;
    return {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
}

// low <= p + q x < high
Interval between(double p, double q, double low, double high) {
    if (q == 0.0) return p >= low && p < high ? Interval{} : kNowhere;
    const double one = (low - p) / q, other = (high - p) / q;
    return {std::min(one, other), std::max(one, other)};
}

Interval of_ball(const Point& centre_m, double radius_m, double y_m, double z_m) {
    const double dy = y_m - centre_m[1], dz = z_m - centre_m[2];
    return below_zero(1.0, -centre_m[0], centre_m[0] * centre_m[0] + dy * dy + dz * dz - radius_m * radius_m);
}

// The points of the line are (x, y, z); d: from the cylinder's first end to the point; a: along its axis.
//   |d|^2 - (d . a)^2 <= r^2,   0 <= d . a <= L
Interval of_cylinder(const Point& from_m, const Point& to_m, double radius_m, double y_m, double z_m) {
    Point a = minus(to_m, from_m);
    const double length_m = std::sqrt(dot(a, a));
    if (!(length_m > 0.0)) return kNowhere;
    for (double& component : a) component /= length_m;
    const Point d{-from_m[0], y_m - from_m[1], z_m - from_m[2]};  // at x = 0
    const double along = dot(d, a);
    const double across2 = a[1] * a[1] + a[2] * a[2];  // 1 - a_x^2, without its cancellation
    const Interval sides = below_zero(across2, d[0] - along * a[0], dot(d, d) - along * along - radius_m * radius_m);
    return overlap(sides, between(along, a[0], 0.0, length_m));
}

// First voxel whose centre is at or above a place.
int first_voxel(double at_m, double origin_m, double pitch_m, int length) {
    const double place = std::ceil((at_m - origin_m) / pitch_m - 0.5 - 1e-9);
    return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(length)));
}

// A line in metres, and where its spans go.
struct Line {
    const VoxelFrame& frame;
    int length;
    double y_m, z_m;
};

void add(const Line& line, const Interval& interval, std::vector<Span>& out) {
    if (!(interval.low_m < interval.high_m)) return;
    const Span span{first_voxel(interval.low_m, line.frame.origin_m[0], line.frame.pitch_m, line.length),
                    first_voxel(interval.high_m, line.frame.origin_m[0], line.frame.pitch_m, line.length)};
    if (span.x0 < span.x1) out.push_back(span);
}

void sort_and_merge(std::vector<Span>& spans) {
    std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.x0 < b.x0; });
    std::size_t kept = 0;
    for (const Span& span : spans) {
        if (kept > 0 && span.x0 <= spans[kept - 1].x1) {
            spans[kept - 1].x1 = std::max(spans[kept - 1].x1, span.x1);
        } else {
            spans[kept++] = span;
        }
    }
    spans.resize(kept);
}

std::vector<Span> common(const std::vector<Span>& a, const std::vector<Span>& b) {
    std::vector<Span> out;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        const Span both{std::max(a[i].x0, b[j].x0), std::min(a[i].x1, b[j].x1)};
        if (both.x0 < both.x1) out.push_back(both);
        (a[i].x1 < b[j].x1 ? i : j)++;
    }
    return out;
}

std::vector<Span> gaps(const std::vector<Span>& spans, int length) {
    std::vector<Span> out;
    int from = 0;
    for (const Span& span : spans) {
        if (from < span.x0) out.push_back({from, span.x0});
        from = span.x1;
    }
    if (from < length) out.push_back({from, length});
    return out;
}

void spans_in(const Region& region, const Line& line, std::vector<Span>& out);

void spans_of_shape(const EverywhereRegion&, const Line& line, std::vector<Span>& out) { add(line, {}, out); }

// low <= the voxel's centre < high, to the same 1e-9 of a voxel as along x
bool within(double at_m, double low_m, double high_m, double pitch_m) {
    return at_m >= low_m - 1e-9 * pitch_m && at_m < high_m - 1e-9 * pitch_m;
}

void spans_of_shape(const BoxRegion& box, const Line& line, std::vector<Span>& out) {
    const double pitch_m = line.frame.pitch_m;
    if (!within(line.y_m, box.min_m[1], box.max_m[1], pitch_m)) return;
    if (!within(line.z_m, box.min_m[2], box.max_m[2], pitch_m)) return;
    add(line, {box.min_m[0], box.max_m[0]}, out);
}

void spans_of_shape(const BallRegion& ball, const Line& line, std::vector<Span>& out) {
    add(line, of_ball(ball.centre_m, ball.radius_m, line.y_m, line.z_m), out);
}

void spans_of_shape(const CylinderRegion& cylinder, const Line& line, std::vector<Span>& out) {
    add(line, of_cylinder(cylinder.from_m, cylinder.to_m, cylinder.radius_m, line.y_m, line.z_m), out);
}

void spans_of_shape(const PathRegion& path, const Line& line, std::vector<Span>& out) {
    const std::size_t n = path.points_m.size();
    for (std::size_t i = 0; i < n; ++i) {
        const bool end = i == 0 || i + 1 == n;
        if (!(end && path.flat_ends)) add(line, of_ball(path.points_m[i], path.radius_m, line.y_m, line.z_m), out);
        if (i + 1 == n) break;
        add(line, of_cylinder(path.points_m[i], path.points_m[i + 1], path.radius_m, line.y_m, line.z_m), out);
    }
}

// Says whether a place lies in a slab, to 1e-9 of a voxel.
bool in_band(const BandsRegion& bands, double place_m, double pitch_m) {
    const double at_m = place_m - bands.offset_m + 1e-9 * pitch_m;
    return at_m - bands.period_m * std::floor(at_m / bands.period_m) < bands.width_m;
}

void spans_of_shape(const BandsRegion& bands, const Line& line, std::vector<Span>& out) {
    const double pitch_m = line.frame.pitch_m;
    if (bands.axis != 0) {
        if (in_band(bands, bands.axis == 1 ? line.y_m : line.z_m, pitch_m)) add(line, {}, out);
        return;
    }
    const double low_m = line.frame.origin_m[0], high_m = low_m + pitch_m * line.length;
    if (bands.period_m < 2.0 * pitch_m) {  // voxel by voxel, however many slabs there are
        for (int x = 0; x < line.length; ++x) {
            if (in_band(bands, low_m + (x + 0.5) * pitch_m, pitch_m)) out.push_back({x, x + 1});
        }
        return;
    }
    const double first = std::floor((low_m - bands.offset_m) / bands.period_m);
    for (double n = first; bands.offset_m + n * bands.period_m < high_m; n += 1.0) {
        const double at_m = bands.offset_m + n * bands.period_m;
        add(line, {at_m, at_m + bands.width_m}, out);
    }
}

void spans_of_shape(const SolidRegion& region, const Line& line, std::vector<Span>& out) {
    // the same side of a boundary as in boxes
    const double shift_m = 1e-9 * line.frame.pitch_m;
    static thread_local std::vector<Stretch> stretches;
    stretches_of(*region.solid, region.solid->along_x, line.y_m + shift_m, line.z_m + shift_m, stretches);
    for (const Stretch& stretch : stretches) add(line, {stretch.low_m, stretch.high_m}, out);
}

void spans_of_shape(const BooleanRegion& boolean, const Line& line, std::vector<Span>& out) {
    std::vector<Span> result, part;
    for (std::size_t i = 0; i < boolean.parts.size(); ++i) {
        part.clear();
        spans_in(boolean.parts[i], line, part);
        sort_and_merge(part);
        if (i == 0) {
            result = part;
        } else if (boolean.kind == Boolean::any) {
            result.insert(result.end(), part.begin(), part.end());
            sort_and_merge(result);
        } else {
            result = common(result, boolean.kind == Boolean::all ? part : gaps(part, line.length));
        }
    }
    out.insert(out.end(), result.begin(), result.end());
}

void spans_in(const Region& region, const Line& line, std::vector<Span>& out) {
    std::visit([&](const auto& shape) { spans_of_shape(shape, line, out); }, region.shape);
}

// The box around a region, m.
struct Extent {
    Point low{-kEndless, -kEndless, -kEndless};
    Point high{kEndless, kEndless, kEndless};
};

Extent around(const std::vector<Point>& points_m, double radius_m) {
    Extent out{{kEndless, kEndless, kEndless}, {-kEndless, -kEndless, -kEndless}};
    for (const Point& point : points_m) {
        for (std::size_t c = 0; c < 3; ++c) {
            out.low[c] = std::min(out.low[c], point[c] - radius_m);
            out.high[c] = std::max(out.high[c], point[c] + radius_m);
        }
    }
    return out;
}

Extent extent_of(const Region& region);
Extent extent_of_shape(const EverywhereRegion&) { return {}; }
Extent extent_of_shape(const BandsRegion&) { return {}; }
Extent extent_of_shape(const BoxRegion& box) { return {box.min_m, box.max_m}; }
Extent extent_of_shape(const BallRegion& ball) { return around({ball.centre_m}, ball.radius_m); }
Extent extent_of_shape(const CylinderRegion& c) { return around({c.from_m, c.to_m}, c.radius_m); }
Extent extent_of_shape(const PathRegion& path) { return around(path.points_m, path.radius_m); }
Extent extent_of_shape(const SolidRegion& region) { return {region.solid->low_m, region.solid->high_m}; }
Extent extent_of_shape(const BooleanRegion& boolean) {
    if (boolean.parts.empty()) return around({}, 0.0);
    Extent out = extent_of(boolean.parts.front());
    if (boolean.kind == Boolean::without) return out;
    for (std::size_t i = 1; i < boolean.parts.size(); ++i) {
        const Extent part = extent_of(boolean.parts[i]);
        for (std::size_t c = 0; c < 3; ++c) {
            const bool any = boolean.kind == Boolean::any;
            out.low[c] = any ? std::min(out.low[c], part.low[c]) : std::max(out.low[c], part.low[c]);
            out.high[c] = any ? std::max(out.high[c], part.high[c]) : std::min(out.high[c], part.high[c]);
        }
    }
    return out;
}
Extent extent_of(const Region& region) {
    return std::visit([](const auto& shape) { return extent_of_shape(shape); }, region.shape);
}

}  // namespace

void spans_of(const Region& region, const VoxelFrame& frame, int length, int y, int z, std::vector<Span>& out) {
    out.clear();
    spans_in(
        region,
        {frame, length, frame.origin_m[1] + (y + 0.5) * frame.pitch_m, frame.origin_m[2] + (z + 0.5) * frame.pitch_m},
        out);
    sort_and_merge(out);
}

LineRange lines_of(const Region& region, const VoxelFrame& frame, int ny, int nz) {
    const Extent extent = extent_of(region);
    const auto first = [&](std::size_t c, int n) {
        return std::max(0, first_voxel(extent.low[c], frame.origin_m[c], frame.pitch_m, n) - 1);
    };
    const auto last = [&](std::size_t c, int n) {
        return std::min(n, first_voxel(extent.high[c], frame.origin_m[c], frame.pitch_m, n) + 1);
    };
    return {first(1, ny), last(1, ny), first(2, nz), last(2, nz)};
}

bool contains(const Region& region, const Point& at_m) {
    // one voxel, so fine that its centre is the point
    const VoxelFrame frame{1e-9, {at_m[0] - 0.5e-9, at_m[1] - 0.5e-9, at_m[2] - 0.5e-9}};
    std::vector<Span> spans;
    spans_of(region, frame, 1, 0, 0, spans);
    return !spans.empty();
}

}  // namespace palpa::mechanics
