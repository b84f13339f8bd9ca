// palpa run: the app, or a trace without a window.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <sys/resource.h>
#include <utility>

#include "app/commands/command_line.h"
#include "app/commands/option_checks.h"
#include "app/live/live.h"
#include "app/scene_choices.h"
#include "app/screens/frame.h"
#include "files/clock.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "session/plan_in_progress.h"
#include "session/replay.h"
#include "session/session.h"
#include "study/study_folder.h"

namespace palpa::app {
namespace {

void print_result(const files::Json& result) {
    // the figures are those of all scenes of the run
    for (const auto& earlier : result.value("earlier_scenes", files::Json::array()))
        std::printf("%s, ", earlier.get<std::string>().c_str());
    std::printf("%s: %s samples, %s frames, %s steps, %s dropped\n", result["scene"].get<std::string>().c_str(),
                result["samples"].dump().c_str(), result["frames"].dump().c_str(), result["steps"].dump().c_str(),
                result["dropped_steps"].dump().c_str());
    std::printf("  greatest force %.3g N, depth %.3g mm, lag %.3g mm\n", result["max_force_N"].get<double>(),
                result["max_depth_mm"].get<double>(), result["max_lag_mm"].get<double>());
    const auto skipped = result["skipped_stations"].get<std::int64_t>() + result["skipped_slides"].get<std::int64_t>();
    if (skipped > 0) std::printf("  %lld steps along fast strokes skipped\n", static_cast<long long>(skipped));
    const std::int64_t inexact = result["counts"]["inexact"].get<std::int64_t>();
    if (inexact > 0)
        std::printf("  ! %lld samples whose contact did not settle, or whose force was not met\n",
                    static_cast<long long>(inexact));
    const std::int64_t without_level = result["counts"]["without_level"].get<std::int64_t>();
    if (without_level > 0)
        std::printf("  ! %lld samples of a touch without the level that the profile reads: they press with no force\n",
                    static_cast<long long>(without_level));
    const std::int64_t backwards = result["counts"]["backwards"].get<std::int64_t>();
    if (backwards > 0)
        std::printf("  ! %lld samples left out: their times run backwards\n", static_cast<long long>(backwards));
    if (!result.contains("lag_over_nodules_mm")) return;
    const auto line = [](const std::string& where, const files::Json& lag_mm) {
        if (lag_mm.is_null())
            std::printf("  %s: nothing pressed there\n", where.c_str());
        else
            std::printf("  %s: lag %.3g mm\n", where.c_str(), lag_mm.get<double>());
    };
    for (const auto& nodule : result["lag_over_nodules_mm"].items())
        line("over nodule " + nodule.key(), nodule.value());
    line(result["lag_over_nodules_mm"].empty() ? "everywhere" : "beside the nodules", result["lag_beside_nodules_mm"]);
}

void print(const files::Json& result, bool as_json) {
    if (as_json) {
        std::fputs(files::json_text(result).c_str(), stdout);
    } else {
        print_result(result);
    }
}

// A finished trial is drawn as what it revealed, another one at its moment of greatest lag or force. The files are closed.
void draw(const platform::Trace& trace, const RunOptions& options, session::Session& session) {
    Doing doing;
    if (session.trial.finished) {
        doing = review_of(*session.plan, session.trial, session.state.view);
    } else {
        const scene::Extremes extremes = session.state.extremes;
        session::begin_replay({}, trace.info, session.trial.mode, session);
        session::replay(trace, session, extremes.lag_m > 0.0 ? extremes.lag_at_s : extremes.force_at_s);
    }
    Settings settings;
    settings.left_handed = options.left_handed;
    const int width_px = options.width_px > 0 ? options.width_px : static_cast<int>(trace.info.screen_width_px);
    const int height_px = options.height_px > 0 ? options.height_px : static_cast<int>(trace.info.screen_height_px);
    ViewState view;
    draw_picture({session.scene, *session.plan, session.trial, settings, {}, doing, {}, session.state.timeline.now_s},
                 {width_px, height_px, options.screenshot}, view, session.state);
}

std::optional<session::TrialMode> asked_mode(const RunOptions& options) {
    if (options.test) return session::TrialMode::test;
    if (options.practice) return session::TrialMode::practice;
    return std::nullopt;
}

// What asks for a window, or for a picture that is not drawn.
void check_no_window(const CLI::App& command, const RunOptions& options) {
    for (const char* name : {"--record", "--guided", "--screen", "--simulate", "--quit-after-s"}) {
        if (command.count(name) > 0)
            throw files::InputError(std::string(name) + ": found with --headless, expected a window");
    }
    for (const char* name : {"--width-px", "--height-px", "--left-handed"}) {
        if (command.count(name) > 0 && options.screenshot.empty())
            throw files::InputError(std::string(name) + ": found with --headless, expected a --screenshot with it");
    }
}

// The guided start is a practice trial on the default scene.
void check_guided(const CLI::App& command) {
    for (const char* name : {"SCENE", "--test", "--screen", "--replay"}) {
        if (command.count(name) > 0)
            throw files::InputError(
                std::string(name) +
                ": found with --guided, expected one of both: the guided start has a scene of its own");
    }
}

void run_headless(const RunOptions& options) {
    if (options.trace.empty()) {
        throw files::InputError(
            "--headless: found no --replay TRACE.tsv, expected one (without a window there is no pen)");
    }
    const double began_s = files::steady_s();
    scene::Scene scene = load_scene(options.scene);
    if (!options.screenshot.empty()) {
        files::check_output(options.screenshot, inputs_of(scene, options.trace));
        check_png_name(options.screenshot);
    }
    if (!options.log.empty()) {
        files::check_output_folder(options.log);
        study::check_no_study(options.log);
    }
    auto plan = std::make_shared<const scene::Plan>(session::make_plan_here(scene));
    const platform::Trace trace = platform::read_trace(options.trace);
    const std::string other = session::other_parts(trace.info, scene);
    if (!other.empty()) std::fprintf(stderr, "palpa: warning: %s: %s\n", options.trace.c_str(), other.c_str());
    session::Session session;
    session::change_tissue(std::move(scene), std::move(plan), {}, session);
    session::begin_replay({options.log, options.participant, ""}, trace.info, asked_mode(options), session);
    const session::ReplayResult result = session::replay(trace, session);
    files::Json json = session::result_json(session, result);
    json["wall_s"] = files::steady_s() - began_s;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    json["peak_memory_MB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
    if (!session::close_files(json, session))
        throw std::runtime_error(options.log + ": the log could not be written to its end");
    if (!options.screenshot.empty()) draw(trace, options, session);
    print(json, options.json);
}

}  // namespace

void add_run(CLI::App& app) {
    auto options = std::make_shared<RunOptions>();
    CLI::App* command = app.add_subcommand("run", "Open the app on a scene or a map, or replay a trace");
    command->add_option("SCENE", options->scene,
                        "scene JSON, map folder or the name of a shipped one (default: the one last chosen "
                        "in the menu; the default scene at first and for replays)");
    command->add_option("--replay", options->trace, "trace to replay instead of live input");
    command->add_flag("--headless", options->headless,
                      "open no window: replay the trace as fast as possible, then exit");
    CLI::Option* log = command->add_option("--log", options->log,
                                           "folder for the log (BIDS layout; existing files are never overwritten)");
    command
        ->add_option("--participant", options->participant,
                     "participant's code in the names of the log files (default 01)")
        ->transform(code_of_participant())
        ->needs(log);
    command->add_option("--screenshot", options->screenshot,
                        "write FILE.png of the last frame; headless: of the moment of greatest lag, or of greatest "
                        "force without a lag");
    command->add_option("--record", options->record, "write the input to a new trace TRACE.tsv");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command
        ->add_option("--quit-after-s", options->quit_after_s,
                     "close the window this many seconds after its first frame")
        ->check(CLI::Range(0.0, 1e6));
    command->add_option("--width-px", options->width_px, "width of the window (default: as last time, 1280 at first)")
        ->check(CLI::Range(100, 16384));
    command->add_option("--height-px", options->height_px, "height of the window (default: as last time, 800 at first)")
        ->check(CLI::Range(100, 16384));
    command->add_flag("--practice", options->practice, "show the nodules during the trial");
    command->add_flag("--test", options->test, "hide the nodules until the trial is finished")->excludes("--practice");
    const std::map<std::string, Screen> screens{{"trial", Screen::trial},     {"devices", Screen::devices},
                                                {"scale", Screen::scale},     {"calibrate", Screen::calibrate},
                                                {"maps", Screen::maps},       {"history", Screen::history},
                                                {"tactile", Screen::tactile}, {"tangible", Screen::tangible}};
    command
        ->add_option_function<std::string>(
            "--screen", [options, screens](const std::string& name) { options->screen = screens.at(name); },
            "screen to open first")
        ->check(one_of({"trial", "devices", "scale", "calibrate", "maps", "history", "tactile", "tangible"}));
    command->add_flag("--guided", options->guided, "begin with the guided start");
    command->add_flag("--simulate", options->simulate_devices,
                      "start simulators of the scene's devices, and connect to them instead of real ones");
    command->add_flag("--left-handed", options->left_handed, "put the controls on the right");
    command->callback([options, command] {
        if (options->headless) {
            check_no_window(*command, *options);
            return run_headless(*options);
        }
        if (options->guided) check_guided(*command);
        if (const auto result = run_live(*options)) print(*result, options->json);
    });
}

}  // namespace palpa::app
