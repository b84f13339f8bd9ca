// What a plan says about parts, and how they are prepared.

#include <algorithm>
#include <cmath>

#include "files/cache.h"
#include "files/input_error.h"
#include "files/sha256.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "parts/beam_model.h"
#include "parts/button_file.h"
#include "parts/cell_model.h"
#include "parts/info.h"
#include "scene/part_tissue.h"
#include "scene/plan.h"

namespace palpa::scene {
namespace {

namespace fs = std::filesystem;
using parts::Method;

constexpr double kMargin_m = 8e-3;     // around and between the designs
constexpr double kBarOfLoads = 2.5;    // full scale of the force bar, in forces of the load
constexpr double kEnergyError = 1e-3;  // of voxels
constexpr int kVersion = 6;            // of what the cache holds

std::string percent_of(double share) { return files::short_number(100.0 * share) + " %"; }

parts::PartLoad load_of(const parts::Part& part, const std::string& name) {
    std::string known;
    for (const parts::PartLoad& load : part.loads) {
        if (load.name == name || (name.empty() && part.loads.size() == 1)) return load;
        known += (known.empty() ? "" : ", ") + load.name;
    }
    throw files::bad_input(part.file, "loads", name.empty() ? "several loads or none" : files::shown(name),
                           known.empty() ? "a load" : "one of " + known);
}

// The directions of both designs' loads must agree: one plane shows them.
void take_direction(const PartOptions& options, const PartDesign& design, bool first, PartTissue& tissue) {
    double d[2];
    for (std::size_t k = 0; k < 2; ++k) d[k] = design.load.direction[static_cast<std::size_t>(options.view[k])];
    // a picture into which the load goes; a slant load counts by its largest component
    const int axis = parts::largest_axis(design.load.direction);
    if (axis != options.view[0] && axis != options.view[1]) d[0] = d[1] = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
        if (!first && std::abs(d[k] - tissue.direction_m[k]) > 1e-9)
            throw files::bad_input(design.part.file, "loads." + design.load.name + ".direction",
                                   "another direction than the first design's", "the same");
        tissue.direction_m[k] = d[k];
    }
}

std::uint64_t fingerprint_of(const PartDesign& design, const parts::ResponseRequest& request) {
    return files::fingerprint_of({kVersion, files::sha256_of_file(design.part.file), design.runs_sha256,
                                  design.load.name, parts::name_of(request.method), request.energy_error, request.view,
                                  request.cell_m.value_or(0.0)});
}

parts::ResponseProgress part_progress(const mechanics::Progress& progress, double from, double share) {
    return [&progress, from, share](double done) {
        if (progress.report) progress.report(static_cast<int>(1000.0 * (from + share * done)), 1000);
        return progress.cancel == nullptr || !progress.cancel->load();
    };
}

parts::ResponseRequest request_for(const PartOptions& options, Method method) {
    return {method, options.cell_m, kEnergyError, options.view};
}

// Beams at once; voxels from the cache, or computed.
void add_responses(const PartOptions& options, const mechanics::Progress& progress, double from, double share,
                   PartDesign& design, PartTissue& tissue) {
    for (const Method method : tissue.methods) {
        const parts::ResponseRequest request = request_for(options, method);
        if (method != Method::voxels) {
            design.responses.push_back(parts::response_of(design.part, design.load, request));
            continue;
        }
        const fs::path cache = files::cache_folder();
        const std::uint64_t key = fingerprint_of(design, request);
        if (auto known = parts::read_response(cache, key)) {
            design.responses.push_back(std::move(*known));
            continue;
        }
        design.responses.push_back(
            parts::response_of(design.part, design.load, request, part_progress(progress, from, share)));
        tissue.cache_warning = parts::write_response(cache, key, design.responses.back());
    }
}

// A beam that the finite cells contradict is none.
void compare_with_cells(PartDesign& design) {
    const parts::Response& cells = design.responses.back();
    if (cells.method != Method::voxels || !cells.converged || !(cells.validity.to_m > 0.0)) return;
    const double cells_m_per_N = cells.compliance_m_per_N[cells.named];
    for (parts::Response& beam : design.responses) {
        const bool apart = std::abs(beam.compliance_m_per_N[beam.named] / cells_m_per_N - 1.0) > parts::kMostApart;
        if (apart && beam.validity.to_m > 0.0)
            beam.validity = {
                0.0, "`voxels` says " + files::short_number(1e-3 / cells_m_per_N) + " N/mm: the part is no such beam"};
    }
}

PartDesign read_design(const fs::path& file, const PartOptions& options) {
    PartDesign out;
    out.part = parts::read_part(file);
    out.load = load_of(out.part, options.load);
    out.runs_sha256 = parts::runs_sha256(out.part.voxels);
    const mechanics::Voxels& voxels = out.part.voxels;
    const std::size_t third = 3 - static_cast<std::size_t>(options.view[0] + options.view[1]);
    const mechanics::FilledBox box = mechanics::filled_box(voxels);
    out.slice.view = options.view;
    out.slice.depth = out.load.face ? (box.low[third] + box.high[third]) / 2
                                    : static_cast<int>(std::floor(out.load.at_m[third] / voxels.frame.pitch_m));
    for (int k = 0; k < 2; ++k)
        out.size_m[k] =
            voxels.frame.pitch_m * voxels.size[static_cast<std::size_t>(options.view[static_cast<std::size_t>(k)])];
    return out;
}

// Lays the designs below each other.
void lay_out(PartTissue& tissue) {
    double width_m = 0.0, height_m = kMargin_m;
    for (const PartDesign& design : tissue.designs) {
        width_m = std::max(width_m, design.size_m.x());
        height_m += design.size_m.y() + kMargin_m;
    }
    tissue.size_m = {width_m + 2.0 * kMargin_m, height_m};
    double top_m = height_m;
    for (PartDesign& design : tissue.designs) {
        top_m -= kMargin_m + design.size_m.y();
        design.origin_m = {kMargin_m + 0.5 * (width_m - design.size_m.x()), top_m};
    }
}

// Which methods can be changed between: those of beams if every design is one, and voxels if the scene asks for them.
std::vector<Method> methods_for(const PartOptions& options, const std::vector<PartDesign>& designs) {
    std::vector<Method> out;
    const bool beams = std::all_of(designs.begin(), designs.end(), [](const PartDesign& design) {
        return parts::beam_of(design.part, design.load).why_not.empty();
    });
    if (beams) out = {Method::paper, Method::euler_bernoulli, Method::timoshenko};
    if (options.method == Method::voxels || !beams) out.push_back(options.method);
    return out;
}

}  // namespace

