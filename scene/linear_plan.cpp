// What a plan says about a linear tissue.

#include <algorithm>
#include <cmath>

#include "files/cache.h"
#include "files/input_error.h"
#include "files/sha256.h"
#include "files/text.h"
#include "scene/linear_tissue.h"
#include "scene/plan.h"

namespace palpa::scene {
namespace {

constexpr double kBarOfLinear_N = 5.0;   // full scale of the force bar, since a linear block has no greatest force
constexpr double kFewestSpacings = 4.0;  // across the contact's radius, as docs/fem.md asks for
constexpr double kTooFewSpacings = 2.0;

// A station of the path costs five contact solves here, so their number is limited; on a map it costs 0.1 us and needs
// no limit. 4,000 a second are enough for strokes up to 200 mm/s.
constexpr avatar::StationLimit kStations{4000.0, 4, 64};

std::string mm_text(double metres) { return files::short_number(1e3 * metres) + " mm"; }

// Returns how many spacings the contact's radius, sqrt(R d), spans at the greatest depth.
double spacings_across(const LinearTissue& tissue) {
    const double R = tissue.indenter.radius_m;
    const double depth_m = std::min(tissue.phantom.depths_m.back(), R);
    return std::sqrt(R * depth_m) / std::max(tissue.spacing_m[0], tissue.spacing_m[1]);
}

Stage depth_stage(const LinearTissue& tissue) {
    const std::string fidelity = "linear finite elements, " + std::to_string(tissue.mesh_nodes) + " nodes, " +
                                 mm_text(tissue.spacing_m[0]) +
                                 (tissue.graded ? " on the surface where it is finest" : " on the surface") +
                                 "; frictionless contact solved at every sample";
    const double spacings = spacings_across(tissue);
    if (spacings >= kFewestSpacings) return stage_of(StageForm::depth_linear, fidelity);
    return stage_of(spacings >= kTooFewSpacings ? StageForm::depth_linear_coarse : StageForm::depth_linear_too_coarse,
                    fidelity,
                    {files::short_number(1e3 * tissue.phantom.depths_m.back()), files::short_number(spacings)});
}

Stage friction_stage(const LinearTissue& tissue) {
    return stage_of(StageForm::friction_linear, "Coulomb friction " + files::short_number(*tissue.friction) +
                                                    ", stick and slip of every node, in steps of at most " +
                                                    mm_text(0.5 * tissue.spacing_m[0]));
}

Stage tangential_stage(const LinearTissue& tissue) {
    return stage_of(StageForm::tangential_linear, "slope of the elastic energy over " + mm_text(tissue.spacing_m[0]) +
                                                      ", two contact solves" +
                                                      (tissue.friction ? ", and friction" : ""));
}

void add_notes(const LinearTissue& tissue, Plan& plan) {
    if (!tissue.cache_warning.empty()) plan.notes.push_back(tissue.cache_warning);
    if (spacings_across(tissue) < kTooFewSpacings) {
        plan.notes.push_back("the surface nodes are too far apart for this indenter: " + depth_stage(tissue).error);
    }
    if (tissue.friction) {
        plan.notes.push_back(
            "friction acts on the tangential force, not on the avatar's lag: under the same force it is the same "
            "here and a reference distance before");
    }
    plan.notes.push_back("the tissue is simulated: linear elastic, small displacements, moduli of " +
                         tissue.phantom.name + "; the view Performance (C) shows when a press leaves the linear range");
}

// Returns the force (N) that reaches a depth: the median of five places, so that a few nodules do not matter. It is
// searched for by bisection, since press() gives depths for forces. At most kBarOfLinear_N.
double median_force_N(const LinearTissue& tissue, double stiffness_scale, double depth_m) {
    LinearWork work = make_work(tissue);
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

}  // namespace

bool takes_seconds(const LinearOptions&) { return true; }

std::vector<std::filesystem::path> input_files(const LinearOptions& options) { return {options.phantom}; }

files::Json file_hashes(const LinearOptions& options) {
    files::Json json;
    json["phantom_sha256"] = files::sha256_of_file(options.phantom);
    return json;
}

std::filesystem::path map_folder(const LinearOptions&) { return {}; }

LinearTissue prepare(const LinearOptions& options, const Scene& scene, const mechanics::Progress& progress) {
    if (scene.mapping.tissue_m)
        throw files::bad_input(scene.file.string(), "mapping.tissue_mm", "a size", "none: a linear block has its own");
    return make_linear_tissue(options, files::cache_folder(), progress);
}

bool serves(const LinearTissue&, const Scene&) { return true; }

void describe(const LinearTissue& tissue, const Scene& scene, Plan& plan) {
    const stiffnessmaps::Phantom& phantom = tissue.phantom;
    plan.tissue_name = phantom.name;
    plan.source = stiffnessmaps::SourceKind::simulated;
    plan.nodules = stiffnessmaps::placed_nodules(phantom);
    plan.greatest_force_N = kBarOfLinear_N;
    plan.known_N = plan.greatest_force_N;
    plan.greatest_depth_m = phantom.depths_m.back();
    for (const int third : {1, 2})
        plan.zone_N[static_cast<std::size_t>(third - 1)] =
            median_force_N(tissue, scene.stiffness_scale, third * plan.greatest_depth_m / 3.0);
    plan.indenter_radius_m = phantom.indenter_radius_m;
    plan.area.size_m = Eigen::Vector2d(phantom.size_m[0], phantom.size_m[1]);
    plan.area.centre_m = 0.5 * plan.area.size_m;
    plan.stations = kStations;
    add_notes(tissue, plan);
}

std::vector<Stage> stages(const LinearTissue& tissue, const Scene& scene) {
    std::vector<Stage> out{depth_stage(tissue)};
    if (tissue.friction) out.push_back(friction_stage(tissue));
    out.push_back(tangential_stage(tissue));
    add_law_stages(scene, kStations, StageForm::display_ratio_on_linear, StageForm::delay_on_linear, out);
    if (scene.surface) out.push_back(stage_of(StageForm::surface_nodes, "surface nodes of the finite elements"));
    return out;
}

files::Json identity(const LinearTissue&) { return files::Json::object(); }

}  // namespace palpa::scene
