#include "session/log_rows.h"

#include <cmath>

#include "calibration/profile_file.h"
#include "files/text.h"
#include "scene/plan.h"

namespace palpa::session {

namespace {

void add_cues(const scene::Scene& scene, const scene::Plan& plan, const scene::State& state, study::SampleRow& row) {
    const double depth_m = state.touch.down ? state.contact.depth_m : 0.0;
    const scene::CueValues values = scene::cues_at(scene.cues, plan.indenter_radius_m, depth_m);
    if (scene.cues.footprint > 0.0) row.footprint_mm = 1e3 * values.footprint_m;
    if (scene.cues.crease > 0.0) row.crease = values.crease;
    if (scene.cues.depth_gain > 0.0) row.drawn_depth_mm = 1e3 * values.drawn_depth_m;
}

}  // namespace

study::SampleRow row_of(const platform::Sample& sample, const scene::Scene& scene, const scene::Plan& plan,
                        const scene::State& state) {
    study::SampleRow row;
    row.t_host_s = sample.t_host_s;
    row.t_device_s = sample.t_device_s;
    row.pointer_id = sample.pointer_id;
    row.tool = name_of(sample.tool);
    row.phase = name_of(sample.phase);
    row.pressure = sample.pressure;
    if (!state.answered) return row;
    row.x_mm = 1e3 * state.touch.p_m.x();
    row.y_mm = 1e3 * state.touch.p_m.y();
    row.force_N = state.contact.normal_N;
    row.depth_mm = 1e3 * state.contact.depth_m;
    row.tangential_N = state.contact.tangential_N;
    row.avatar_x_mm = 1e3 * state.avatar.p_m.x();
    row.avatar_y_mm = 1e3 * state.avatar.p_m.y();
    row.lag_mm = 1e3 * state.avatar.lag_m.norm();
    row.delay_ms = 1e3 * state.avatar.delay_s;
    row.texture_mm = 1e3 * state.avatar.texture_m.norm();
    row.saturated = state.contact.saturated;
    row.ft_source = state.contact.measured ? plan.tangential_source : "none";
    add_cues(scene, plan, state, row);
    return row;
}

files::Json settings_json(const scene::Scene& scene, const scene::Plan& plan, const scene::State& state) {
    files::Json json;
    json["program"] = "palpa " PALPA_VERSION;
    json["scene"]["name"] = scene.name;
    if (!scene.file.empty()) json["scene"]["file"] = files::read_json(scene.file);
    json["scene"]["force_scale"] = scene.force_scale;
    json["scene"]["stiffness_scale"] = scene.stiffness_scale;
    json["scene"]["seed"] = scene.seed;
    json["tissue"] = {{"name", plan.tissue_name}, {"source", name_of(plan.source)}};
    json["tissue"].update(scene::identity(plan.tissue));
    json["profile"] = {{"id", plan.profile.id}, {"model", name_of(plan.profile.curve.model)}};
    json["profile"].update(calibration::parameters_json(plan.profile.curve));
    json["tissue_area_px"] = {state.screen.x_px, state.screen.y_px, state.screen.width_px, state.screen.height_px};
    if (std::isfinite(state.screen.px_per_m)) json["screen_px_per_mm"] = 1e-3 * state.screen.px_per_m;
    json["mapping"] = {{"rotate_deg", scene.mapping.rotate_deg}, {"flip", scene.mapping.flip}};
    json["stages"] = files::Json::array();
    for (const auto* stages : {&plan.sample_stages, &plan.frame_stages}) {
        for (const scene::Stage& stage : *stages) {
            json["stages"].push_back({{"name", name_of(stage.id)}, {"fidelity", stage.fidelity}});
        }
    }
    json["nodules"] = files::Json::array();
    for (const stiffnessmaps::Nodule& nodule : plan.nodules) {
        json["nodules"].push_back({{"id", nodule.id}, {"x_mm", 1e3 * nodule.x_m}, {"y_mm", 1e3 * nodule.y_m}});
        files::Json& written = json["nodules"].back();
        if (nodule.diameter_m) written["diameter_mm"] = 1e3 * *nodule.diameter_m;
        if (nodule.length_m) written["length_mm"] = 1e3 * *nodule.length_m;
        if (nodule.angle_deg) written["angle_deg"] = *nodule.angle_deg;
    }
    json["notes"] = scene::notes_of(scene, plan);
    return json;
}

}  // namespace palpa::session
