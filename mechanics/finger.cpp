#include "mechanics/finger.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/error.h"
#include "mechanics/linear_range.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double kDepthTolerance = 1e-7;  // of the depth, where the search for its force ends
constexpr double kExact = 1e-6;           // of the depth: more than this is reported
constexpr double kLeastShare = 1e-6;      // of the pressure on the surface: below it the finger is beside the surface
constexpr int kMostSteps = 60;

void check_finger(const Finger& finger, const FingerLimits& limits) {
    const PadLaw& pad = finger.pad;
    if (!(finger.diameter_m > 0.0) || !std::isfinite(finger.diameter_m))
        throw LoadError(text("finger: diameter ", finger.diameter_m, " m; wanted a finite number > 0"));
    if (!(pad.young_Pa > 0.0) || !(pad.rise_Pa_per_N >= 0.0) || !(pad.poisson >= 0.0 && pad.poisson <= 0.5) ||
        !std::isfinite(pad.young_Pa) || !std::isfinite(pad.rise_Pa_per_N)) {
        throw LoadError(text("finger pad: modulus ", pad.young_Pa, " Pa rising by ", pad.rise_Pa_per_N,
                             " Pa/N, Poisson ratio ", pad.poisson, "; wanted > 0, >= 0 and from 0 to 0.5"));
    }
    if (!(limits.force_N > 0.0) || !(limits.depth_share > 0.0) || !(limits.depth_share < 1.0))
        throw LoadError(text("finger: limits of ", limits.force_N, " N and ", limits.depth_share,
                             " of the thickness; wanted > 0 and between 0 and 1"));
}

// The most nodes of an axis that a stretch of this length covers, with one more on both sides.
int most_nodes(const GridAxis& axis, double length_m) {
    int most = 2;
    for (Index i = 0; i < axis.at_m.size(); ++i) {
        const int last = cell_of(axis, axis.at_m(i) + length_m) + 1;
        most = std::max(most, last - static_cast<int>(i) + 2);
    }
    return std::min(most, static_cast<int>(axis.at_m.size()));
}

// Fills the runs and forces of the work from the nodes in contact.
void take_contact(FingerWork& w) {
    w.run.clear();
    const Contact& contact = w.contact;
    for (std::size_t k = 0; k < contact.touch.size(); ++k) {
        w.force_N(static_cast<Index>(k)) = contact.force_N[k];
        if (k > 0 && contact.touch[k] == contact.touch[k - 1] + 1)
            ++w.run.back().count;
        else
            w.run.push_back({contact.touch[k], 1, static_cast<int>(k)});
    }
}

// Returns f^T C f of the nodal forces: twice the elastic energy of the tissue.
double twice_energy_J(const Compliance& c, const FingerWork& w) {
    double sum = 0.0;
    for (const NodeRun& column : w.run) {
        for (int k = 0; k < column.count; ++k) {
            const double force_N = w.force_N(column.offset + k);
            if (force_N == 0.0) continue;
            const auto C = c.normal_m_per_N.col(column.first + k);
            double u_m = 0.0;
            for (const NodeRun& row : w.run)
                u_m += C.segment(row.first, row.count).dot(w.force_N.segment(row.offset, row.count));
            sum += force_N * u_m;
        }
    }
    return sum;
}

FingerPress none(FingerWork& w) {
    w.surface_scale = 0.0;
    return w.last = {};
}

FingerPress hold_last(FingerWork& w) {
    w.last.held = true;
    return w.last;
}

// The parabola at a place: its nodal forces and its mean depth per newton that arrives on the surface.
void place_parabola(const Compliance& c, const Finger& finger, const Vector2d& place_m, FingerWork& w) {
    if (w.load_place_m == place_m) return;
    parabola_on_grid(place_m, finger.diameter_m, w);
    w.load_place_m = place_m;
    w.depth_m_per_N = w.share > kLeastShare ? twice_energy_J(c, w) / (w.share * w.share) : 0.0;
}

double most_depth_m(const Compliance& c, const FingerWork& w) { return w.limits.depth_share * c.thickness_m; }

