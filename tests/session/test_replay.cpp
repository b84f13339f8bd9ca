#include <doctest/doctest.h>
#include <memory>
#include <sstream>

#include "app/scene_choices.h"
#include "files/json.h"
#include "files/text.h"
#include "scene/advance.h"
#include "scene/mapping.h"
#include "session/raster_trace.h"
#include "session/replay.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

constexpr const char* kStem = "sub-01/beh/sub-01_task-palpation_run-01";

// A session on a scene ("": the default one), turned by `rotate_deg` and flipped.
void put_tissue(const std::string& scene_name, int rotate_deg, bool flip, Session& session) {
    Scene scene = load_scene(scene_name.empty() ? "" : PALPA_SOURCE_DIR "/assets/scenes/" + scene_name);
    scene.mapping.rotate_deg = rotate_deg;
    scene.mapping.flip = flip;
    auto plan = std::make_shared<const Plan>(make_plan(scene));
    change_tissue(std::move(scene), std::move(plan), {}, session);
}

// As `palpa run --headless --log` does it.
void replay_into(const std::filesystem::path& log, const std::string& scene_name, const Trace& trace) {
    Session session;
    put_tissue(scene_name, 0, false, session);
    begin_replay({log.string(), "01", ""}, trace.info, std::nullopt, session);
    replay(trace, session);
    CHECK(close_files({}, session));
}

std::string log_of(const char* scene_name, const Trace& trace) {
    const TemporaryFolder folder;
    replay_into(folder.path(), scene_name, trace);
    return read_text(folder / (std::string(kStem) + "_samples.tsv"));
}

// Without a log, and untimed.
ReplayResult result_of(const Trace& trace, Session& session) {
    put_tissue("", 0, false, session);
    begin_replay({}, trace.info, std::nullopt, session);
    session.state.time_every = 0;
    return replay(trace, session);
}

// A hand that presses and marks, while the trial is logged and recorded.
struct Hand {
    Session& session;
    double t_s = 1.0 / 3.0;

    void take(Sample sample) {
        sample.t_host_s = t_s += 0.0107;
        take_sample(sample, session);
    }
    void touch(Phase phase, double x_mm, double y_mm, double pressure) {
        const Eigen::Vector2d px = px_of_tissue(session.state.view, {1e-3 * x_mm, 1e-3 * y_mm});
        Sample sample;
        sample.tool = Tool::pen;
        sample.pointer_id = -2;
        sample.phase = phase;
        sample.x_px = px.x();
        sample.y_px = px.y();
        sample.pressure = pressure;
        take(sample);
    }
    void stroke(double x_mm, double y_mm) {
        touch(Phase::down, x_mm - 4.0, y_mm, 0.1);
        for (int i = -8; i <= 8; ++i) touch(Phase::move, x_mm + 0.5 * i, y_mm, 0.8 + 0.003 * i);
        touch(Phase::up, x_mm + 4.0, y_mm, 0.0);
    }
    void act(Action action) {
        Sample sample;
        sample.phase = Phase::ui;
        sample.action = action;
        if (action == Action::mark) {
            sample.x_px = session.trial.last_px->x();
            sample.y_px = session.trial.last_px->y();
        }
        if (action == Action::resize) {
            sample.x_px = 242.0 + 1.0 / 3.0;
            sample.y_px = 0.0;
            sample.width_px = 1037.7;
            sample.height_px = 800.0;
        }
        take(sample);
    }
};

enum class End { finished, interrupted, mid_press };

