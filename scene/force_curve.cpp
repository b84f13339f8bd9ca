#include "scene/force_curve.h"

#include <algorithm>
#include <cmath>

#include "files/text.h"
#include "scene/plan.h"

namespace palpa::scene {
namespace {

constexpr double kThird = 1.0 / 3.0;

// The piece of the points that holds a depth: its end.
std::size_t end_of_piece(const std::vector<double>& rising, double value) {
    const auto at = std::upper_bound(rising.begin() + 1, rising.end() - 1, value);
    return static_cast<std::size_t>(at - rising.begin());
}

void read_points(files::JsonReader& json, ForceCurve& curve) {
    const std::vector<double> depth_mm = json.numbers("depth_mm", 0, {0.0, 200.0, true});
    const std::vector<double> force_N = json.numbers("force_N", depth_mm.size(), {0.0, 1e3, true});
    curve.depth_m.push_back(0.0);
    curve.force_N.push_back(0.0);
    for (std::size_t i = 0; i < depth_mm.size(); ++i) {
        if (1e-3 * depth_mm[i] <= curve.depth_m.back())
            json.fail("depth_mm", files::short_number(depth_mm[i]) + " at place " + std::to_string(i + 1),
                      "depths that rise");
        if (force_N[i] <= curve.force_N.back())
            json.fail("force_N", files::short_number(force_N[i]) + " at place " + std::to_string(i + 1),
                      "forces that rise with depth");
        curve.depth_m.push_back(1e-3 * depth_mm[i]);
        curve.force_N.push_back(force_N[i]);
    }
    curve.greatest_depth_m = curve.depth_m.back();
}

std::string curve_text(const ForceCurve& curve) {
    if (!curve.depth_m.empty()) return std::to_string(curve.depth_m.size() - 1) + " points of force over depth";
    std::string text = files::short_number(1e-3 * curve.stiffness_N_per_m) + " N/mm";
    if (std::isfinite(curve.growth_m))
        text += ", growing with exp(depth / " + files::short_number(1e3 * curve.growth_m) + " mm)";
    return text;
}

}  // namespace

double force_at_N(const ForceCurve& curve, double depth_m) noexcept {
    const double d = std::clamp(depth_m, 0.0, curve.greatest_depth_m);
    if (curve.depth_m.empty()) return curve.stiffness_N_per_m * d * std::exp(d / curve.growth_m);
    const std::size_t k = end_of_piece(curve.depth_m, d);
    return curve.force_N[k - 1] + slope_at_N_per_m(curve, d) * (d - curve.depth_m[k - 1]);
}

double slope_at_N_per_m(const ForceCurve& curve, double depth_m) noexcept {
    const double d = std::clamp(depth_m, 0.0, curve.greatest_depth_m);
    if (curve.depth_m.empty())
        return curve.stiffness_N_per_m * std::exp(d / curve.growth_m) * (1.0 + d / curve.growth_m);
    const std::size_t k = end_of_piece(curve.depth_m, d);
    return (curve.force_N[k] - curve.force_N[k - 1]) / (curve.depth_m[k] - curve.depth_m[k - 1]);
}

double depth_of_m(const ForceCurve& curve, double force_N) noexcept {
    if (!(force_N > 0.0)) return 0.0;
    if (force_N >= force_at_N(curve, curve.greatest_depth_m)) return curve.greatest_depth_m;
    if (!curve.depth_m.empty()) {
        const std::size_t k = end_of_piece(curve.force_N, force_N);
        const double share = (force_N - curve.force_N[k - 1]) / (curve.force_N[k] - curve.force_N[k - 1]);
        return curve.depth_m[k - 1] + share * (curve.depth_m[k] - curve.depth_m[k - 1]);
    }
    // The force is convex over depth, so that Newton's method from above it falls to the depth and never passes it.
    double d = std::min(curve.greatest_depth_m, force_N / curve.stiffness_N_per_m);
    for (int i = 0; i < 60; ++i) {
        const double step_m = (force_at_N(curve, d) - force_N) / slope_at_N_per_m(curve, d);
        d -= step_m;
        if (std::abs(step_m) <= 1e-13 * curve.greatest_depth_m) break;
    }
    return d;
}

ForceCurveOptions read_force_curve(files::JsonReader json) {
    json.only({"stiffness_N_per_mm", "growth_mm", "greatest_depth_mm", "depth_mm", "force_N", "indenter_radius_mm"});
    ForceCurveOptions options;
    const bool law = json.has("stiffness_N_per_mm");
    if (law == json.has("depth_mm"))
        json.fail("", law ? "a law and points" : "neither a law nor points",
                  "stiffness_N_per_mm, or depth_mm with force_N");
    if (law) {
        options.curve.stiffness_N_per_m = 1e3 * json.number("stiffness_N_per_mm", {0.0, 1e4, true});
        if (json.has("growth_mm")) options.curve.growth_m = 1e-3 * json.number("growth_mm", {0.1, 1e4});
        options.curve.greatest_depth_m =
            1e-3 * json.number("greatest_depth_mm", {0.0, 200.0, true}, 1e3 * options.curve.greatest_depth_m);
        if (options.curve.greatest_depth_m > 100.0 * options.curve.growth_m)
            json.fail("growth_mm", files::short_number(1e3 * options.curve.growth_m),
                      "at least a hundredth of greatest_depth_mm");
    } else {
        read_points(json, options.curve);
    }
    options.indenter_radius_m =
        1e-3 * json.number("indenter_radius_mm", {0.0, 100.0, true}, 1e3 * options.indenter_radius_m);
    json.finish();
    return options;
}

bool takes_seconds(const ForceCurveOptions&) { return false; }
std::vector<std::filesystem::path> input_files(const ForceCurveOptions&) { return {}; }
files::Json file_hashes(const ForceCurveOptions&) { return files::Json::object(); }
std::filesystem::path map_folder(const ForceCurveOptions&) { return {}; }

ForceCurveTissue prepare(const ForceCurveOptions& options, const Scene&, const mechanics::Progress&) {
    return {options};
}

bool serves(const ForceCurveTissue&, const Scene&) { return true; }

void describe_curve(const ForceCurve& curve, const Scene& scene, Plan& plan) {
    plan.greatest_force_N = scene.stiffness_scale * force_at_N(curve, curve.greatest_depth_m);
    plan.known_N = plan.greatest_force_N;
    plan.greatest_depth_m = curve.greatest_depth_m;
    for (const int third : {1, 2})
        plan.zone_N[static_cast<std::size_t>(third - 1)] =
            scene.stiffness_scale * force_at_N(curve, third * kThird * plan.greatest_depth_m);
}

void describe(const ForceCurveTissue& tissue, const Scene& scene, Plan& plan) {
    plan.tissue_name = "force curve";
    plan.source = stiffnessmaps::SourceKind::analytic;
    describe_curve(tissue.options.curve, scene, plan);
    plan.indenter_radius_m = tissue.options.indenter_radius_m;
    plan.area.size_m = tissue.options.size_m;
    plan.area.centre_m = 0.5 * plan.area.size_m;
    plan.notes.push_back("the tissue is one force over depth everywhere (" + curve_text(tissue.options.curve) +
                         "): nothing resists motion along it");
}

std::vector<Stage> stages(const ForceCurveTissue& tissue, const Scene& scene) {
    std::vector<Stage> out{stage_of(StageForm::depth_force_curve, curve_text(tissue.options.curve))};
    add_law_stages(scene, {}, StageForm::display_ratio_on_map, StageForm::delay_on_map, out);
    if (scene.surface) out.push_back(stage_of(StageForm::surface_sphere, "sphere on a half-space, tapered"));
    return out;
}

files::Json identity(const ForceCurveTissue& tissue) {
    const ForceCurve& curve = tissue.options.curve;
    if (curve.depth_m.empty())
        return {{"stiffness_N_per_mm", 1e-3 * curve.stiffness_N_per_m},
                {"growth_mm", files::number_or_null(1e3 * curve.growth_m)},
                {"greatest_depth_mm", 1e3 * curve.greatest_depth_m}};
    std::vector<double> depth_mm;
    for (const double d : curve.depth_m) depth_mm.push_back(1e3 * d);
    return {{"depth_mm", depth_mm}, {"force_N", curve.force_N}};
}

ForceCurveWork make_work(const ForceCurveTissue&) { return {}; }

void answer_from_curve(const ForceCurve& curve, const Press& press, Contact& contact) {
    const double force_N = press.force_N / press.stiffness_scale;
    contact.depth_m = depth_of_m(curve, force_N);
    contact.saturated = force_N > force_at_N(curve, curve.greatest_depth_m);
}

void answer(const ForceCurveTissue& tissue, StageId, const Press& press, ForceCurveWork&, Contact& contact) {
    if (press.down) answer_from_curve(tissue.options.curve, press, contact);
}

double rise_N(const ForceCurveTissue&, const Station&, ForceCurveWork&) { return 0.0; }

void sample_surface(const ForceCurveTissue& tissue, const SurfaceEffect& effect, const Contact& contact,
                    const ForceCurveWork&, SurfaceShape& shape) {
    const double radius_m = effect.indenter_radius_m.value_or(tissue.options.indenter_radius_m);
    shape.curve = avatar::surface_curve(contact.depth_m, radius_m, effect.thickness_m);
    shape.centre_m = contact.p_m;
}

Push push_to(const ForceCurveTissue& tissue, const Eigen::Vector2d&, double depth_m, ForceCurveWork&) {
    const ForceCurve& curve = tissue.options.curve;
    Push out;
    out.depth_m = std::min(depth_m, curve.greatest_depth_m);
    out.force_N = force_at_N(curve, depth_m);
    out.slope_N_per_m = slope_at_N_per_m(curve, depth_m);
    out.saturated = depth_m > curve.greatest_depth_m;
    return out;
}

}  // namespace palpa::scene
