// palpa explain SCENE [--measure]: the plan, stage by stage, with the cost and the error of each stage.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "app/commands/command_line.h"
#include "app/scene_choices.h"
#include "scene/plan.h"
#include "session/plan_in_progress.h"
#include "session/replay.h"

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

    const std::vector<std::string> notes = scene::notes_of(scene, plan);
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
    command->add_option("SCENE", options->scene, "scene JSON or map folder (default: the default scene)");
    command->add_flag("--measure", options->measure,
                      "replay a trace and print each stage's calls, median time and p99");
    command->add_option("--trace", options->trace, "trace to measure with (default: the shipped trace)");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { explain(*options); });
}

}  // namespace palpa::app