// A trial in a window of a measured screen, on a turned tissue, with fingers moved up; into FOLDER/live and FOLDER/t.tsv.
void live_trial(const TemporaryFolder& folder, TrialMode mode, End end) {
    const float px_per_mm = 4.7f;
    const TraceInfo info{1280, 800, 1280 / static_cast<double>(px_per_mm), 800 / static_cast<double>(px_per_mm),
                         "pen \"5\""};
    Session session;
    put_tissue("delay.json", 90, true, session);
    SessionFiles files{(folder / "live").string(), "01", (folder / "t.tsv").string()};
    files.finger_offset_mm = 15.0;
    files.sync_rows = false;
    begin_trial(files, info, mode, session);
    Hand hand{session};
    hand.act(Action::resize);
    const auto nodule = session.plan->nodules[0];
    hand.stroke(1e3 * nodule.x_m - 4.0, 1e3 * nodule.y_m);
    hand.act(Action::mark);
    hand.act(Action::confidence_4);
    hand.act(Action::hidden);
    hand.act(Action::shown);
    hand.stroke(100.0, 20.0);
    hand.act(Action::mark);
    hand.stroke(60.0, 60.0);
    hand.act(Action::mark);
    hand.act(Action::undo);
    if (end == End::mid_press) hand.touch(Phase::down, 50.0, 50.0, 0.5);
    if (end == End::finished) hand.act(Action::finish);
    hand.act(Action::mark);  // after the end of a finished trial: none
    CHECK(session.trial.marks.size() == (end == End::finished ? 2u : 3u));
    CHECK(close_files({{"any", 1}}, session));
}

}  // namespace

TEST_CASE(
    "replay: a simulated trace of a finger's scene is a finger's, with the contact areas that its profile reads") {
    Session session;
    Scene scene = load_scene("");
    scene.profile = PALPA_SOURCE_DIR "/assets/profiles/xoom-finger.json";
    auto plan = std::make_shared<const Plan>(make_plan(scene));
    REQUIRE(plan->profile.level == calibration::LevelField::contact_area);
    RasterOptions options;
    options.seconds = 3.0;
    options.force_N = 0.6;
    const Trace trace = raster_trace(scene, *plan, options);
    for (const Sample& sample : trace.samples) CHECK(sample.tool == Tool::finger);
    change_tissue(std::move(scene), std::move(plan), {}, session);
    begin_replay({}, trace.info, std::nullopt, session);
    replay(trace, session);
    CHECK(session.state.counters.without_level == 0);
    CHECK(session.state.extremes.force_N == close_to(0.66).epsilon(0.02));  // 10 % up and down
}

TEST_CASE("replay: a trial's log is that of the live trial, byte for byte, finished or broken off") {
    const TemporaryFolder folder;
    End end = End::finished;
    TrialMode mode = TrialMode::test;
    SUBCASE("a finished test") {}
    SUBCASE("an interrupted practice") { end = End::interrupted, mode = TrialMode::practice; }
    SUBCASE("a test that is closed during a press") { end = End::mid_press; }
    live_trial(folder, mode, end);
    Trace trace = read_trace(folder / "t.tsv");
    if (end == End::finished) trace.samples.push_back(trace.samples.front());  // after the end: not logged
    replay_into(folder / "again", "delay.json", trace);
    const auto text = [&](const char* log, const std::string& file) {
        return read_text(folder / (std::string(log) + "/" + kStem + file));
    };
    for (const char* file : {"_events.tsv", "_events.json", "_marks.tsv", "_marks.json", "_samples.tsv",
                             "_samples.json", "_settings.json"}) {
        CAPTURE(file);
        CHECK(text("live", file) == text("again", file));
    }
    const std::string events = text("again", "_events.tsv");
    CHECK(contains(events, end == End::finished ? "\tfinish\t" : "\tinterrupted\t"));
    CHECK(contains(events, name_of(mode)));
    CHECK(contains(events, "\t90\t1\t"));
    Json settings = parse_json(text("again", "_settings.json"), "settings");
    CHECK(settings["finger_offset_mm"] == 15.0);
    CHECK(settings["screen_px_per_mm"].get<double>() == close_to(4.7));
    CHECK(contains(text("again", "_performance.json"), "began_utc"));
}