Stage depth_stage(const PartTissue& tissue, std::size_t method) {
    if (tissue.designs[0].button) {
        return stage_of(StageForm::depth_part_button,
                        "push button: travel under the force, from a table of its curve; on and off by travel");
    }
    const parts::Response& response = tissue.designs[0].responses[method];
    double energy_error = response.energy_error, interpolation_error = response.interpolation_error;
    for (const PartDesign& design : tissue.designs) {  // the greatest of both, or that it is not known
        if (method >= design.responses.size()) continue;
        const parts::Response& other = design.responses[method];
        if (!(other.energy_error <= energy_error)) energy_error = other.energy_error;
        if (!(other.interpolation_error <= interpolation_error)) interpolation_error = other.interpolation_error;
    }
    const std::string stations = std::to_string(response.station_m.size()) + " unit loads along the axis";
    if (response.method != Method::voxels)
        return stage_of(StageForm::depth_part_beam, std::string(parts::name_of(response.method)) + ", " + stations,
                        {percent_of(interpolation_error)});
    return stage_of(StageForm::depth_part_voxels,
                    "finite cells, " + std::to_string(response.cells) + " of them, " + stations,
                    {percent_of(energy_error), percent_of(interpolation_error)});
}

struct PartCells::Work {
    PartOptions options;
    std::size_t next = 0;  // design
    std::optional<PartDesign> design;
    std::unique_ptr<parts::CellResponse> response;
};

