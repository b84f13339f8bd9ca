#include "scene/map_tissue.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "files/input_error.h"
#include "files/quantile.h"
#include "files/sha256.h"
#include "files/text.h"
#include "mechanics/linear_range.h"
#include "scene/plan.h"
#include "stiffnessmaps/map_file.h"
#include "stiffnessmaps/noise.h"

namespace palpa::scene {
namespace {

constexpr double kSlopeOver_m = 0.05e-3;  // before the depth
constexpr double kUnknownThickness_m = std::numeric_limits<double>::infinity();

// Returns the noise of the scaled forces. A figure that the map's file states is not scaled.
double noise_N(const MapTissue& tissue, double stiffness_scale) {
    return tissue.map.noise_N ? tissue.noise_N : stiffness_scale * tissue.noise_N;
}

// Estimated noise scales with the forces, whereas the gate of the laws does not: a stiffer tissue is smoothed more.
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

Stage tangential_stage(const MapTissue& tissue, const TangentialOptions& options) {
    if (options.force == stiffnessmaps::TangentialForce::recorded)
        return stage_of(StageForm::tangential_as_recorded, "matrices as recorded along +x");
    const bool recorded = tissue.map.tangential == stiffnessmaps::TangentialKind::recorded;
    const bool slid = recorded && tissue.map.source.kind == stiffnessmaps::SourceKind::simulated;
    const std::string fidelity = slid ? "energy gradient + friction of the simulated slide along +x"
                                      : (recorded ? "energy gradient + recorded resistance" : "energy gradient");
    if (!(tissue.smoothing_m > 0.0)) return stage_of(StageForm::tangential_energy, fidelity);
    return stage_of(StageForm::tangential_energy_smoothed,
                    fidelity + ", smoothed by " + files::short_number(1e3 * tissue.smoothing_m) + " mm");
}

void add_notes(const MapTissue& tissue, const Scene& scene, Plan& plan) {
    if (tissue.map.source.kind == stiffnessmaps::SourceKind::analytic) {
        plan.notes.push_back("the tissue is a closed-form stand-in (analytic), neither recorded nor simulated");
    }
    if (tissue.map.source.kind == stiffnessmaps::SourceKind::simulated) {
        plan.notes.push_back("the tissue is simulated, not recorded: " + tissue.map.source.how);
    }
    if (!plan.nodules_known) plan.notes.push_back("the map does not say which nodules there are: marks are not scored");
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
                             " forces were changed so that none is below a shallower one (isotonic regression)");
    }
}

// Returns the force (N) that reaches a depth: the median of all cells, so that a few nodules do not matter.
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

// Returns the nodules that a person is to find: the placed ones, which are the truth, or the detected ones where none
// was placed. A placed nodule that was detected too does not count twice.
std::vector<stiffnessmaps::Nodule> nodules_to_find(const stiffnessmaps::Map& map) {
    std::vector<stiffnessmaps::Nodule> placed;
    std::copy_if(map.nodules.begin(), map.nodules.end(), std::back_inserter(placed),
                 [](const stiffnessmaps::Nodule& n) { return n.placed; });
    return placed.empty() ? map.nodules : placed;
}

// Gives every cell the median of its layer, so that nothing stands out.
void level_out(std::vector<float>& layers_N, std::size_t cells) {
    for (std::size_t at = 0; at < layers_N.size(); at += cells) {
        const auto first = layers_N.begin() + static_cast<std::ptrdiff_t>(at);
        const auto last = first + static_cast<std::ptrdiff_t>(cells);
        std::fill(first, last, static_cast<float>(files::upper_median({first, last})));
    }
}

void leave_out_nodules(stiffnessmaps::Map& map) {
    for (std::vector<float>* layers_N : {&map.normal_N, &map.tangential_x_N, &map.tangential_y_N})
        level_out(*layers_N, map.n_cells());
    map.nodules.clear();
    map.nodules_known = true;
}

void sink(const MapTissue& tissue, const Press& press, MapWork& work, Contact& contact) {
    const stiffnessmaps::Place& at = work.place = stiffnessmaps::place_at(tissue.field, press.p_m);
    const stiffnessmaps::DepthAnswer answer =
        stiffnessmaps::depth_at(tissue.field, at, press.force_N / press.stiffness_scale);
    contact.depth_m = answer.depth_m;
    contact.saturated = answer.saturated;
    contact.measured = at.measured && at.inside;
    if (tissue.map.source.kind == stiffnessmaps::SourceKind::simulated) {
        // the map comes from a linear simulation, so the depth may be beyond the linear range
        const double a_m =
            std::sqrt(tissue.map.indenter_radius_m * std::min(answer.depth_m, tissue.map.indenter_radius_m));
        contact.linearity = mechanics::linearity_ratio(answer.depth_m, kUnknownThickness_m, 2.0 * a_m);
    }
}

}  // namespace

bool takes_seconds(const MapOptions&) { return false; }

std::vector<std::filesystem::path> input_files(const MapOptions& options) { return {options.folder}; }