TEST_CASE("replay: a mode that is asked for counts more than the trace's, and practice where there is none") {
    const TemporaryFolder folder;
    live_trial(folder, TrialMode::test, End::finished);
    Trace trace = read_trace(folder / "t.tsv");
    const auto replayed = [&](std::optional<TrialMode> asked) {
        Session session;
        put_tissue("delay.json", 0, false, session);
        begin_replay({}, trace.info, asked, session);
        return session.trial.mode;
    };
    CHECK(replayed(std::nullopt) == TrialMode::test);
    CHECK(replayed(TrialMode::practice) == TrialMode::practice);
    trace.info.mode.clear();
    CHECK(replayed(std::nullopt) == TrialMode::practice);
    CHECK(replayed(TrialMode::test) == TrialMode::test);
}

TEST_CASE("replay: the same trace gives the same log, byte for byte, for every shipped scene") {
    const Trace trace = read_trace(default_trace());
    for (const char* scene : {"default.json", "delay.json", "touchpad.json", "off.json"}) {
        CAPTURE(scene);
        const std::string first = log_of(scene, trace);
        CHECK(first == log_of(scene, trace));
        CHECK(std::count(first.begin(), first.end(), '\n') == static_cast<std::ptrdiff_t>(trace.samples.size() + 1));
        CHECK(first.find("nan") == std::string::npos);
        CHECK(first.find("inf") == std::string::npos);
    }
}

TEST_CASE("replay: drawn cues change their own columns alone, and a strength of zero changes nothing") {
    const TemporaryFolder folder;
    Trace trace = read_trace(default_trace());
    trace.samples.resize(1000);
    Json scene = read_json(PALPA_SOURCE_DIR "/assets/scenes/display-ratio.json");
    scene["tissue"]["map"] = PALPA_SOURCE_DIR "/assets/maps/silicone.map";
    const auto log_with = [&](const char* name, const Json& cues) {
        if (!cues.is_null()) scene["cues"] = cues;
        write_text_atomically(folder / (std::string(name) + ".json"), json_text(scene));
        Session session;
        Scene read = load_scene((folder / (std::string(name) + ".json")).string());
        auto plan = std::make_shared<const Plan>(make_plan(read));
        change_tissue(std::move(read), std::move(plan), {}, session);
        begin_replay({(folder / name).string(), "01", ""}, trace.info, std::nullopt, session);
        replay(trace, session);
        CHECK(close_files({}, session));
        return read_text(folder / name / (std::string(kStem) + "_samples.tsv"));
    };
    const std::string absent = log_with("absent", nullptr);
    CHECK(log_with("zero", {{"footprint", 0}, {"crease", 0}, {"depth_gain", 0}, {"side_view", true}}) == absent);
    const std::string all = log_with("all", {{"footprint", 0.7}, {"crease", 0.5}, {"depth_gain", 0.4}});
    std::istringstream with(all);
    std::istringstream without(absent);
    std::string row;
    std::string other;
    int pressed = 0;
    while (std::getline(with, row) && std::getline(without, other)) {
        const auto shared = [](const std::string& line) {
            std::size_t end = line.size();
            for (int column = 0; column < 3; ++column) end = line.rfind('\t', end - 1);
            return line.substr(0, end);
        };
        CHECK(shared(row) == shared(other));
        if (row.size() > 12 && row.find("n/a", row.size() - 12) == std::string::npos) ++pressed;
    }
    CHECK(pressed > 900);
}

TEST_CASE("replay: the surface, which nobody sees, is computed only for the frames that are timed") {
    Trace trace = read_trace(default_trace());
    trace.samples.resize(500);
    for (const int every : {0, 1, 16}) {
        CAPTURE(every);
        Session session;
        put_tissue("", 0, false, session);
        begin_replay({}, trace.info, std::nullopt, session);
        session.state.time_every = every;
        const ReplayResult result = replay(trace, session);
        CHECK(result.display.frames > 32);
        const std::int64_t due = every == 0 ? 0 : (result.display.drawn + every - 1) / every;
        CHECK(session.state.meters[static_cast<std::size_t>(StageId::surface)].calls() == due);
    }
}