FingerPress press_parabola(const Compliance& c, const Finger& finger, const Vector2d& place_m, double asked_N,
                           double asked_m, FingerWork& w) {
    place_parabola(c, finger, place_m, w);
    if (!(w.depth_m_per_N > 0.0)) {
        none(w);
        w.last.over_edge = true;
        return w.last;
    }
    const double wanted_N = std::isnan(asked_N) ? asked_m / w.depth_m_per_N : asked_N;
    const double most_N = std::min(w.limits.force_N, most_depth_m(c, w) / w.depth_m_per_N);
    FingerPress out;
    out.force_N = std::min(wanted_N, most_N);
    out.depth_m = out.force_N * w.depth_m_per_N;
    out.capped = wanted_N > most_N;
    out.over_edge = w.share < 1.0 - 1e-9;
    out.linearity = linearity_ratio(out.depth_m, c.thickness_m, finger.diameter_m);
    w.surface_scale = out.force_N / w.share;
    return w.last = out;
}

// One contact of a sphere with a force.
FingerPress press_sphere(const Compliance& c, const Finger& finger, const Vector2d& place_m, double force_N,
                         FingerWork& w) {
    ContactOptions options;
    options.max_depth_m = most_depth_m(c, w);
    if (finger.contact == FingerContact::pad) {
        options.tool_compliance = &w.pad_per_m;
        options.tool_factor = 1.0 / pad_modulus_Pa(finger.pad, force_N);
        options.max_depth_m += 0.5 * finger.diameter_m;
    }
    const Indenter sphere{IndenterShape::sphere, 0.5 * finger.diameter_m};
    const double start_m = w.contact.tool.empty() ? 0.0 : w.contact.tool[0].depth_m;
    press_with_force(c, {sphere, {place_m.x(), place_m.y(), start_m}}, force_N, options, w.contact_work, w.contact);
    take_contact(w);
    const ToolForce& tool = w.contact.tool[0];
    FingerPress out;
    out.force_N = tool.normal_N;
    out.depth_m = tool.normal_N > 0.0 ? twice_energy_J(c, w) / tool.normal_N : 0.0;
    out.capped = w.contact.flags.capped;
    out.over_edge = w.contact.flags.over_edge;
    out.inexact = w.contact.flags.not_settled || (w.contact.flags.force_missed && !out.capped);
    out.linearity = linearity_ratio(out.depth_m, c.thickness_m, 2.0 * std::sqrt(tool.area_m2 / std::numbers::pi));
    w.surface_scale = 1.0;
    return w.last = out;
}

// The force of a sphere for a mean depth: a secant in logarithms, since the depth rises about as a power of the force
// (2/3 on a half-space), kept in a bracket.
FingerPress sphere_to_depth(const Compliance& c, const Finger& finger, const Vector2d& place_m, double depth_m,
                            FingerWork& w) {
    const double wanted_m = std::min(depth_m, most_depth_m(c, w));
    double low_N = 0.0;
    double high_N = w.limits.force_N;
    double force_N = std::min(w.last.force_N > 0.0 ? w.last.force_N : 0.1, high_N);
    double slope = 2.0 / 3.0;
    FingerPress before;
    for (int k = 0; k < kMostSteps; ++k) {
        FingerPress now = press_sphere(c, finger, place_m, force_N, w);
        const bool at_limit = now.depth_m < wanted_m && (force_N >= w.limits.force_N || now.capped);
        const bool met = std::abs(now.depth_m - wanted_m) <= kDepthTolerance * wanted_m;
        if (at_limit || met || !(high_N - low_N > 1e-14 * force_N)) {
            now.capped = at_limit || wanted_m < depth_m;
            now.inexact = now.inexact || (!at_limit && std::abs(now.depth_m - wanted_m) > kExact * wanted_m);
            return w.last = now;
        }
        (now.depth_m < wanted_m ? low_N : high_N) = force_N;
        if (k > 0 && now.force_N != before.force_N && now.depth_m > 0.0 && before.depth_m > 0.0) {
            const double rise = std::log(now.depth_m / before.depth_m) / std::log(now.force_N / before.force_N);
            if (rise > 0.2 && rise < 2.0) slope = rise;
        }
        before = now;
        double next_N = now.depth_m > 0.0 ? force_N * std::pow(wanted_m / now.depth_m, 1.0 / slope) : 8.0 * force_N;
        next_N = std::clamp(next_N, force_N / 64.0, 64.0 * force_N);
        if (!(next_N > low_N)) next_N = low_N > 0.0 ? 0.5 * (low_N + high_N) : 0.1 * force_N;
        if (!(next_N < high_N)) next_N = high_N == w.limits.force_N ? high_N : 0.5 * (low_N + high_N);
        force_N = next_N;
    }
    w.last.inexact = true;
    return w.last;
}

