#include "tactile/renderer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mechanics/error.h"
#include "mechanics/linear_range.h"
#include "tactile/table.h"

namespace palpa::tactile {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using mechanics::FingerLimits;

FingerLimits limits_of(const Renderer& r) { return {r.force_limit_N / r.stiffness_scale, FingerLimits{}.depth_share}; }

void check_numbers(double stiffness_scale, double force_limit_N) {
    if (stiffness_scale > 0.0 && std::isfinite(stiffness_scale) && force_limit_N > 0.0 && std::isfinite(force_limit_N))
        return;
    throw mechanics::LoadError("renderer: stiffness scale " + std::to_string(stiffness_scale) + ", force limit " +
                               std::to_string(force_limit_N) + " N; wanted finite numbers > 0");
}

void check_curve(const DepthForce& curve) {
    bool rising = !curve.depth_m.empty() && curve.depth_m.size() == curve.force_N.size();
    double depth_m = 0.0;
    double force_N = 0.0;
    for (std::size_t k = 0; rising && k < curve.depth_m.size(); ++k) {
        rising = curve.depth_m[k] > depth_m && curve.force_N[k] > force_N && std::isfinite(curve.depth_m[k]) &&
                 std::isfinite(curve.force_N[k]);
        depth_m = curve.depth_m[k];
        force_N = curve.force_N[k];
    }
    if (rising) return;
    throw mechanics::LoadError("force curve: " + std::to_string(curve.depth_m.size()) + " depths and " +
                               std::to_string(curve.force_N.size()) +
                               " forces; wanted as many of both, at least one, each greater than 0 and than the last");
}

// Linear between (0, 0) and the points of one list as function of the other; NaN beyond the last.
double between(const std::vector<double>& from, const std::vector<double>& to, double at) {
    const auto above = std::lower_bound(from.begin(), from.end(), at);
    if (above == from.end()) return std::numeric_limits<double>::quiet_NaN();
    const auto k = static_cast<std::size_t>(above - from.begin());
    const double from_0 = k > 0 ? from[k - 1] : 0.0;
    const double to_0 = k > 0 ? to[k - 1] : 0.0;
    return to_0 + (at - from_0) / (from[k] - from_0) * (to[k] - to_0);
}

// The answer of a curve, before stiffness_scale.
Press press_curve(const Renderer& r, double asked_m, double asked_N) {
    const DepthForce& curve = r.depth_force;
    const double limit_N = r.force_limit_N / r.stiffness_scale;
    Press out;
    out.force_N = std::isnan(asked_N) ? between(curve.depth_m, curve.force_N, asked_m) : asked_N;
    const double most_N = std::min(limit_N, curve.force_N.back());
    if (!(out.force_N <= most_N)) {
        out.force_N = most_N;
        out.capped = true;
    }
    out.depth_m = between(curve.force_N, curve.depth_m, out.force_N);
    return out;
}

// The answer of the table, before stiffness_scale. Returns false if it cannot answer.
bool press_table(const Renderer& r, const Vector2d& place_m, double asked_m, double asked_N, RendererWork& w,
                 Press& out) {
    if (!w.table || !find_place(*w.table, place_m, w.at)) return false;
    const Table& table = *w.table;
    const FingerLimits limits = limits_of(r);
    const double most_m = limits.depth_share * r.compliance->thickness_m;
    out = {};
    out.force_N = std::isnan(asked_N) ? table_force_N(table, std::min(asked_m, most_m), w.at) : asked_N;
    out.capped = out.force_N > limits.force_N || (std::isnan(asked_N) && asked_m > most_m);
    if (std::isnan(out.force_N)) {
        // deeper than the last force: that is the limit, or the rest is answered live
        if (table.force_N.back() < limits.force_N) return false;
        out.force_N = limits.force_N;
        out.capped = true;
    }
    out.force_N = std::min(out.force_N, limits.force_N);
    if (!table.linear && out.force_N > table.force_N.back()) return false;
    out.depth_m = table_depth_m(table, out.force_N, w.at);
    if (out.depth_m > most_m) {
        out.force_N = table_force_N(table, most_m, w.at);
        out.depth_m = most_m;
        out.capped = true;
    }
    out.linearity = table.linear
                        ? mechanics::linearity_ratio(out.depth_m, r.compliance->thickness_m, r.finger.diameter_m)
                        : table_linearity(table, w.at);
    return true;
}

Press press(const Renderer& r, const Vector2d& place_m, double asked_m, double asked_N, RendererWork& w) {
    const double asked = std::isnan(asked_N) ? asked_m : asked_N / r.stiffness_scale;
    const bool by_depth = std::isnan(asked_N);
    if (!place_m.allFinite() || !std::isfinite(asked)) {
        w.last.held = true;
        return w.last;
    }
    const double force_N = by_depth ? asked_N : asked;
    w.place_m = place_m;
    w.from_table = false;
    Press out;
    if (!(asked > 0.0)) {
        if (r.compliance) out = mechanics::finger_to_depth(*r.compliance, r.finger, place_m, 0.0, w.finger);
    } else if (!r.compliance) {
        out = press_curve(r, asked_m, force_N);
    } else if (press_table(r, place_m, asked_m, force_N, w, out)) {
        w.from_table = true;
    } else if (by_depth) {
        out = mechanics::finger_to_depth(*r.compliance, r.finger, place_m, asked_m, w.finger);
    } else {
        out = mechanics::finger_with_force(*r.compliance, r.finger, place_m, force_N, w.finger);
    }
    out.force_N *= r.stiffness_scale;
    return w.last = out;
}

// Makes sure that w.finger holds the last press.
void press_live(const Renderer& r, RendererWork& w) {
    if (!w.from_table) return;
    mechanics::finger_with_force(*r.compliance, r.finger, w.place_m, w.last.force_N / r.stiffness_scale, w.finger);
}

}  // namespace