PartCells::PartCells(const PartOptions& options) : work_(std::make_unique<Work>(Work{options, 0, {}, {}})) {}
PartCells::~PartCells() = default;

bool PartCells::advance() {
    Work& work = *work_;
    if (work.options.method != Method::voxels || work.next == work.options.designs.size()) return false;
    const parts::ResponseRequest request = request_for(work.options, Method::voxels);
    const fs::path cache = files::cache_folder();
    if (!work.response) {
        work.design = read_design(work.options.designs[work.next], work.options);
        if (work.design->part.button || parts::read_response(cache, fingerprint_of(*work.design, request))) {
            ++work.next;
            return true;
        }
        work.response = std::make_unique<parts::CellResponse>(work.design->part, work.design->load, request);
    } else if (!work.response->advance()) {
        parts::write_response(cache, fingerprint_of(*work.design, request), work.response->take());
        work.response.reset();
        ++work.next;
    }
    return true;
}

double PartCells::share() const {
    const double done = static_cast<double>(work_->next) + (work_->response ? work_->response->share() : 0.0);
    return done / static_cast<double>(work_->options.designs.size());
}

bool takes_seconds(const PartOptions& options) { return options.method == Method::voxels; }

std::vector<fs::path> input_files(const PartOptions& options) { return options.designs; }

files::Json file_hashes(const PartOptions& options) {
    files::Json json;
    for (std::size_t i = 0; i < options.designs.size(); ++i)
        json["part_" + std::string(i == 0 ? "a" : "b") + "_sha256"] = files::sha256_of_file(options.designs[i]);
    return json;
}

PartTissue prepare(const PartOptions& options, const Scene& scene, const mechanics::Progress& progress) {
    if (scene.mapping.tissue_m)
        throw files::bad_input(scene.file.string(), "mapping.tissue_mm", "a size", "none: parts have their own");
    if (scene.surface)
        throw files::bad_input(scene.file.string(), "surface", "a surface to draw",
                               "none: parts are drawn as they are");
    PartTissue tissue;
    tissue.options = options;
    for (const fs::path& file : options.designs) {
        tissue.designs.push_back(read_design(file, options));
        take_direction(options, tissue.designs.back(), tissue.designs.size() == 1, tissue);
    }
    lay_out(tissue);
    tissue.methods = methods_for(options, tissue.designs);
    const auto first = std::find(tissue.methods.begin(), tissue.methods.end(), options.method);
    tissue.first_method = static_cast<std::size_t>(first - tissue.methods.begin());
    const double share = 1.0 / static_cast<double>(tissue.designs.size());
    bool buttons = false;
    for (std::size_t i = 0; i < tissue.designs.size(); ++i) {
        PartDesign& design = tissue.designs[i];
        buttons = buttons || design.part.button;
        if (design.part.button) {
            design.button = parts::button_curve(design.part, files::cache_folder(), tissue.cache_warning);
        } else {
            add_responses(options, progress, share * static_cast<double>(i), share, design, tissue);
            compare_with_cells(design);
        }
    }
    if (buttons) tissue.methods.clear();  // a button's curve has no methods to choose from
    if (buttons && options.gesture == PartGesture::pull)
        throw files::bad_input(scene.file.string(), "tissue.part.gesture", "pull", "press: a button cannot be pulled");
    const bool flat = tissue.direction_m[0] == 0.0 && tissue.direction_m[1] == 0.0;
    if (flat && options.gesture == PartGesture::pull)
        throw files::bad_input(scene.file.string(), "tissue.part.view", "a picture that the load goes into",
                               "for a pull, a view in which its direction lies");
    return tissue;
}

