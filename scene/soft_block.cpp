#include "scene/soft_block.h"

#include <algorithm>
#include <cmath>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "scene/plan.h"

namespace palpa::scene {
namespace {

constexpr std::array<mechanics::Law, 4> kBlockLaws{mechanics::Law::neo_hookean, mechanics::Law::neo_hookean_split,
                                                   mechanics::Law::stable_neo_hookean, mechanics::Law::corotational};

// Force over depth, converged from point to point.
ForceCurve converged_curve(const SoftBlockOptions& options, const mechanics::SpherePress& press,
                           const mechanics::Progress& progress) {
    ForceCurve curve;
    curve.greatest_depth_m = options.greatest_depth_m;
    curve.depth_m.push_back(0.0);
    curve.force_N.push_back(0.0);
    mechanics::SpherePressWork work = mechanics::make_work(press);
    for (int k = 1; k <= kCurvePoints; ++k) {
        const double depth_m = options.greatest_depth_m * k / kCurvePoints;
        const mechanics::SpherePressAnswer answer = mechanics::converge_at(press, depth_m, work);
        if (!answer.valid || !(answer.force_N > curve.force_N.back()))
            throw files::InputError("the soft block has no equilibrium at a depth of " +
                                    files::short_number(1e3 * depth_m) +
                                    " mm, expected one down to greatest_depth_mm: a smaller depth, or more cells");
        curve.depth_m.push_back(depth_m);
        curve.force_N.push_back(answer.force_N);
        if (progress.report) progress.report(k, kCurvePoints);
        if (progress.cancel != nullptr && *progress.cancel) throw mechanics::Cancelled("stopped");
    }
    return curve;
}

std::string material_text(const mechanics::LargeMaterial& material) {
    return std::string(mechanics::name_of(material.law)) + ", mu " + files::short_number(material.mu_Pa) +
           " Pa, kappa " + files::short_number(material.kappa_Pa) + " Pa";
}

}  // namespace

SoftBlockOptions read_soft_block(files::JsonReader json) {
    json.only({"size_mm", "law", "mu_Pa", "kappa_Pa", "sphere_radius_mm", "greatest_depth_mm", "cells", "finest_mm"});
    SoftBlockOptions options;
    mechanics::SpherePressBlock& block = options.block;
    if (json.has("size_mm")) {
        const auto size_mm = json.numbers("size_mm", 3, {1.0, 1e3});
        for (std::size_t axis = 0; axis < 3; ++axis) block.size_m[axis] = 1e-3 * size_mm[axis];
    }
    if (json.has("law"))
        block.material.law =
            kBlockLaws[json.choice("law", {"neo-hookean", "neo-hookean-split", "stable-neo-hookean", "corotational"})];
    block.material.mu_Pa = json.number("mu_Pa", files::kPositive);
    block.material.kappa_Pa = json.number("kappa_Pa", files::kPositive);
    block.radius_m = 1e-3 * json.number("sphere_radius_mm", {0.5, 100.0}, 1e3 * block.radius_m);
    options.greatest_depth_m =
        1e-3 * json.number("greatest_depth_mm", {0.0, 100.0, true}, 1e3 * options.greatest_depth_m);
    block.cells = json.integer("cells", 2, 12, block.cells);
    block.finest_m = 1e-3 * json.number("finest_mm", {0.05, 100.0}, 1e3 * block.finest_m);
    const double most_mm = 1e3 * std::min(0.6 * block.size_m[2], block.radius_m);
    if (1e3 * options.greatest_depth_m >= most_mm)
        json.fail("greatest_depth_mm", files::short_number(1e3 * options.greatest_depth_m),
                  "less than " + files::short_number(most_mm) + " (the sphere's radius, and 0.6 of the height)");
    if (2.0 * block.radius_m > std::min(block.size_m[0], block.size_m[1]))
        json.fail("sphere_radius_mm", files::short_number(1e3 * block.radius_m), "at most half the block's width");
    json.finish();
    return options;
}

bool takes_seconds(const SoftBlockOptions&) { return true; }
std::vector<std::filesystem::path> input_files(const SoftBlockOptions&) { return {}; }
files::Json file_hashes(const SoftBlockOptions&) { return files::Json::object(); }
std::filesystem::path map_folder(const SoftBlockOptions&) { return {}; }

SoftBlockTissue prepare(const SoftBlockOptions& options, const Scene& scene, const mechanics::Progress& progress) {
    if (scene.mapping.tissue_m)
        throw files::bad_input(scene.file.string(), "mapping.tissue_mm", "a size", "none: a soft block has its own");
    try {
        SoftBlockTissue tissue{options, mechanics::make_sphere_press(options.block, options.greatest_depth_m), {}};
        tissue.curve = converged_curve(options, tissue.press, progress);
        return tissue;
    } catch (const mechanics::SolverError& error) {
        throw files::InputError(scene.file.string() + ": " + error.what());
    }
}

bool serves(const SoftBlockTissue&, const Scene&) { return true; }

void describe(const SoftBlockTissue& tissue, const Scene& scene, Plan& plan) {
    plan.tissue_name = "soft block";
    plan.source = stiffnessmaps::SourceKind::simulated;
    describe_curve(tissue.curve, scene, plan);
    plan.indenter_radius_m = tissue.options.block.radius_m;
    plan.area.size_m = {tissue.options.block.size_m[0], tissue.options.block.size_m[1]};
    plan.area.centre_m = 0.5 * plan.area.size_m;
    plan.notes.push_back("the tissue is simulated: a soft block at large strains (" +
                         material_text(tissue.options.block.material) +
                         "), pressed in its middle wherever it is touched");
}

std::vector<Stage> stages(const SoftBlockTissue& tissue, const Scene& scene) {
    std::vector<Stage> out{
        stage_of(StageForm::depth_soft_block, std::to_string(kCurvePoints) + " converged depths of finite elements, " +
                                                  std::to_string(tissue.press.reduced.cols()) + " equations")};
    add_law_stages(scene, {}, StageForm::display_ratio_on_map, StageForm::delay_on_map, out);
    if (scene.surface) out.push_back(stage_of(StageForm::surface_sphere, "sphere on a half-space, tapered"));
    return out;
}

files::Json identity(const SoftBlockTissue& tissue) {
    const mechanics::SpherePressBlock& block = tissue.options.block;
    return {{"size_mm", {1e3 * block.size_m[0], 1e3 * block.size_m[1], 1e3 * block.size_m[2]}},
            {"law", mechanics::name_of(block.material.law)},
            {"mu_Pa", block.material.mu_Pa},
            {"kappa_Pa", block.material.kappa_Pa},
            {"sphere_radius_mm", 1e3 * block.radius_m},
            {"greatest_depth_mm", 1e3 * tissue.options.greatest_depth_m}};
}

SoftBlockWork make_work(const SoftBlockTissue& tissue) { return mechanics::make_work(tissue.press); }

void answer(const SoftBlockTissue& tissue, StageId, const Press& press, SoftBlockWork&, Contact& contact) {
    if (press.down) answer_from_curve(tissue.curve, press, contact);
}

double rise_N(const SoftBlockTissue&, const Station&, SoftBlockWork&) { return 0.0; }

void sample_surface(const SoftBlockTissue& tissue, const SurfaceEffect& effect, const Contact& contact,
                    const SoftBlockWork&, SurfaceShape& shape) {
    const double radius_m = effect.indenter_radius_m.value_or(tissue.options.block.radius_m);
    shape.curve = avatar::surface_curve(contact.depth_m, radius_m, tissue.options.block.size_m[2]);
    shape.centre_m = contact.p_m;
}

Push push_to(const SoftBlockTissue& tissue, const Eigen::Vector2d&, double depth_m, SoftBlockWork& work) {
    const mechanics::SpherePressAnswer answer = mechanics::step_to(tissue.press, depth_m, work);
    Push out;
    out.depth_m = std::min(depth_m, tissue.options.greatest_depth_m);
    out.saturated = depth_m > tissue.options.greatest_depth_m;
    out.inexact = !answer.valid;
    out.force_N = answer.valid ? answer.force_N : force_at_N(tissue.curve, depth_m);
    out.slope_N_per_m = answer.valid ? answer.slope_N_per_m : slope_at_N_per_m(tissue.curve, depth_m);
    return out;
}

}  // namespace palpa::scene