bool is_near(const Compliance& c, const Finger& finger, const Vector2d& place_m, const FingerWork& w) {
    const double R = 0.5 * finger.diameter_m;
    const auto near = [R](const GridAxis& axis, double at_m) {
        return at_m > axis.at_m(0) - R && at_m < axis.at_m(axis.at_m.size() - 1) + R;
    };
    return c.n_touch > 0 && near(w.grid.x, place_m.x()) && near(w.grid.y, place_m.y());
}

}  // namespace

FingerWork make_finger_work(const Compliance& compliance, const Finger& finger, const FingerLimits& limits,
                            int most_points) {
    check_finger(finger, limits);
    FingerWork w;
    w.grid = surface_grid(compliance);
    w.limits = limits;
    w.force_N.setZero(compliance.n_touch);
    w.corner_m.setZero(2, 4);
    w.u_m.setZero(compliance.n_touch);
    w.row_m.setZero(w.grid.x.at_m.size());
    w.stencil.reserve(2 * static_cast<std::size_t>(most_points));
    w.run.reserve(static_cast<std::size_t>(compliance.n_touch));
    if (finger.contact == FingerContact::parabola) return w;
    const int most =
        std::min(compliance.n_touch, most_nodes(w.grid.x, finger.diameter_m) * most_nodes(w.grid.y, finger.diameter_m));
    w.contact_work = make_contact_work(compliance, most);
    for (auto* list : {&w.contact.touch, &w.contact.by_tool}) list->reserve(static_cast<std::size_t>(most));
    w.contact.force_N.reserve(static_cast<std::size_t>(most));
    w.contact.tool.resize(1);
    if (finger.contact == FingerContact::pad) w.pad_per_m = half_space_kernel_per_m(w.grid);
    return w;
}

FingerPress finger_to_depth(const Compliance& compliance, const Finger& finger, const Vector2d& place_m, double depth_m,
                            FingerWork& work) {
    if (!place_m.allFinite() || !std::isfinite(depth_m)) return hold_last(work);
    if (!(depth_m > 0.0)) return none(work);
    if (!is_near(compliance, finger, place_m, work)) {
        none(work);
        work.last.over_edge = true;
        return work.last;
    }
    if (finger.contact == FingerContact::parabola) {
        constexpr double kNoForce = std::numeric_limits<double>::quiet_NaN();
        return press_parabola(compliance, finger, place_m, kNoForce, depth_m, work);
    }
    return sphere_to_depth(compliance, finger, place_m, depth_m, work);
}

FingerPress finger_with_force(const Compliance& compliance, const Finger& finger, const Vector2d& place_m,
                              double force_N, FingerWork& work) {
    if (!place_m.allFinite() || !std::isfinite(force_N)) return hold_last(work);
    if (!(force_N > 0.0)) return none(work);
    if (!is_near(compliance, finger, place_m, work)) {
        none(work);
        work.last.over_edge = true;
        return work.last;
    }
    if (finger.contact == FingerContact::parabola)
        return press_parabola(compliance, finger, place_m, force_N, 0.0, work);
    FingerPress out = press_sphere(compliance, finger, place_m, std::min(force_N, work.limits.force_N), work);
    if (out.depth_m > most_depth_m(compliance, work)) {
        out = sphere_to_depth(compliance, finger, place_m, most_depth_m(compliance, work), work);
        out.capped = true;
    }
    out.capped = out.capped || force_N > work.limits.force_N;
    return work.last = out;
}