Renderer make_renderer(const scene::LinearTissue& tissue, const Finger& finger, double stiffness_scale,
                       double force_limit_N, Observation observed) {
    check_numbers(stiffness_scale, force_limit_N);
    Renderer r;
    r.compliance = &tissue.compliance;
    r.finger = finger;
    r.finger.pad = mechanics::scaled(finger.pad, stiffness_scale);
    r.stiffness_scale = stiffness_scale;
    r.force_limit_N = force_limit_N;
    r.observed = std::move(observed);
    r.content = tissue.content;
    return r;
}

Renderer make_renderer(DepthForce curve, double stiffness_scale, double force_limit_N) {
    check_numbers(stiffness_scale, force_limit_N);
    check_curve(curve);
    Renderer r;
    r.depth_force = std::move(curve);
    r.stiffness_scale = stiffness_scale;
    r.force_limit_N = force_limit_N;
    return r;
}

Observation observation_of(const mechanics::PinShape& shape) { return {shape.sample_m, shape.inverse}; }

RendererWork make_work(const Renderer& renderer) {
    RendererWork w;
    const Index n = renderer.observed.points_m.cols();
    if (renderer.compliance) {
        constexpr int kPicture = 4096;  // points of surface_m(), beside those observed
        w.finger = mechanics::make_finger_work(*renderer.compliance, renderer.finger, limits_of(renderer),
                                               std::max(kPicture, static_cast<int>(n)));
    }
    w.points_m.setZero(2, n);
    w.u_m.setZero(n);
    return w;
}

void adopt(const Table* table, RendererWork& work) { work.table = table; }

Press press_to_depth(const Renderer& renderer, const Vector2d& place_m, double depth_m, RendererWork& work) {
    return press(renderer, place_m, depth_m, std::numeric_limits<double>::quiet_NaN(), work);
}

Press press_with_force(const Renderer& renderer, const Vector2d& place_m, double force_N, RendererWork& work) {
    // a NaN force must not be taken for "by depth"
    if (std::isnan(force_N)) force_N = std::numeric_limits<double>::infinity();
    return press(renderer, place_m, 0.0, force_N, work);
}

void shape_m(const Renderer& r, RendererWork& w, Eigen::Ref<Eigen::VectorXd> out_m) {
    if (!r.compliance || !(w.last.force_N > 0.0)) {
        out_m.setZero();
        return;
    }
    if (w.from_table) return table_shape_m(*w.table, w.at, out_m);
    w.points_m = r.observed.points_m.colwise() + w.place_m;
    if (r.observed.map.size() == 0) return mechanics::finger_surface_m(*r.compliance, w.finger, w.points_m, out_m);
    mechanics::finger_surface_m(*r.compliance, w.finger, w.points_m, w.u_m);
    out_m.noalias() = r.observed.map * w.u_m;
}

void surface_m(const Renderer& r, RendererWork& w, const Eigen::Matrix2Xd& points_m,
               Eigen::Ref<Eigen::VectorXd> out_m) {
    out_m.setZero();
    if (!r.compliance || !(w.last.force_N > 0.0)) return;
    press_live(r, w);
    mechanics::finger_surface_m(*r.compliance, w.finger, points_m.colwise() + w.place_m, out_m);
}

void pressure_Pa(const Renderer& r, RendererWork& w, const Eigen::Matrix2Xd& points_m,
                 Eigen::Ref<Eigen::VectorXd> out_Pa) {
    out_Pa.setZero();
    if (!r.compliance || !(w.last.force_N > 0.0)) return;
    press_live(r, w);
    mechanics::finger_pressure_Pa(*r.compliance, w.finger, points_m.colwise() + w.place_m, out_Pa);
    out_Pa *= r.stiffness_scale;
}

}  // namespace palpa::tactile