void describe(const PartTissue& tissue, const Scene& scene, Plan& plan) {
    const PartDesign& first = tissue.designs[0];
    plan.tissue_name = first.part.name;
    if (tissue.designs.size() > 1) plan.tissue_name += " and " + tissue.designs[1].part.name;
    plan.source = stiffnessmaps::SourceKind::simulated;
    for (const PartDesign& design : tissue.designs) {
        double force_N = kBarOfLoads * design.load.force_N;
        double depth_m = 0.0;
        if (design.button) {
            depth_m = design.button->travel_m;
            if (design.button->snaps) force_N = std::max(force_N, 2.0 * design.button->peak_N);
        } else {
            const parts::Response& response = design.responses[tissue.first_method];
            depth_m = force_N / scene.stiffness_scale * response.compliance_m_per_N[response.named];
        }
        plan.greatest_force_N = &design == &first ? force_N : std::max(plan.greatest_force_N, force_N);
        plan.greatest_depth_m = std::max(plan.greatest_depth_m, depth_m);
    }
    plan.known_N = plan.greatest_force_N;
    plan.zone_N = {plan.greatest_force_N / 3.0, 2.0 * plan.greatest_force_N / 3.0};
    plan.indenter_radius_m = std::max(1e-3, 0.5 * first.load.patch_m);
    plan.area.size_m = tissue.size_m;
    plan.area.centre_m = 0.5 * tissue.size_m;
    plan.stations = {};
    if (!tissue.cache_warning.empty()) plan.notes.push_back(tissue.cache_warning);
    const auto is_button = [](const PartDesign& design) { return design.button.has_value(); };
    if (!std::all_of(tissue.designs.begin(), tissue.designs.end(), is_button))
        plan.notes.push_back(
            "the parts are simulated: linear elastic, small displacements; materials as their files say");
    for (const PartDesign& design : tissue.designs) {
        if (design.button)
            plan.notes.push_back(
                design.part.name +
                ": a push button answers by the cover and the support that its file names; its shape is "
                "drawn only");
        for (const std::string& warning : design.part.warnings) plan.notes.push_back(warning);
        if (!design.responses.empty() && !design.responses[tissue.first_method].converged)
            plan.notes.push_back(design.part.name + ": the finite cells did not converge, error of the energy " +
                                 percent_of(design.responses[tissue.first_method].energy_error));
    }
}

std::vector<Stage> stages(const PartTissue& tissue, const Scene& scene) {
    std::vector<Stage> out{depth_stage(tissue, tissue.first_method)};
    if (tissue.options.gesture == PartGesture::pull)
        out.push_back(stage_of(StageForm::tangential_part, "stiffness where the pull began times the way"));
    add_law_stages(scene, {}, StageForm::display_ratio_on_map, StageForm::delay_on_map, out);
    return out;
}

files::Json identity(const PartTissue& tissue) {
    files::Json json;
    json["gesture"] = tissue.options.gesture == PartGesture::pull ? "pull" : "press";
    json["both"] = tissue.options.both;
    json["designs"] = files::Json::array();
    for (const PartDesign& design : tissue.designs) {
        files::Json entry{{"name", design.part.name}, {"runs_sha256", design.runs_sha256}, {"load", design.load.name}};
        entry["stiffness_N_per_m"] = files::Json::object();
        for (const parts::Response& response : design.responses)
            entry["stiffness_N_per_m"][parts::name_of(response.method)] =
                files::number_or_null(1.0 / response.compliance_m_per_N[response.named]);
        if (design.button) entry["on_mm"] = design.button->on_m ? files::Json(1e3 * *design.button->on_m) : nullptr;
        json["designs"].push_back(entry);
    }
    if (!tissue.methods.empty()) json["method"] = parts::name_of(tissue.methods[tissue.first_method]);
    return json;
}

}  // namespace palpa::scene
