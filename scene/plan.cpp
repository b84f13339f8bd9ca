#include "scene/plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "calibration/profile_file.h"
#include "files/cache.h"
#include "files/input_error.h"
#include "files/text.h"
#include "scene/advance.h"
#include "scene/tissue.h"
#include "stiffnessmaps/map_file.h"
#include "stiffnessmaps/noise.h"

namespace palpa::scene {
namespace {

constexpr double kBarOfLinear_N = 5.0;   // no greatest force: as the shipped maps
constexpr double kFewestSpacings = 4.0;  // across the contact's radius: docs/fem.md
constexpr double kTooFewSpacings = 2.0;

std::string mm_text(double metres) { return files::short_number(1e3 * metres) + " mm"; }

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

// Of the scaled forces; a figure that the map itself brings is of its recording and stays as it is.
double noise_N(const MapTissue& tissue, double stiffness_scale) {
    return tissue.map.noise_N ? tissue.noise_N : stiffness_scale * tissue.noise_N;
}

// Noise scales with the forces, the gate of the laws does not: a harder tissue is smoothed more.
double smoothing_m(const Scene& scene, const MapTissue& tissue) {
    const double gate_N = scene.display_ratio.value_or(avatar::DisplayRatio{}).gate_N;
    return scene.tangential.smoothing_m.value_or(stiffnessmaps::default_smoothing_m(
        tissue.map, noise_N(tissue, scene.stiffness_scale), path_of(scene).reference_m, gate_N));
}

Stage depth_stage(const MapTissue& tissue, double stiffness_scale) {
    const std::string fidelity = "map " + tissue.map.name + ", isotonic over depth, bilinear in x and y";
    if (tissue.map.source.kind == stiffnessmaps::SourceKind::recorded)
        return stage_of(StageForm::depth_recorded_map, fidelity,
                        {files::short_number(1e3 * noise_N(tissue, stiffness_scale))});
    const double greatest_N = std::max(stiffnessmaps::force_range(tissue.map).highest_N, 1e-9);
    return stage_of(StageForm::depth_made_map, fidelity,
                    {files::short_number(25.0 * stiffnessmaps::coarse_grid_error_N(tissue.map) / greatest_N)});
}

// How many spacings the contact's radius, sqrt(R d), spans at the greatest depth.
double spacings_across(const LinearTissue& tissue) {
    const double R = tissue.indenter.radius_m;
    const double depth_m = std::min(tissue.phantom.depths_m.back(), R);
    return std::sqrt(R * depth_m) / std::max(tissue.spacing_m[0], tissue.spacing_m[1]);
}

Stage depth_stage(const LinearTissue& tissue, double) {
    const std::string fidelity = "linear finite elements, " + std::to_string(tissue.mesh_nodes) + " nodes, " +
                                 mm_text(tissue.spacing_m[0]) +
                                 " on the surface; frictionless contact solved at every sample";
    const double spacings = spacings_across(tissue);
    if (spacings >= kFewestSpacings) return stage_of(StageForm::depth_linear, fidelity);
    return stage_of(spacings >= kTooFewSpacings ? StageForm::depth_linear_coarse : StageForm::depth_linear_too_coarse,
                    fidelity,
                    {files::short_number(1e3 * tissue.phantom.depths_m.back()), files::short_number(spacings)});
}

Stage tangential_stage(const MapTissue& tissue, const TangentialOptions& options) {
    if (options.force == stiffnessmaps::TangentialForce::recorded)
        return stage_of(StageForm::tangential_as_recorded, "matrices as recorded along +x");
    const bool recorded = tissue.map.tangential == stiffnessmaps::TangentialKind::recorded;
    const bool slid = recorded && tissue.map.source.kind == stiffnessmaps::SourceKind::simulated;
    const std::string fidelity = slid ? "energy gradient + friction of the simulated slide along +x"
                                      : (recorded ? "energy gradient + recorded resistance" : "energy gradient");
    if (!(tissue.smoothing_m > 0.0)) return stage_of(StageForm::tangential_energy, fidelity);
    return stage_of(StageForm::tangential_energy_smoothed, fidelity + ", smoothed by " + mm_text(tissue.smoothing_m));
}

Stage friction_stage(const LinearTissue& tissue) {
    return stage_of(StageForm::friction_linear, "Coulomb friction " + files::short_number(*tissue.friction) +
                                                    ", stick and slip of every node, in steps of at most " +
                                                    mm_text(0.5 * tissue.spacing_m[0]));
}

Stage tangential_stage(const LinearTissue& tissue, const TangentialOptions&) {
    return stage_of(StageForm::tangential_linear, "slope of the elastic energy over " + mm_text(tissue.spacing_m[0]) +
                                                      ", two contact solves" +
                                                      (tissue.friction ? ", and friction" : ""));
}

void add_notes(const MapTissue& tissue, const Scene& scene, Plan& plan) {
    if (tissue.map.source.kind == stiffnessmaps::SourceKind::analytic) {
        plan.notes.push_back("the tissue is a closed-form stand-in (analytic), neither recorded nor simulated");
    }
    if (tissue.map.source.kind == stiffnessmaps::SourceKind::simulated) {
        plan.notes.push_back("the tissue is simulated, not recorded: " + tissue.map.source.how);
    }
    if (plan.nodules.size() < tissue.map.nodules.size()) {
        plan.notes.push_back(
            "detected nodules of the map are not asked for: where nodules were placed, those alone count");
    }
    if (scene.tangential.force == stiffnessmaps::TangentialForce::recorded) {
        plan.notes.push_back("tangential force as recorded: right for motion along +x only");
        return;
    }
    const bool recorded = tissue.map.tangential == stiffnessmaps::TangentialKind::recorded;
    plan.notes.push_back(std::string("tangential force ") +
                         (recorded ? "off the scan direction" : "in every direction") +
                         ": derived from the normal force (work argument), not measured");
}

void add_isotonic_note(const MapTissue& tissue, Plan& plan) {
    if (tissue.field.isotonic_changed > 0) {
        plan.notes.push_back(std::to_string(tissue.field.isotonic_changed) + " of " +
                             std::to_string(tissue.map.normal_N.size()) +
                             " forces did not rise with depth and were changed (isotonic regression)");
    }
}

void add_notes(const LinearTissue& tissue, const Scene&, Plan& plan) {
    if (!tissue.cache_warning.empty()) plan.notes.push_back(tissue.cache_warning);
    if (spacings_across(tissue) < kTooFewSpacings) {
        plan.notes.push_back("the surface nodes are too far apart for this indenter: " +
                             depth_stage(tissue, 1.0).error);
    }
    if (tissue.friction) {
        plan.notes.push_back(
            "friction acts on the tangential force, not on the avatar's lag: under the same force it is the same "
            "here and a reference distance before");
    }
    plan.notes.push_back("the tissue is simulated: linear elastic, small displacements, moduli of " +
                         tissue.phantom.name + "; the panel shows when a press leaves the linear range");
}

bool is_prepared_for(const Scene& scene, const MapTissue& tissue) {
    return smoothing_m(scene, tissue) == tissue.smoothing_m;
}

bool is_prepared_for(const Scene&, const LinearTissue&) { return true; }

MapTissue load_map(const Scene& scene) {
    MapTissue tissue;
    tissue.map = stiffnessmaps::read_map(scene.map);
    if (scene.tangential.force == stiffnessmaps::TangentialForce::recorded &&
        tissue.map.tangential != stiffnessmaps::TangentialKind::recorded) {
        throw files::bad_input(scene.file.string(), "avatar force", "recorded",
                               "energy: the map " + tissue.map.name + " holds no recorded tangential force");
    }
    tissue.noise_N = stiffnessmaps::normal_noise_N(tissue.map);
    tissue.smoothing_m = smoothing_m(scene, tissue);
    tissue.field = stiffnessmaps::make_field(tissue.map, {scene.tangential.force, tissue.smoothing_m});
    return tissue;
}

// What reaches a depth at the median place, so that few nodules do not count.
double median_force_N(const MapTissue& tissue, double depth_m) {
    const stiffnessmaps::Map& map = tissue.map;
    const auto above = std::upper_bound(map.depths_m.begin(), map.depths_m.end(), depth_m) - map.depths_m.begin();
    const auto high = std::min<std::size_t>(static_cast<std::size_t>(above), map.n_depths() - 1);
    const std::size_t low = high > 0 ? high - 1 : 0;
    const double low_m = above > 0 ? map.depths_m[low] : 0.0;
    const double s = std::clamp((depth_m - low_m) / (map.depths_m[high] - low_m + 1e-12), 0.0, 1.0);
    std::vector<double> forces_N;
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        const double low_N = above > 0 ? static_cast<double>(map.normal_N[low * map.n_cells() + cell]) : 0.0;
        const double force_N = (1.0 - s) * low_N + s * static_cast<double>(map.normal_N[high * map.n_cells() + cell]);
        if (std::isfinite(force_N)) forces_N.push_back(force_N);
    }
    if (forces_N.empty()) return 0.0;
    const auto middle = forces_N.begin() + static_cast<std::ptrdiff_t>(forces_N.size() / 2);
    std::nth_element(forces_N.begin(), middle, forces_N.end());
    return *middle;
}

// The same at five places, by bisection: a linear block answers forces with depths.
double median_force_N(const LinearTissue& tissue, double stiffness_scale, double depth_m) {
    LinearWork work = make_linear_work(tissue);
    const Eigen::Vector2d size_m(tissue.phantom.size_m[0], tissue.phantom.size_m[1]);
    std::vector<double> forces_N;
    for (const Eigen::Vector2d& share :
         {Eigen::Vector2d(0.5, 0.5), {0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}) {
        double low_N = 0.0;
        double high_N = kBarOfLinear_N;
        for (int i = 0; i < 20; ++i) {
            const double force_N = 0.5 * (low_N + high_N);
            const LinearAnswer answer = press(tissue, size_m.cwiseProduct(share), force_N / stiffness_scale, work);
            (answer.depth_m < depth_m && !answer.saturated ? low_N : high_N) = force_N;
        }
        forces_N.push_back(high_N);
    }
    std::sort(forces_N.begin(), forces_N.end());
    return forces_N[2];
}

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// What a person is to find: the placed nodules, which are the truth; the detected ones where none was placed. A placed
// nodule that was detected too must not count twice.
std::vector<stiffnessmaps::Nodule> nodules_to_find(const stiffnessmaps::Map& map) {
    std::vector<stiffnessmaps::Nodule> placed;
    std::copy_if(map.nodules.begin(), map.nodules.end(), std::back_inserter(placed),
                 [](const stiffnessmaps::Nodule& n) { return n.placed; });
    return placed.empty() ? map.nodules : placed;
}

void describe(const MapTissue& tissue, double stiffness_scale, Plan& plan) {
    const stiffnessmaps::Map& map = tissue.map;
    plan.tissue_name = map.name;
    plan.source = map.source.kind;
    plan.nodules = nodules_to_find(map);
    plan.greatest_force_N = stiffness_scale * stiffnessmaps::force_range(map).highest_N;
    plan.greatest_depth_m = map.depths_m.back();
    for (const int third : {1, 2})
        plan.zone_N[at(third - 1)] = stiffness_scale * median_force_N(tissue, third * plan.greatest_depth_m / 3.0);
    plan.indenter_radius_m = map.indenter_radius_m;
    const Eigen::Vector2d first(map.origin_m[0], map.origin_m[1]);
    const Eigen::Vector2d last(map.x_of(map.n_x - 1), map.y_of(map.n_y - 1));
    plan.area.centre_m = 0.5 * (first + last);
    plan.area.size_m = last - first + Eigen::Vector2d(map.spacing_m[0], map.spacing_m[1]);
}

void describe(const LinearTissue& tissue, double stiffness_scale, Plan& plan) {
    const stiffnessmaps::Phantom& phantom = tissue.phantom;
    plan.tissue_name = phantom.name;
    plan.source = stiffnessmaps::SourceKind::simulated;
    plan.nodules = stiffnessmaps::placed_nodules(phantom);
    plan.greatest_force_N = kBarOfLinear_N;
    plan.greatest_depth_m = phantom.depths_m.back();
    for (const int third : {1, 2})
        plan.zone_N[at(third - 1)] = median_force_N(tissue, stiffness_scale, third * plan.greatest_depth_m / 3.0);
    plan.indenter_radius_m = phantom.indenter_radius_m;
    plan.area.size_m = Eigen::Vector2d(phantom.size_m[0], phantom.size_m[1]);
    plan.area.centre_m = 0.5 * plan.area.size_m;
}

void add_stages(const Scene& scene, Plan& plan) {
    const bool direct = scene.mapping.kind == MappingKind::direct;
    plan.sample_stages.push_back(calibration_stage(plan));
    plan.sample_stages.push_back(stage_of(StageForm::position, direct ? "direct" : "indirect"));
    std::visit([&](const auto& tissue) { plan.sample_stages.push_back(depth_stage(tissue, scene.stiffness_scale)); },
               plan.tissue);
    const auto* linear = std::get_if<LinearTissue>(&plan.tissue);
    if (linear != nullptr && linear->friction) plan.sample_stages.push_back(friction_stage(*linear));
    std::visit([&](const auto& tissue) { plan.sample_stages.push_back(tangential_stage(tissue, scene.tangential)); },
               plan.tissue);
    const avatar::PathParameters path = path_of(scene);
    std::string stations =
        "stations every " + mm_text(path.station_m) + ", difference over " + mm_text(path.reference_m);
    if (scene.linear) {
        stations += ", fewer in strokes faster than " +
                    files::short_number(1e3 * kStationsOnLinear.per_s * path.station_m) + " mm/s";
    }
    if (scene.display_ratio)
        plan.sample_stages.push_back(
            stage_of(scene.linear ? StageForm::display_ratio_on_linear : StageForm::display_ratio_on_map, stations));
    if (scene.delay)
        plan.sample_stages.push_back(
            stage_of(scene.linear ? StageForm::delay_on_linear : StageForm::delay_on_map, stations));
    if (!scene.surface) return;
    plan.frame_stages.push_back(scene.linear
                                    ? stage_of(StageForm::surface_nodes, "surface nodes of the finite elements")
                                    : stage_of(StageForm::surface_sphere, "sphere on a half-space, tapered"));
}

}  // namespace

Plan make_plan(const Scene& scene, const mechanics::Progress& progress) {
    Plan plan;
    plan.profile = calibration::read_profile(scene.profile);
    if (scene.linear) {
        plan.tissue = make_linear_tissue(*scene.linear, files::cache_folder(), progress);
    } else {
        plan.tissue = load_map(scene);
    }
    std::visit([&](const auto& tissue) { describe(tissue, scene.stiffness_scale, plan); }, plan.tissue);
    if (scene.mapping.tissue_m && scene.linear) {
        throw files::bad_input(scene.file.string(), "mapping.tissue_mm", "a size", "none: a linear block has its own");
    }
    if (scene.mapping.tissue_m) plan.area.size_m = *scene.mapping.tissue_m;
    if (scene.surface) plan.indenter_radius_m = scene.surface->indenter_radius_m.value_or(plan.indenter_radius_m);
    add_stages(scene, plan);
    std::visit([&](const auto& tissue) { add_notes(tissue, scene, plan); }, plan.tissue);
    if (const auto* tissue = std::get_if<MapTissue>(&plan.tissue)) add_isotonic_note(*tissue, plan);
    return plan;
}

bool serves(const Plan& plan, const Scene& scene) {
    return std::visit([&](const auto& tissue) { return is_prepared_for(scene, tissue); }, plan.tissue);
}

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