files::Json file_hashes(const MapOptions& options) {
    files::Json json = files::Json::object();
    for (const char* name : {"map.json", "normal_N.npy", "tangential_x_N.npy", "tangential_y_N.npy"}) {
        const std::string hash = files::sha256_of_file(options.folder / name);
        if (hash != "n/a") json["map_sha256"][name] = hash;
    }
    return json;
}

std::filesystem::path map_folder(const MapOptions& options) { return options.folder; }

MapTissue prepare(const MapOptions& options, const Scene& scene, const mechanics::Progress&) {
    MapTissue tissue;
    tissue.map = stiffnessmaps::read_map(options.folder);
    if (!options.nodules) leave_out_nodules(tissue.map);
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

bool serves(const MapTissue& tissue, const Scene& scene) { return smoothing_m(scene, tissue) == tissue.smoothing_m; }

void describe(const MapTissue& tissue, const Scene& scene, Plan& plan) {
    const stiffnessmaps::Map& map = tissue.map;
    plan.tissue_name = map.name;
    plan.source = map.source.kind;
    plan.nodules = nodules_to_find(map);
    plan.nodules_known = map.nodules_known || !map.nodules.empty();
    plan.greatest_force_N = scene.stiffness_scale * stiffnessmaps::force_range(map).highest_N;
    plan.greatest_depth_m = map.depths_m.back();
    for (const int third : {1, 2})
        plan.zone_N[static_cast<std::size_t>(third - 1)] =
            scene.stiffness_scale * median_force_N(tissue, third * plan.greatest_depth_m / 3.0);
    plan.known_N = std::max(plan.zone_N[1], scene.stiffness_scale * median_force_N(tissue, plan.greatest_depth_m));
    plan.indenter_radius_m = map.indenter_radius_m;
    if (map.indenter == stiffnessmaps::IndenterShape::cylinder) plan.indenter = DrawnIndenter::probe;
    const Eigen::Vector2d first(map.origin_m[0], map.origin_m[1]);
    const Eigen::Vector2d last(map.x_of(map.n_x - 1), map.y_of(map.n_y - 1));
    plan.area.centre_m = 0.5 * (first + last);
    plan.area.size_m = last - first + Eigen::Vector2d(map.spacing_m[0], map.spacing_m[1]);
    plan.tangential_source = map.tangential == stiffnessmaps::TangentialKind::recorded ? "recorded" : "energy";
    add_notes(tissue, scene, plan);
    add_isotonic_note(tissue, plan);
}

std::vector<Stage> stages(const MapTissue& tissue, const Scene& scene) {
    std::vector<Stage> out{depth_stage(tissue, scene.stiffness_scale), tangential_stage(tissue, scene.tangential)};
    add_law_stages(scene, {}, StageForm::display_ratio_on_map, StageForm::delay_on_map, out);
    if (scene.surface) out.push_back(stage_of(StageForm::surface_sphere, "sphere on a half-space, tapered"));
    return out;
}

files::Json identity(const MapTissue& tissue) {
    return {{"count", {tissue.map.n_x, tissue.map.n_y}}, {"smoothing_mm", 1e3 * tissue.smoothing_m}};
}

MapWork make_work(const MapTissue&) { return {}; }

void answer(const MapTissue& tissue, StageId stage, const Press& press, MapWork& work, Contact& contact) {
    if (!press.down) return;
    if (stage == StageId::depth) return sink(tissue, press, work, contact);
    contact.tangential_N =
        press.stiffness_scale * tangential_force_N(tissue.field, work.place, press.heading, contact.depth_m);
}

double rise_N(const MapTissue& tissue, const Station& at, MapWork&) {
    const stiffnessmaps::Place here = stiffnessmaps::place_at(tissue.field, at.p_m);
    const stiffnessmaps::Place before = stiffnessmaps::place_at(tissue.field, at.p_m - at.reference_m * at.u);
    if (!here.measured || !before.measured || !here.inside || !before.inside) return 0.0;
    const double depth_m = stiffnessmaps::depth_at(tissue.field, here, at.force_N / at.stiffness_scale).depth_m;
    return at.stiffness_scale * tangential_rise_N(tissue.field, here, before, at.u, depth_m);
}

void sample_surface(const MapTissue& tissue, const SurfaceEffect& effect, const Contact& contact, const MapWork&,
                    SurfaceShape& shape) {
    const double radius_m = effect.indenter_radius_m.value_or(tissue.map.indenter_radius_m);
    shape.curve = avatar::surface_curve(contact.depth_m, radius_m, effect.thickness_m);
    shape.centre_m = contact.p_m;
}

Push push_to(const MapTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, MapWork& work) {
    work.place = stiffnessmaps::place_at(tissue.field, p_m);
    const double greatest_m = stiffnessmaps::greatest_depth_m(tissue.field, work.place);
    Push out;
    out.saturated = depth_m > greatest_m;
    out.depth_m = std::min(depth_m, greatest_m);
    out.force_N = stiffnessmaps::normal_force_N(tissue.field, work.place, out.depth_m);
    const double before_m = std::max(0.0, out.depth_m - kSlopeOver_m);
    if (out.depth_m > before_m)
        out.slope_N_per_m = (out.force_N - stiffnessmaps::normal_force_N(tissue.field, work.place, before_m)) /
                            (out.depth_m - before_m);
    return out;
}

}  // namespace palpa::scene
