// Results of trials that are kept: written, read back, never overwritten, deleted.

#include <csignal>
#include <doctest/doctest.h>
#include <filesystem>
#include <sys/resource.h>

#include "app/scene_choices.h"
#include "files/text.h"
#include "session/history.h"
#include "session/replay.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::files;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

// The shipped trace, with a hit, a false positive and a finish.
KeptTrial finished() {
    Session session;
    session.scene = load_scene("");
    session.scene.mapping.rotate_deg = 90;
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    const Trace trace = read_trace(default_trace());
    begin_trial({}, trace.info, TrialMode::test, session);
    for (const Sample& sample : trace.samples) take_sample(sample, session);
    const auto act = [&](Action action, double x_m, double y_m) {
        Sample sample;
        sample.t_host_s = session.trial.now_s + 0.1;
        sample.phase = Phase::ui;
        sample.action = action;
        const Eigen::Vector2d px = px_of_tissue(session.state.view, {x_m, y_m});
        sample.x_px = px.x();
        sample.y_px = px.y();
        take_sample(sample, session);
    };
    act(Action::mark, session.plan->nodules[0].x_m, session.plan->nodules[0].y_m);
    act(Action::confidence_4, 0.0, 0.0);
    act(Action::mark, 0.1, 0.1);
    act(Action::finish, 0.0, 0.0);
    REQUIRE(session.trial.finished);
    return kept_trial(session, "2026-11-21T09:30:00Z");
}

}  // namespace

