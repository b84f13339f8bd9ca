#include "scene/plan.h"

#include <cmath>

#include "calibration/profile_file.h"
#include "files/text.h"

namespace palpa::scene {
namespace {

Stage calibration_stage(const Plan& plan) {
    const calibration::Profile& profile = plan.profile;
    const std::string fidelity =
        std::string(name_of(profile.curve.model)) + " curve " + profile.id + " from " + name_of(profile.level);
    if (!std::isnan(profile.median_relative_error))
        return stage_of(StageForm::calibration_fitted, fidelity,
                        {files::short_number(100.0 * profile.median_relative_error)});
    if (profile.points.empty()) return stage_of(StageForm::calibration_bare, fidelity);
    return stage_of(StageForm::calibration_with_points, fidelity, {std::to_string(profile.points.size())});
}

// A sphere of this radius or more is drawn as a fingertip, whose pulp is about as round.
constexpr double kFingertip_m = 6e-3;

void add_stages(const Scene& scene, Plan& plan) {
    const bool direct = scene.mapping.kind == MappingKind::direct;
    plan.sample_stages.push_back(calibration_stage(plan));
    plan.sample_stages.push_back(stage_of(StageForm::position, direct ? "direct" : "indirect"));
    for (const Stage& stage : stages(plan.tissue, scene))
        (stage.per_frame ? plan.frame_stages : plan.sample_stages).push_back(stage);
    add_cue_stages(scene, plan.frame_stages);
    if (scene.display_ratio) plan.grid_stages.push_back(StageId::display_ratio);
    if (scene.delay) plan.grid_stages.push_back(StageId::delay);
}

}  // namespace

Plan make_plan(const Scene& scene, const mechanics::Progress& progress) {
    Plan plan;
    plan.profile = calibration::read_profile(scene.profile);
    plan.tissue = prepare(scene.tissue, scene, progress);
    describe(plan.tissue, scene, plan);
    if (scene.mapping.tissue_m) plan.area.size_m = *scene.mapping.tissue_m;
    if (scene.surface) plan.indenter_radius_m = scene.surface->indenter_radius_m.value_or(plan.indenter_radius_m);
    if (plan.indenter == DrawnIndenter::ball && plan.indenter_radius_m >= kFingertip_m)
        plan.indenter = DrawnIndenter::fingertip;
    if (scene.surface) plan.indenter = scene.surface->indenter.value_or(plan.indenter);
    add_stages(scene, plan);
    return plan;
}

bool serves(const Plan& plan, const Scene& scene) { return serves(plan.tissue, scene); }

std::vector<std::string> notes_of(const Scene& scene, const Plan& plan) {
    std::vector<std::string> notes = plan.notes;
    if (scene.stiffness_scale != 1.0) {
        notes.push_back("the tissue's forces are multiplied by " + files::short_number(scene.stiffness_scale));
    }
    if (scene.force_scale != 1.0) {
        notes.push_back("phantom force: the pen's newtons are multiplied by " + files::short_number(scene.force_scale));
    }
    return notes;
}

}  // namespace palpa::scene