TEST_CASE("replay: over the nodules the avatar lags at least 0.5 mm and 5 times more than beside them") {
    Session session;
    const ReplayResult result = result_of(read_trace(default_trace()), session);
    CHECK(result.over.size() == 3);
    for (const NodulePass& pass : result.over) {
        CAPTURE(pass.id);
        CHECK(pass.lag_m > 0.5e-3);
        CHECK(pass.lag_m > 5.0 * result.lag_beside_m);
    }
    CHECK(session.state.counters.dropped_steps == 0);
    CHECK(session.state.counters.off_tissue == 0);
    // the same place as one end of a long nodule
    auto with_rod = std::make_shared<Plan>(*session.plan);
    with_rod->nodules[0].x_m += 0.02;
    with_rod->nodules[0].length_m = *with_rod->nodules[0].diameter_m + 0.04;
    with_rod->nodules[0].angle_deg = 0.0;
    session.plan = with_rod;
    const Trace trace = read_trace(default_trace());
    begin_replay({}, trace.info, std::nullopt, session);
    CHECK(replay(trace, session).over[0].lag_m == close_to(result.over[0].lag_m));
    Trace short_trace = read_trace(default_trace());
    short_trace.samples.resize(1);  // before the first nodule
    Session not_there;
    for (const NodulePass& pass : result_of(short_trace, not_there).over) CHECK(std::isnan(pass.lag_m));
}

TEST_CASE("replay: a trace that was written reads back to the same run") {
    const TemporaryFolder folder;
    const Trace trace = read_trace(default_trace());
    {
        TraceWriter writer(folder / "t.tsv", trace.info);
        for (const Sample& sample : trace.samples) writer.write(sample);
        CHECK(writer.sync());
    }
    CHECK(read_text(folder / "t.tsv") == read_text(default_trace()));
    CHECK(log_of("default.json", read_trace(folder / "t.tsv")) == log_of("default.json", trace));
}

TEST_CASE("replay: a trace made at another rate gives the same lags") {
    const Scene scene = load_scene("");
    const Plan plan = make_plan(scene);
    RasterOptions options;
    options.seconds = 20.0;
    double lag_m[2];
    for (int i = 0; i < 2; ++i) {
        options.rate_Hz = i == 0 ? 133.0 : 1000.0;
        Session session;
        lag_m[i] = result_of(raster_trace(scene, plan, options), session).over[0].lag_m;
    }
    CHECK(lag_m[1] == close_to(lag_m[0]).epsilon(0.03));  // jitter and rounding differ
}

TEST_CASE("replay: the simulated pen touches the shipped parts where they answer") {
    for (const char* name : {"button", "toothbrush", "toothbrush-pull"}) {
        CAPTURE(name);
        const Scene scene = load_scene(name);
        const Plan plan = make_plan(scene);
        RasterOptions options;
        options.seconds = 8.0;
        State state = start(scene, plan, {options.screen_width_px, options.screen_height_px});
        double depth_m = 0.0;
        for (const Sample& sample : raster_trace(scene, plan, options).samples) {
            advance(scene, plan, sample, state);
            depth_m = std::max(depth_m, state.contact.depth_m);
        }
        CHECK(depth_m > 0.1 * plan.greatest_depth_m);
    }
}

TEST_CASE("replay: parts that were changed since the trace was recorded, or are others, are named") {
    const TemporaryFolder folder;
    const std::string part = PALPA_SOURCE_DIR "/assets/parts/beams/homogeneous.json";
    std::filesystem::copy_file(part, folder / "beam.json");
    write_text_atomically(folder / "s.json",
                          R"({"name": "s", "tissue": {"part": {"designs": ["beam.json"], "method": "timoshenko"}}})");
    const Scene scene = read_scene(folder / "s.json", PALPA_SOURCE_DIR "/assets");
    TraceInfo info;
    CHECK(other_parts(info, scene).empty());  // an older trace
    info.parts = traced_parts(scene);
    REQUIRE(info.parts.size() == 1);
    CHECK(other_parts(info, scene).empty());
    write_text_atomically(folder / "beam.json", read_text(part) + "\n");
    CHECK(other_parts(info, scene) == "it was recorded on 'beam.json', the scene has 'beam.json', changed since");
}
