#include "session/replay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/input_error.h"
#include "scene/advance.h"
#include "scene/plan.h"

namespace palpa::session {
namespace {

void note_nodules(const scene::Plan& plan, const scene::State& state, ReplayResult& result) {
    if (!state.answered || !state.touch.down) return;
    const double lag_m = scene::seen_lag_m(state.avatar);
    bool beside = true;
    for (std::size_t i = 0; i < plan.nodules.size(); ++i) {
        const study::Target nodule = place_of(plan.nodules[i]);
        const double radius_m = 0.5 * nodule.diameter_m;
        const double distance_m = study::distance_m(nodule, {state.touch.p_m.x(), state.touch.p_m.y()});
        if (distance_m <= radius_m + plan.indenter_radius_m) {
            result.over[i].lag_m = std::fmax(result.over[i].lag_m, lag_m);
        }
        if (distance_m <= radius_m + 4.0 * plan.indenter_radius_m) beside = false;
    }
    if (beside) result.lag_beside_m = std::fmax(result.lag_beside_m, lag_m);
}

}  // namespace

void show_due(const scene::Scene& scene, const scene::Plan& plan, scene::State& state, VirtualDisplay& display) {
    const double now_s = state.timeline.now_s;
    if (!display.began && state.timeline.started) {
        display.shown_s = now_s;
        display.began = true;
    }
    if (now_s >= display.shown_s) {
        const double behind = std::min(1.0 + std::floor((now_s - display.shown_s) * kVirtualDisplay_Hz), 1e9);
        display.frames += static_cast<std::int64_t>(behind);
        display.shown_s += behind / kVirtualDisplay_Hz;
        const bool computed = display.surface_every > 0 && display.drawn++ % display.surface_every == 0;
        if (computed && scene.surface) scene::surface_now(scene, plan, state, display.surface);
    }
    display.latency.count();
    display.latency.add_ns(1e9 * (display.shown_s - now_s));
}

TrialMode mode_of(const platform::TraceInfo& info) {
    return info.mode == name_of(TrialMode::test) ? TrialMode::test : TrialMode::practice;
}

void turn_as_recorded(const platform::TraceInfo& info, scene::Scene& scene) {
    if (!info.turn) return;
    scene.mapping.rotate_deg = info.turn->rotate_deg;
    scene.mapping.flip = info.turn->flip;
}

std::string other_parts(const platform::TraceInfo& info, const scene::Scene& scene) {
    if (info.parts.empty()) return "";  // an older trace, or one of other tissue
    const std::vector<platform::TracedPart> now = traced_parts(scene);
    std::string out;
    for (std::size_t i = 0; i < info.parts.size(); ++i) {
        if (i < now.size() && now[i].sha256 == info.parts[i].sha256) continue;
        out +=
            (out.empty() ? "it was recorded on " : "; and on ") + files::shown(info.parts[i].file) +
            ", the scene has " +
            (i < now.size() ? files::shown(now[i].file) + (now[i].file == info.parts[i].file ? ", changed since" : "")
                            : "no such part");
    }
    return out;
}

void begin_replay(SessionFiles files, const platform::TraceInfo& info, std::optional<TrialMode> mode,
                  Session& session) {
    scene::Scene scene = session.scene;
    turn_as_recorded(info, scene);
    change_tissue(std::move(scene), session.plan, screen_of(info), session);
    files.finger_offset_mm = info.finger_offset_mm;
    files.sync_rows = false;  // a crash loses nothing, since the trace is still there
    begin_trial(files, info, mode.value_or(mode_of(info)), session);
}

ReplayResult replay(const platform::Trace& trace, Session& session, double until_s) {
    ReplayResult result;
    result.display.surface_every = session.state.time_every;
    for (const stiffnessmaps::Nodule& nodule : session.plan->nodules) result.over.push_back({nodule.id});
    for (const platform::Sample& sample : trace.samples) {
        take_sample(sample, session);
        note_nodules(*session.plan, session.state, result);
        show_due(session.scene, *session.plan, session.state, result.display);
        if (session.trial.finished || session.state.timeline.now_s >= until_s) break;
    }
    return result;
}

namespace {

files::Json figures_json(const Session& session, const Totals& sum, std::int64_t frames, const scene::Meter& latency) {
    const scene::Scene& scene = session.scene;
    const scene::Plan& plan = *session.plan;
    const scene::State& state = session.state;
    const scene::Counters& counters = sum.counters;
    files::Json json;
    json["scene"] = scene.name;
    json["samples"] = counters.samples;
    json["frames"] = frames;
    json["steps"] = counters.steps;
    json["dropped_steps"] = counters.dropped_steps;
    json["skipped_stations"] = counters.skipped_stations;
    json["skipped_slides"] = counters.skipped_slides;
    json["latency_ms"] = {{"p50", 1e-6 * latency.quantile_ns(0.5)}, {"p99", 1e-6 * latency.quantile_ns(0.99)}};
    json["max_force_N"] = sum.extremes.force_N;
    json["max_depth_mm"] = 1e3 * sum.extremes.depth_m;
    json["max_lag_mm"] = 1e3 * sum.extremes.lag_m;
    json["stages"] = files::Json::array();
    for (const auto* stages : {&plan.sample_stages, &plan.frame_stages}) {
        for (const scene::Stage& stage : *stages) {
            const scene::Meter& meter = state.meters[static_cast<std::size_t>(stage.id)];
            json["stages"].push_back({{"name", name_of(stage.id)},
                                      {"fidelity", stage.fidelity},
                                      {"calls", meter.calls()},
                                      {"median_us", 1e-3 * meter.quantile_ns(0.5)},
                                      {"p99_us", 1e-3 * meter.quantile_ns(0.99)}});
        }
    }
    json["counts"] = {{"saturated", counters.saturated},
                      {"inexact", counters.inexact},
                      {"levels_clamped", counters.levels_clamped},
                      {"without_level", counters.without_level},
                      {"off_tissue", counters.off_tissue},
                      {"unmeasured", counters.unmeasured},
                      {"not_numbers", counters.not_numbers},
                      {"distrusted", counters.distrusted},
                      {"palms", counters.palms},
                      {"backwards", sum.backwards},
                      {"late", sum.late},
                      {"duplicate_times", sum.duplicates},
                      {"clock_jumps", sum.clock_jumps}};
    if (const auto switched = scene::switch_events(plan.tissue, state.tissue)) json["switch_events"] = *switched;
    json["notes"] = scene::notes_of(scene, plan);
    return json;
}

}  // namespace

files::Json run_json(const Session& session, std::int64_t frames, const scene::Meter& latency) {
    files::Json json = figures_json(session, session.before + session.state, frames, latency);
    for (const std::string& pressed : session.pressed_scenes)
        if (pressed != session.scene.name) json["earlier_scenes"].push_back(pressed);
    return json;
}

files::Json trial_run_json(const Session& session, std::int64_t frames, const scene::Meter& latency) {
    return figures_json(session, Totals{} + session.state, frames, latency);
}

files::Json result_json(const Session& session, const ReplayResult& result) {
    files::Json json = run_json(session, result.display.frames, result.display.latency);
    json["lag_over_nodules_mm"] = files::Json::object();
    for (const NodulePass& pass : result.over)
        json["lag_over_nodules_mm"][pass.id] = files::number_or_null(1e3 * pass.lag_m);
    json["lag_beside_nodules_mm"] = files::number_or_null(1e3 * result.lag_beside_m);
    json["trials"] = trials_json(session);
    return json;
}

}  // namespace palpa::session
