#include "scene/plan.h"

#include "calibration/profile_file.h"
#include "files/text.h"
#include "stiffnessmaps/map_file.h"
#include "stiffnessmaps/noise.h"

namespace palpa {
namespace {

std::string mm_text(double metres) { return short_number(1e3 * metres) + " mm"; }

Stage calibration_stage(const Plan& plan) {
    Stage stage{StageId::calibration, false, "", "", 0.03};
    stage.fidelity = "exponential curve " + plan.profile.id + " from " + name_of(plan.profile.level);
    stage.error = plan.profile.points.empty() ? "not known: the profile brings no points"
                                              : std::to_string(plan.profile.points.size()) + " points in the profile";
    return stage;
}

Stage depth_stage(const Plan& plan) {
    Stage stage{StageId::depth, false, "", "", 0.03};
    stage.fidelity = "map " + plan.map.name + ", isotonic over depth, bilinear in x and y";
    const double greatest_N = force_range(plan.map).highest_N;
    if (plan.map.source.kind == SourceKind::recorded) {
        stage.error = short_number(1e3 * plan.noise_N) + " mN of noise in the recording";
    } else if (greatest_N > 0.0) {
        stage.error = short_number(25.0 * coarse_grid_error_N(plan.map) / greatest_N) +
                      " % of the greatest force (95th percentile, from twice the pitch)";
    }
    return stage;
}

Stage tangential_stage(const Plan& plan, const TangentialOptions& options) {
    Stage stage{StageId::tangential, false, "", "", 0.03};
    if (options.force == TangentialForce::recorded) {
        stage.fidelity = "matrices as recorded along +x";
        stage.error = "wrong in any other direction than +x";
        return stage;
    }
    stage.fidelity = plan.map.tangential == TangentialKind::recorded ? "energy gradient + recorded resistance"
                                                                     : "energy gradient";
    stage.error = "derived from the normal force (work argument), not measured";
    if (plan.smoothing_m > 0.0) {
        stage.fidelity += ", smoothed by " + mm_text(plan.smoothing_m);
        stage.error += "; smoothing lowers lag by about a fifth, delay by about a half";
    }
    return stage;
}

void add_notes(const Scene& scene, Plan& plan) {
    if (plan.map.source.kind == SourceKind::analytic) {
        plan.notes.push_back("the tissue is a closed-form stand-in (analytic), neither recorded nor simulated");
    }
    if (plan.map.source.kind == SourceKind::simulated) {
        plan.notes.push_back("the tissue is simulated, not recorded: " + plan.map.source.how);
    }
    if (scene.force_scale != 1.0) {
        plan.notes.push_back("phantom force: the pen's newtons are multiplied by " + short_number(scene.force_scale));
    }
    if (plan.map.tangential != TangentialKind::recorded) {
        plan.notes.push_back("tangential force in every direction: derived from the normal force (work argument), not measured");
    } else {
        plan.notes.push_back("tangential force off the scan direction: derived from the normal force (work argument), not measured");
    }
    if (scene.tangential.force == TangentialForce::recorded) {
        plan.notes.push_back("tangential force as recorded: right for motion along +x only");
    }
    if (plan.field.isotonic_changed > 0) {
        plan.notes.push_back(std::to_string(plan.field.isotonic_changed) + " of " +
                             std::to_string(plan.map.normal_N.size()) +
                             " forces did not rise with depth and were changed (isotonic regression)");
    }
}

}  // namespace

const char* name_of(StageId id) {
    switch (id) {
        case StageId::calibration: return "calibration";
        case StageId::position: return "position";
        case StageId::depth: return "depth";
        case StageId::tangential: return "tangential";
        case StageId::display_ratio: return "display_ratio";
        case StageId::delay: return "delay";
        case StageId::surface: return "surface";
    }
    return "";
}

Plan make_plan(const Scene& scene) {
    Plan plan;
    plan.profile = read_profile(scene.profile);
    plan.map = read_map(scene.map);
    plan.noise_N = normal_noise_N(plan.map);
    const PathParameters path = scene.delay ? scene.delay->path
                                            : scene.display_ratio.value_or(DisplayRatio{}).path;
    if (scene.tangential.smoothing_m) {
        plan.smoothing_m = *scene.tangential.smoothing_m;
    } else if (plan.map.source.kind == SourceKind::recorded) {
        const double gate_N = scene.display_ratio.value_or(DisplayRatio{}).gate_N;
        plan.smoothing_m = smoothing_sigma_m(plan.map, plan.noise_N, path.reference_m, gate_N);
    }
    plan.field = make_field(plan.map, {scene.tangential.force, plan.smoothing_m});
    plan.indenter_radius_m = plan.map.indenter_radius_m;

    const Eigen::Vector2d first(plan.map.origin_m[0], plan.map.origin_m[1]);
    const Eigen::Vector2d last(plan.map.x_of(plan.map.n_x - 1), plan.map.y_of(plan.map.n_y - 1));
    const Eigen::Vector2d cell(plan.map.spacing_m[0], plan.map.spacing_m[1]);
    plan.area.centre_m = 0.5 * (first + last);
    plan.area.size_m = scene.mapping.tissue_m.value_or(last - first + cell);

    const bool direct = scene.mapping.kind == MappingKind::direct;
    plan.sample_stages.push_back(calibration_stage(plan));
    plan.sample_stages.push_back({StageId::position, false, direct ? "direct" : "indirect", "exact", 0.01});
    plan.sample_stages.push_back(depth_stage(plan));
    plan.sample_stages.push_back(tangential_stage(plan, scene.tangential));
    const std::string stations = "stations every " + mm_text(path.station_m) + ", difference over " + mm_text(path.reference_m);
    if (scene.display_ratio) {
        plan.sample_stages.push_back({StageId::display_ratio, false, stations, "0.0002 mm against 5 times as many stations", 0.12});
    }
    if (scene.delay) {
        plan.sample_stages.push_back({StageId::delay, false, stations, "exact at the stations", 0.12});
    }
    if (scene.surface) {
        plan.indenter_radius_m = scene.surface->indenter_radius_m.value_or(plan.map.indenter_radius_m);
        plan.frame_stages.push_back({StageId::surface, true, "sphere on a half-space, tapered",
                                     "7 % of the depth at worst against the exact bonded layer (25 mm, depth to 2 mm)", 12.0});
    }
    add_notes(scene, plan);
    return plan;
}

}  // namespace palpa