TEST_CASE("history: a result that does not fit on the disk leaves no file that cannot be read") {
    const TemporaryFolder folder;
    const KeptTrial trial = finished();
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{100, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    CHECK_THROWS_WITH(keep_trial(trial, folder / "history"), doctest::Contains("could not be written"));
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    CHECK(std::filesystem::is_empty(folder / "history"));
}

TEST_CASE("history: what is kept of a trial is what is read back") {
    const TemporaryFolder folder;
    KeptTrial trial = finished();
    trial.nodules[1].length_mm = 63.0;
    trial.nodules[1].angle_deg = 4.8;
    CHECK(trial.found == 1);
    CHECK(trial.false_positives == 1);
    CHECK(trial.clock_s > 10.0);
    REQUIRE(trial.path.size() > 100);
    CHECK(trial.path.size() <= kKeptPoints);
    CHECK(trial.path.front().begins);
    const KeptTrial back = read_kept_trial(keep_trial(trial, folder / "history"));
    CHECK(back.utc == trial.utc);
    CHECK(back.scene == trial.scene);
    CHECK(back.mode == TrialMode::test);
    CHECK(back.rotate_deg == 90);
    CHECK(back.clock_s == close_to(trial.clock_s).epsilon(1e-3));
    REQUIRE(back.nodules.size() == trial.nodules.size());
    CHECK(back.nodules[0].finding == Finding::found);
    CHECK(back.nodules[1].length_mm == 63.0);
    CHECK(back.nodules[1].angle_deg == close_to(4.8));
    REQUIRE(back.marks.size() == 2);
    CHECK(back.marks[0].hit);
    CHECK(back.marks[0].confidence == 4);
    CHECK_FALSE(back.marks[1].hit);
    REQUIRE(back.path.size() == trial.path.size());
    double previous_s = 0.0;
    for (std::size_t i = 0; i < back.path.size(); ++i) {
        CHECK(back.path[i].time_s >= previous_s);
        CHECK(back.path[i].x_mm == close_to(trial.path[i].x_mm).epsilon(1e-3));
        previous_s = back.path[i].time_s;
    }
}

TEST_CASE("history: path and marks have the times of the person's clock, without waiting and pauses") {
    Session session;
    session.scene = load_scene("");
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    begin_trial({}, {640, 400, kMissing, kMissing, "test"}, TrialMode::test, session);
    const auto send = [&](double t_host_s, Phase phase, Action action, double x_m) {
        Sample sample;
        sample.t_host_s = t_host_s;
        sample.tool = Tool::pen;
        sample.phase = phase;
        sample.action = action;
        sample.pressure = phase == Phase::hover ? 0.0 : 0.5;
        const Eigen::Vector2d px = px_of_tissue(session.state.view, {x_m, session.plan->area.centre_m.y()});
        sample.x_px = px.x();
        sample.y_px = px.y();
        take_sample(sample, session);
    };
    const double x_m = session.plan->area.centre_m.x();
    send(100.0, Phase::hover, Action::none, x_m);
    send(130.0, Phase::down, Action::none, x_m);  // the clock starts
    send(131.0, Phase::move, Action::none, x_m + 5e-3);
    send(131.5, Phase::up, Action::none, x_m + 5e-3);
    send(132.0, Phase::ui, Action::pause, x_m);
    send(192.0, Phase::ui, Action::resume, x_m);
    send(193.0, Phase::down, Action::none, x_m + 9e-3);
    send(194.0, Phase::ui, Action::mark, x_m + 9e-3);
    send(195.0, Phase::ui, Action::finish, x_m);
    const KeptTrial trial = kept_trial(session, "2026-11-21T09:30:00Z");
    CHECK(trial.clock_s == close_to(5.0));
    REQUIRE(trial.path.size() == 5);
    CHECK(trial.path[0].time_s == close_to(0.0));
    CHECK(trial.path[1].time_s == close_to(1.0));
    CHECK(trial.path[2].time_s == close_to(1.5));  // lifted
    CHECK(trial.path[3].time_s == close_to(3.0));
    CHECK(trial.path[4].time_s == close_to(5.0));  // held until the end
    REQUIRE(trial.marks.size() == 1);
    CHECK(trial.marks[0].time_s == close_to(4.0));
    CHECK(session.trial.marks[0].onset_s == close_to(94.0));  // in the log: since the trial began
}

TEST_CASE("history: trials of one second do not overwrite each other, and only trials are deleted") {
    const TemporaryFolder folder;
    KeptTrial trial = finished();
    keep_trial(trial, folder.path());
    trial.found = 2;
    keep_trial(trial, folder.path());
    trial.utc = "2025-01-01T00:00:00Z";
    keep_trial(trial, folder.path());
    write_text_whole(folder / "notes.txt", "mine");
    write_text_whole(folder / "broken.trial.json", R"({"palpa_trial": 1, "utc": "x", "scene": 3})");
    std::vector<std::string> problems;
    std::filesystem::create_directory(folder / "own.trial.json");
    const std::vector<std::filesystem::path> files = history_files(folder.path(), problems);
    const std::vector<KeptTrial> all = read_history(files, problems);
    REQUIRE(all.size() == 3);
    CHECK(all[0].utc == "2025-01-01T00:00:00Z");
    CHECK(all[1].found == 1);
    CHECK(all[2].found == 2);
    REQUIRE(problems.size() == 1);
    CHECK(contains(problems[0], "broken.trial.json: scene: found 3"));
    trial.found = 3;
    const std::filesystem::path later = keep_trial(trial, folder.path());  // while the question stands
    delete_history(files);
    CHECK(std::filesystem::exists(folder / "notes.txt"));
    CHECK(std::filesystem::exists(folder / "own.trial.json"));
    CHECK(history_files(folder.path(), problems) == std::vector{later});
    CHECK(history_files(folder / "none", problems).empty());
    CHECK(problems.size() == 1);
    CHECK(history_files(folder / "notes.txt", problems).empty());  // a file where the folder should be
    CHECK(contains(problems.back(), "notes.txt: the folder of results cannot be read: Not a directory"));
}

TEST_CASE("history: a trial of an earlier version, without lengths of its nodules, can be read") {
    const TemporaryFolder folder;
    const std::filesystem::path file = keep_trial(finished(), folder.path());
    Json json = parse_json(read_text(file), "kept");
    for (Json& nodule : json["nodules"]) {
        nodule.erase("length_mm");
        nodule.erase("angle_deg");
    }
    write_text_atomically(folder / "earlier.json", json.dump());
    CHECK(read_kept_trial(folder / "earlier.json").nodules[0].length_mm == 0.0);
}

TEST_CASE("history: a file that says more nodules were found than it names is refused") {
    const TemporaryFolder folder;
    KeptTrial trial = finished();
    trial.found = static_cast<int>(trial.nodules.size()) + 1;
    const std::filesystem::path file = keep_trial(trial, folder.path());
    CHECK(contains(message_of([&] { read_kept_trial(file); }), "found: found " + std::to_string(trial.found)));
}
