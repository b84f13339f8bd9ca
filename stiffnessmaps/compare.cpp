#include "stiffnessmaps/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/input_error.h"
#include "files/quantile.h"
#include "files/text.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/stiffness.h"

namespace palpa::stiffnessmaps {
namespace {

std::string span_text(const Map& map) {
    const auto mm = [](double m) { return files::short_number(1e3 * m); };
    return "x " + mm(map.x_of(0)) + " to " + mm(map.x_of(map.n_x - 1)) + ", y " + mm(map.y_of(0)) + " to " +
           mm(map.y_of(map.n_y - 1)) + " mm";
}

// The indices along an axis of the places of `grid` that lie on `other`; count 0: none.
struct Range {
    std::size_t first = 0;
    std::size_t count = 0;
};
Range shared(const Map& grid, const Map& other, int axis) {
    const std::size_t n = axis == 0 ? grid.n_x : grid.n_y;
    const std::size_t n_other = axis == 0 ? other.n_x : other.n_y;
    const double half_m = 0.5 * other.spacing_m[axis] * (1.0 + 1e-9);  // a cell covers half a pitch around its point
    const double low = other.origin_m[axis] - half_m;
    const double high = other.origin_m[axis] + other.spacing_m[axis] * static_cast<double>(n_other - 1) + half_m;
    Range out;
    for (std::size_t i = 0; i < n; ++i) {
        const double at = grid.origin_m[axis] + grid.spacing_m[axis] * static_cast<double>(i);
        if (at < low || at > high) continue;
        if (out.count == 0) out.first = i;
        ++out.count;
    }
    return out;
}

constexpr double kSame = 1e-6;  // depths of one layer, written and read again, may differ by rounding

double force_or_nan(const Field& field, const Eigen::Vector2d& p_m, double depth_m) {
    const Place place = place_at(field, p_m);
    const bool known = place.inside && place.measured && depth_m <= greatest_depth_m(field, place) * (1.0 + kSame);
    return known ? normal_force_N(field, place, depth_m) : std::numeric_limits<double>::quiet_NaN();
}

DepthDifference difference(const MapDifference& d, std::size_t first, std::size_t last) {
    DepthDifference out;
    std::vector<double> sizes;
    const std::size_t cells = d.a.n_cells();
    for (std::size_t at = first * cells; at < last * cells; ++at) {
        const auto a = static_cast<double>(d.a.normal_N[at]);
        const double diff = static_cast<double>(d.b.normal_N[at]) - a;
        if (std::isnan(diff)) continue;
        ++out.n;
        out.mean_a_N += a;
        out.bias_N += diff;
        out.rms_N += diff * diff;
        sizes.push_back(std::abs(diff));
        if (sizes.size() == 1 || sizes.back() > out.greatest_N) {
            out.greatest_N = sizes.back();
            out.depth_m = d.a.depths_m[at / cells];
            out.at_x_m = d.a.x_of(at % cells % d.a.n_x);
            out.at_y_m = d.a.y_of(at % cells / d.a.n_x);
        }
    }
    const auto n = static_cast<double>(out.n);
    out.mean_a_N /= n;
    out.bias_N /= n;
    out.rms_N = std::sqrt(out.rms_N / n);
    out.median_N = files::median(sizes);
    return out;
}

void correlate(MapDifference& d) {
    double n = 0.0, sa = 0.0, sb = 0.0, saa = 0.0, sbb = 0.0, sab = 0.0;
    for (std::size_t at = 0; at < d.a.normal_N.size(); ++at) {
        const auto a = static_cast<double>(d.a.normal_N[at]);
        const auto b = static_cast<double>(d.b.normal_N[at]);
        if (std::isnan(a)) continue;
        n += 1.0;
        sa += a, sb += b, saa += a * a, sbb += b * b, sab += a * b;
    }
    const double va = n * saa - sa * sa;
    const double vb = n * sbb - sb * sb;
    d.correlation =
        va > 0.0 && vb > 0.0 ? (n * sab - sa * sb) / std::sqrt(va * vb) : std::numeric_limits<double>::quiet_NaN();
    d.relative = saa > 0.0 ? d.all.rms_N / std::sqrt(saa / n) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

MapDifference compare_maps(const Map& a, const std::string& name_a, const Map& b, const std::string& name_b) {
    MapDifference d;
    const bool b_is_coarser = b.spacing_m[0] * b.spacing_m[1] > a.spacing_m[0] * a.spacing_m[1] * (1.0 + 1e-9);
    const Map& grid = b_is_coarser ? b : a;
    const Map& other = b_is_coarser ? a : b;
    d.grid_of = b_is_coarser ? "b" : "a";
    const Range x = shared(grid, other, 0);
    const Range y = shared(grid, other, 1);
    if (x.count == 0 || y.count == 0) {
        throw files::bad_input(name_b, "", "a map of " + span_text(b),
                               "one that overlaps " + name_a + ", " + span_text(a));
    }
    const double deepest_m = std::min(a.depths_m.back(), b.depths_m.back()) * (1.0 + kSame);
    const auto depths_of = [&](const Map& map) {
        std::vector<double> out;
        std::copy_if(map.depths_m.begin(), map.depths_m.end(), std::back_inserter(out),
                     [&](double depth) { return depth <= deepest_m; });
        return out;
    };
    std::vector<double> depths_m = depths_of(a);
    d.depths_of = "a";
    if (const auto of_b = depths_of(b); depths_m.empty() || (!of_b.empty() && of_b.size() < depths_m.size())) {
        depths_m = of_b;
        d.depths_of = "b";
    }
    for (Map* out : {&d.a, &d.b}) {
        out->n_x = x.count;
        out->n_y = y.count;
        out->depths_m = depths_m;
        out->origin_m[0] = grid.x_of(x.first);
        out->origin_m[1] = grid.y_of(y.first);
        out->spacing_m[0] = grid.spacing_m[0];
        out->spacing_m[1] = grid.spacing_m[1];
    }
    d.a.name = a.name;
    d.b.name = b.name;
    const Field field_a = make_field(a, {});
    const Field field_b = make_field(b, {});
    for (const double depth_m : depths_m) {
        for (std::size_t cell = 0; cell < d.a.n_cells(); ++cell) {
            const Eigen::Vector2d p_m(d.a.x_of(cell % d.a.n_x), d.a.y_of(cell / d.a.n_x));
            double force_a = force_or_nan(field_a, p_m, depth_m);
            double force_b = force_or_nan(field_b, p_m, depth_m);
            if (std::isnan(force_a) || std::isnan(force_b))
                force_a = force_b = std::numeric_limits<double>::quiet_NaN();
            d.a.normal_N.push_back(static_cast<float>(force_a));
            d.b.normal_N.push_back(static_cast<float>(force_b));
        }
    }
    if (missing_count(d.a) == d.a.normal_N.size()) {
        throw files::bad_input(name_b, "", "no place and depth where both maps were measured",
                               "one that overlaps " + name_a);
    }
    for (std::size_t k = 0; k < depths_m.size(); ++k) {
        DepthDifference at = difference(d, k, k + 1);
        at.depth_m = depths_m[k];
        d.depths.push_back(at);
    }
    d.all = difference(d, 0, depths_m.size());
    correlate(d);
    return d;
}

}  // namespace palpa::stiffnessmaps
