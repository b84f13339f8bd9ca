#include "accuracy/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "files/text.h"
#include "scene/advance.h"

namespace palpa::accuracy {
namespace {

constexpr double kBefore_m = 15e-3;  // of a stroke, before the place that it goes through,
constexpr double kAfter_m = 9e-3;    // and after it
constexpr int kGrid = 6;             // places beside the nodules along x and along y

const std::array<Eigen::Vector2d, 4> kDirections{Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, 1),
                                                 Eigen::Vector2d(0, -1)};

bool stays_on(const Stroke& stroke, const scene::TissueArea& area, double margin_m = 0.0) {
    const auto inside = [&](const Eigen::Vector2d& p_m) {
        return ((p_m - area.centre_m).cwiseAbs() - 0.5 * area.size_m).maxCoeff() < -margin_m;
    };
    return inside(stroke.through_m - kBefore_m * stroke.along) && inside(stroke.through_m + kAfter_m * stroke.along);
}

// Returns the stroke in the first of the four directions in which it stays on the tissue; nothing otherwise.
std::optional<Stroke> stroke_through(const stiffnessmaps::Nodule& nodule, const scene::TissueArea& area) {
    Stroke stroke{nodule.id, {nodule.x_m, nodule.y_m}, {}};
    for (const Eigen::Vector2d& along : kDirections) {
        stroke.along = along;
        if (stays_on(stroke, area)) return stroke;
    }
    return std::nullopt;
}

// Returns the distance from a nodule's centre from which on a stroke is beside it.
double away_m(const stiffnessmaps::Nodule& nodule, const scene::Plan& plan) {
    return 0.5 * nodule.diameter_m.value_or(0.0) + 4.0 * plan.indenter_radius_m;
}

double distance_m(const Eigen::Vector2d& p_m, const Stroke& stroke) {
    const Eigen::Vector2d off_m = p_m - stroke.through_m;
    const double s_m = std::clamp(off_m.dot(stroke.along), -kBefore_m, kAfter_m);
    return (off_m - s_m * stroke.along).norm();
}

// Keeps away from the nodules, and from the edges, where any block gives way more than the level tissue that it is compared
// with.
bool keeps_away(const Stroke& stroke, const scene::Plan& plan) {
    if (!stays_on(stroke, plan.area, 4.0 * plan.indenter_radius_m)) return false;
    return std::none_of(plan.nodules.begin(), plan.nodules.end(), [&](const stiffnessmaps::Nodule& nodule) {
        return distance_m({nodule.x_m, nodule.y_m}, stroke) < away_m(nodule, plan);
    });
}

bool is_seen(double arcmin, const Threshold& threshold, const VisibilityOptions& options) {
    return arcmin >= arcmin_of(threshold, options);
}

// Returns the one beside the nodules that moved most; null if there is none.
const Seen* most_beside(const std::vector<Seen>& seen) {
    const Seen* most = nullptr;
    for (const Seen& one : seen)
        if (one.stroke.nodule.empty() && (most == nullptr || one.motion_arcmin > most->motion_arcmin)) most = &one;
    return most;
}

double greatest_lag_beside_m(const std::vector<Seen>& seen) {
    double lag_m = 0.0;
    for (const Seen& one : seen)
        if (one.stroke.nodule.empty()) lag_m = std::max(lag_m, one.difference.lag_m);
    return lag_m;
}

}  // namespace

double arcmin_of(double length_m, double distance_m) {
    return 60.0 * 180.0 / std::numbers::pi * std::atan2(length_m, distance_m);
}

double arcmin_of(const Threshold& threshold, const VisibilityOptions& options) {
    return arcmin_of(threshold.latency_s * options.speed_m_per_s, options.distance_m);
}

std::vector<Stroke> strokes_over(const scene::Plan& plan) {
    std::vector<Stroke> out;
    for (const stiffnessmaps::Nodule& nodule : plan.nodules) {
        if (auto stroke = stroke_through(nodule, plan.area)) out.push_back(*stroke);
    }
    for (const stiffnessmaps::Nodule& nodule : plan.nodules) {
        for (const Eigen::Vector2d& along : kDirections) {
            const double stop_m = kAfter_m + (1.0 + 1e-9) * away_m(nodule, plan);
            const Stroke stroke{"", Eigen::Vector2d(nodule.x_m, nodule.y_m) - stop_m * along, along};
            if (keeps_away(stroke, plan)) out.push_back(stroke);
        }
    }
    const Eigen::Vector2d low_m = plan.area.centre_m - 0.5 * plan.area.size_m;
    for (int j = 1; j <= kGrid; ++j) {
        for (int i = 1; i <= kGrid; ++i) {
            const Eigen::Vector2d share = Eigen::Vector2d(i, j) / (kGrid + 1.0);
            const Stroke stroke{"", low_m + share.cwiseProduct(plan.area.size_m), Eigen::Vector2d::UnitX()};
            if (keeps_away(stroke, plan)) out.push_back(stroke);
        }
    }
    return out;
}

std::vector<platform::Sample> samples_of(const Stroke& stroke, const scene::Scene& scene, const scene::Plan& plan,
                                         const scene::View& view, const VisibilityOptions& options) {
    std::vector<platform::Sample> out;
    const int n = static_cast<int>((kBefore_m + kAfter_m) / options.speed_m_per_s * options.rate_Hz);
    for (int i = 0; i <= n; ++i) {
        platform::Sample sample;
        sample.t_host_s = sample.t_device_s = i / options.rate_Hz;
        sample.pointer_id = 1;
        sample.tool = options.tool;
        sample.phase = i == 0 ? platform::Phase::down : platform::Phase::move;
        const Eigen::Vector2d p_m =
            stroke.through_m + (i / options.rate_Hz * options.speed_m_per_s - kBefore_m) * stroke.along;
        const Eigen::Vector2d screen_m = view.axes * (p_m - view.area.centre_m);
        const Eigen::Vector2d px = view.centre_px + screen_m.cwiseProduct(view.input_px_per_m);
        sample.x_px = px.x();
        sample.y_px = px.y();
        set_level(plan.profile, calibration::level_at_force(plan.profile, options.force_N / scene.force_scale), sample);
        out.push_back(sample);
    }
    return out;
}