void finger_surface_m(const Compliance& c, FingerWork& w, const Eigen::Ref<const Eigen::Matrix2Xd>& points_m,
                      Eigen::Ref<Eigen::VectorXd> out_m) {
    out_m.setZero();
    if (!(w.surface_scale > 0.0) || points_m.cols() == 0 || !points_m.allFinite()) return;
    // the nodes that the points need, as a box of the grid
    w.stencil.clear();
    int i0 = c.n_touch, i1 = 0, j0 = c.n_touch, j1 = 0;
    for (Index k = 0; k < points_m.cols(); ++k) {
        const Stencil x = stencil_at(w.grid.x, points_m(0, k));
        const Stencil y = stencil_at(w.grid.y, points_m(1, k));
        i0 = std::min(i0, x.first);
        i1 = std::max(i1, x.first + x.count);
        j0 = std::min(j0, y.first);
        j1 = std::max(j1, y.first + y.count);
        w.stencil.push_back(x);
        w.stencil.push_back(y);
    }
    const int n_x = static_cast<int>(w.grid.x.at_m.size());
    for (int j = j0; j < j1; ++j) w.u_m.segment(i0 + n_x * j, i1 - i0).setZero();
    for (const NodeRun& run : w.run) {
        for (int k = 0; k < run.count; ++k) {
            const double force_N = w.surface_scale * w.force_N(run.offset + k);
            if (force_N == 0.0) continue;
            const auto C = c.normal_m_per_N.col(run.first + k);
            for (int j = j0; j < j1; ++j)
                w.u_m.segment(i0 + n_x * j, i1 - i0) += force_N * C.segment(i0 + n_x * j, i1 - i0);
        }
    }
    // points in a row share their stencil along y
    double row_y_m = std::numeric_limits<double>::quiet_NaN();
    for (Index k = 0; k < points_m.cols(); ++k) {
        const Stencil& x = w.stencil[static_cast<std::size_t>(2 * k)];
        const Stencil& y = w.stencil[static_cast<std::size_t>(2 * k + 1)];
        if (points_m(1, k) != row_y_m) {
            row_y_m = points_m(1, k);
            w.row_m.segment(i0, i1 - i0).setZero();
            for (int b = 0; b < y.count; ++b)
                w.row_m.segment(i0, i1 - i0) += y.weight[b] * w.u_m.segment(i0 + n_x * (y.first + b), i1 - i0);
        }
        for (int a = 0; a < x.count; ++a) out_m(k) += x.weight[a] * w.row_m(x.first + a);
    }
}

void finger_pressure_Pa(const Compliance& c, FingerWork& w, const Eigen::Ref<const Eigen::Matrix2Xd>& points_m,
                        Eigen::Ref<Eigen::VectorXd> out_Pa) {
    out_Pa.setZero();
    if (!(w.surface_scale > 0.0) || !points_m.allFinite()) return;
    w.u_m.setZero();  // for a moment: the pressure of each node
    for (const NodeRun& run : w.run) {
        w.u_m.segment(run.first, run.count) = w.surface_scale * w.force_N.segment(run.offset, run.count).array() /
                                              c.area_m2.segment(run.first, run.count).array();
    }
    const auto n_x = w.grid.x.at_m.size();
    for (Index k = 0; k < points_m.cols(); ++k) {
        const int i = cell_of(w.grid.x, points_m(0, k));
        const int j = cell_of(w.grid.y, points_m(1, k));
        const double r = (points_m(0, k) - w.grid.x.at_m(i)) / (w.grid.x.at_m(i + 1) - w.grid.x.at_m(i));
        const double s = (points_m(1, k) - w.grid.y.at_m(j)) / (w.grid.y.at_m(j + 1) - w.grid.y.at_m(j));
        if (r < 0.0 || r > 1.0 || s < 0.0 || s > 1.0) continue;
        const Index node = i + n_x * j;
        out_Pa(k) = (1.0 - s) * ((1.0 - r) * w.u_m(node) + r * w.u_m(node + 1)) +
                    s * ((1.0 - r) * w.u_m(node + n_x) + r * w.u_m(node + n_x + 1));
    }
}

}  // namespace palpa::mechanics
