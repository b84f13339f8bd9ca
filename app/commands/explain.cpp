// palpa explain SCENE [--measure]: the plan, stage by stage, with the cost and the error of each stage.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "app/commands/command_line.h"
#include "app/scene_choices.h"
#include "files/printable.h"
#include "files/text.h"
#include "scene/plan.h"
#include "session/plan_in_progress.h"
#include "session/replay.h"
#include "tactile/plan.h"
#ifdef PALPA_TANGIBLE
#include "tangible/stages.h"
#endif

namespace palpa::app {
namespace {

struct ExplainOptions {
    std::string scene;
    bool measure = false;
    std::string trace;
    bool json = false;
};

files::Json stage_json(const scene::Stage& stage) {
    return {{"name", name_of(stage.id)},
            {"per", stage.per_frame ? "frame" : "sample"},
            {"fidelity", stage.fidelity},
            {"error", stage.error},
            {"cost_us", stage.cost_us}};
}

void print_stage(const scene::Stage& stage, const scene::Meter* meter) {
    std::printf("%-14s per %-6s  ", name_of(stage.id), stage.per_frame ? "frame" : "sample");
    if (meter == nullptr) {
        std::printf("about %g us\n", stage.cost_us);
    } else {
        std::printf("%lld calls, median %.3f us, p99 %.3f us\n", static_cast<long long>(meter->calls()),
                    1e-3 * meter->quantile_ns(0.5), 1e-3 * meter->quantile_ns(0.99));
    }
    std::printf("    %s\n    error: %s\n", stage.fidelity.c_str(), stage.error.c_str());
}

files::Json device_stages_json(const std::vector<scene::StageText>& stages) {
    files::Json out = files::Json::array();
    for (const scene::StageText& stage : stages) {
        out.push_back({{"name", stage.name},
                       {"per", stage.per},
                       {"fidelity", stage.fidelity},
                       {"error", stage.error},
                       {"cost_us", stage.cost_us}});
    }
    return out;
}

files::Json tactile_json(const tactile::TactilePlan& plan) {
    return {{"pairing", tactile::pairing_text(plan.options)},
            {"stiffness_N_per_mm", 1e-3 * plan.stiffness_N_per_m},
            {"stroke_used_up_N", plan.pins ? files::number_or_null(plan.stroke_used_up_N) : files::Json(nullptr)},
            {"stages", device_stages_json(plan.stages)}};
}

void print_device_stages(const std::string& title, const std::vector<scene::StageText>& stages) {
    std::printf("%s\n", title.c_str());
    for (const scene::StageText& stage : stages) {
        std::printf("%-14s per %-6s  about %.3g us\n    %s\n    error: %s\n", stage.name.c_str(), stage.per.c_str(),
                    stage.cost_us, stage.fidelity.c_str(), stage.error.c_str());
    }
}

#ifdef PALPA_TANGIBLE
constexpr double kMostOfPeriod = 0.8;  // that a tick may take at the median: some take longer

// The soft device of a scene; what a tick costs is measured here and now.
void explain_soft_device(const scene::Scene& scene, const scene::Plan& plan, bool as_json, files::Json& json,
                         std::vector<std::string>& notes) {
    const tangible::TangiblePlan device = tangible::make_tangible_plan(scene, plan);
    const tangible::TickCost cost = tangible::tick_cost(device);
    const std::vector<scene::StageText> stages = tangible::stages_of(device, cost);
    const std::string& name = device.model->device.name;
    json["tangible"] = {{"device", name}, {"stages", device_stages_json(stages)}};
    if (!as_json) print_device_stages("soft device " + files::printable(name), stages);
    notes.insert(notes.end(), device.notes.begin(), device.notes.end());
    const double period_us = 1e6 / device.loop.rate_Hz;
    if (cost.tick_us > kMostOfPeriod * period_us)
        notes.push_back("a tick takes " + files::short_number(1e-3 * cost.tick_us) + " ms here, and the period is " +
                        files::short_number(1e-3 * period_us) +
                        " ms: live runs will miss ticks; the fidelity stale or linear takes less");
    json["notes"] = notes;
}
#else
void explain_soft_device(const scene::Scene&, const scene::Plan&, bool, files::Json& json,
                         std::vector<std::string>& notes) {
    notes.push_back("the scene drives a soft device, which this build leaves out");
    json["notes"] = notes;
}
#endif

// Every sample is timed.
void measure(const platform::Trace& trace, session::Session& session) {
    session::begin_replay({}, trace.info, std::nullopt, session);
    session.state.time_every = 1;
    session::replay(trace, session);
}

void explain(const ExplainOptions& options) {
    session::Session session;
    scene::Scene chosen = load_scene(options.scene);
    auto prepared = std::make_shared<const scene::Plan>(session::make_plan_here(chosen));
    session::change_tissue(std::move(chosen), std::move(prepared), {}, session);
    const scene::Scene& scene = session.scene;
    const scene::Plan& plan = *session.plan;
    const std::filesystem::path trace_file =
        options.trace.empty() ? default_trace() : std::filesystem::path(options.trace);
    if (options.measure) measure(platform::read_trace(trace_file), session);

    std::optional<tactile::TactilePlan> arm_and_pins;
    if (scene.tactile) arm_and_pins = tactile::make_tactile_plan(scene, plan);
    std::vector<std::string> notes = scene::notes_of(scene, plan);
    if (arm_and_pins) notes.insert(notes.end(), arm_and_pins->notes.begin(), arm_and_pins->notes.end());
    files::Json json{{"scene", scene.name}, {"stages", files::Json::array()}, {"notes", notes}};
    if (!options.json) std::printf("%s\n", scene.name.c_str());
    for (const auto* stages : {&plan.sample_stages, &plan.frame_stages}) {
        for (const scene::Stage& stage : *stages) {
            const scene::Meter* meter =
                options.measure ? &session.state.meters[static_cast<std::size_t>(stage.id)] : nullptr;
            files::Json entry = stage_json(stage);
            if (meter != nullptr) {
                entry["calls"] = meter->calls();
                entry["median_us"] = 1e-3 * meter->quantile_ns(0.5);
                entry["p99_us"] = 1e-3 * meter->quantile_ns(0.99);
                entry["worst_us"] = 1e-3 * meter->worst_ns();
            }
            json["stages"].push_back(entry);
            if (!options.json) print_stage(stage, meter);
        }
    }
    if (arm_and_pins) {
        json["tactile"] = tactile_json(*arm_and_pins);
        if (!options.json) print_device_stages(tactile::pairing_text(arm_and_pins->options), arm_and_pins->stages);
    }
    if (scene.tangible) explain_soft_device(scene, plan, options.json, json, notes);
    if (options.json) {
        std::fputs(files::json_text(json).c_str(), stdout);
        return;
    }
    if (options.measure)
        std::printf("measured on %s; each time includes reading the clock\n", trace_file.string().c_str());
    for (const std::string& note : notes) std::printf("note: %s\n", note.c_str());
}

}  // namespace

void add_explain(CLI::App& app) {
    auto options = std::make_shared<ExplainOptions>();
    CLI::App* command =
        app.add_subcommand("explain", "Show the plan of a scene: the stages with their fidelity, error and cost");
    command->add_option("SCENE", options->scene,
                        "scene JSON, map folder or the name of a shipped one (default: the default scene)");
    CLI::Option* measure = command->add_flag("--measure", options->measure,
                                             "replay a trace and print each stage's calls, median time and p99");
    command->add_option("--trace", options->trace, "trace to measure with (default: the shipped trace)")
        ->needs(measure);
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { explain(*options); });
}

}  // namespace palpa::app