Difference difference_of(const std::vector<platform::Sample>& samples, const scene::Scene& scene,
                         const scene::Plan& with, const scene::Plan& without, const scene::ScreenArea& screen) {
    Difference out;
    scene::State a = scene::start(scene, with, screen);
    scene::State b = scene::start(scene, without, screen);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        scene::advance(scene, with, samples[i], a);
        scene::advance(scene, without, samples[i], b);
        out.beyond = out.beyond || a.contact.saturated || b.contact.saturated;
        out.lag_m = std::max(out.lag_m, scene::seen_lag_m(a.avatar));
        const double apart_m = (a.avatar.lag_m + a.avatar.texture_m - b.avatar.lag_m - b.avatar.texture_m).norm();
        if (apart_m > out.apart_m) {
            out.apart_m = apart_m;
            out.apart_at = i;
        }
        out.sunk_m = std::max(out.sunk_m, std::abs(a.contact.depth_m - b.contact.depth_m));
        if (!(b.contact.depth_m > 0.0)) continue;
        const double share = std::abs(a.contact.depth_m / b.contact.depth_m - 1.0);
        if (share > out.depth_share) {
            out.depth_share = share;
            out.depth_at = i;
        }
    }
    return out;
}

std::vector<std::string> nodules_left_out(const scene::Plan& plan, const std::vector<Seen>& seen) {
    std::vector<std::string> out;
    for (const stiffnessmaps::Nodule& nodule : plan.nodules) {
        const auto same = [&](const Seen& one) { return one.stroke.nodule == nodule.id; };
        if (std::none_of(seen.begin(), seen.end(), same)) out.push_back(nodule.id);
    }
    return out;
}

files::Json visibility_json(const std::vector<Seen>& seen, const std::vector<std::string>& left_out,
                            const VisibilityOptions& options) {
    files::Json json{{"force_N", options.force_N},
                     {"speed_mm_per_s", 1e3 * options.speed_m_per_s},
                     {"distance_cm", 100.0 * options.distance_m},
                     {"thresholds", files::Json::array()},
                     {"nodules", files::Json::array()}};
    for (const Threshold* threshold : {&kMayBeSeen, &kIsSeen}) {
        json["thresholds"].push_back({{"name", threshold->name},
                                      {"source", threshold->source},
                                      {"latency_ms", 1e3 * threshold->latency_s},
                                      {"arcmin", arcmin_of(*threshold, options)}});
    }
    for (const Seen& one : seen) {
        if (one.stroke.nodule.empty()) continue;
        json["nodules"].push_back({{"id", one.stroke.nodule},
                                   {"lag_mm", 1e3 * one.difference.lag_m},
                                   {"depth_change", one.difference.depth_share},
                                   {"beyond_known_depth", one.difference.beyond},
                                   {"motion_px", one.motion_px},
                                   {"motion_arcmin", one.motion_arcmin},
                                   {"visible", is_seen(one.motion_arcmin, kIsSeen, options)}});
    }
    json["nodules_left_out"] = left_out;
    if (const Seen* most = most_beside(seen)) {
        json["beside_lag_mm"] = 1e3 * greatest_lag_beside_m(seen);
        json["beside_px"] = most->motion_px;
        json["beside_arcmin"] = most->motion_arcmin;
        json["beside_visible"] = is_seen(most->motion_arcmin, kMayBeSeen, options);
    }
    return json;
}

std::string visibility_table(const std::vector<Seen>& seen, const std::vector<std::string>& left_out,
                             const VisibilityOptions& options) {
    const auto text = [](double value) { return files::short_number(value); };
    std::string out;
    for (const Seen& one : seen) {
        if (one.stroke.nodule.empty()) continue;
        out +=
            "nodule " + one.stroke.nodule + ": lag " + text(1e3 * one.difference.lag_m) + " mm, seen motion " +
            text(one.motion_px) + " px, " + text(one.motion_arcmin) +
            " arcmin: " + (is_seen(one.motion_arcmin, kIsSeen, options) ? "visible" : "not visible") +
            "; depth changes by " + text(100.0 * one.difference.depth_share) + " %" +
            (one.difference.beyond ? "; pressed beyond the known depth, where it stays: a smaller --force-N is needed"
                                   : "") +
            "\n";
    }
    for (const std::string& nodule : left_out) {
        out += "nodule " + nodule + ": not judged, since a stroke of " + text(1e3 * (kBefore_m + kAfter_m)) +
               " mm through it leaves the tissue\n";
    }
    if (const Seen* most = most_beside(seen)) {
        out += "beside the nodules: lag " + text(1e3 * greatest_lag_beside_m(seen)) + " mm, seen motion " +
               text(most->motion_px) + " px, " + text(most->motion_arcmin) +
               " arcmin: " + (is_seen(most->motion_arcmin, kMayBeSeen, options) ? "may be visible" : "not visible") +
               "\n";
    }
    for (const Threshold* threshold : {&kMayBeSeen, &kIsSeen}) {
        out += text(arcmin_of(*threshold, options)) + " arcmin: " + threshold->name + " (" + threshold->source + ")\n";
    }
    return out + text(100.0 * kComplianceWeber) +
           " %: change of compliance told apart by touch and sight (Bergmann Tiest & Kappers 2009)\n";
}

}  // namespace palpa::accuracy
