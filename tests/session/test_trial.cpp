#include <cmath>
#include <doctest/doctest.h>

#include "app/scene_choices.h"
#include "files/text.h"
#include "scene/advance.h"
#include "session/replay.h"
#include "session/session.h"
#include "session/trial.h"
#include "study/read_logs.h"
#include "tests/close_to.h"
#include "tests/tactile/tactile_scene.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::stiffnessmaps;
using namespace palpa::scene;
using namespace palpa::study;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

// A person at the default scene who presses and marks; everything goes the way of the app.
struct Trainee {
    Session session;
    TraceInfo info{1280, 800, kMissing, kMissing, "test"};
    double t_s = 1.0;

    explicit Trainee(const SessionFiles& files = {}) {
        session.scene = load_scene("");
        session.plan = std::make_shared<const Plan>(make_plan(session.scene));
        begin_trial(files, info, TrialMode::test, session);
    }
    Eigen::Vector2d px(double x_mm, double y_mm) const {
        return px_of_tissue(session.state.view, {1e-3 * x_mm, 1e-3 * y_mm});
    }
    void sample(Phase phase, double x_mm, double y_mm, double pressure, Action action = Action::none,
                Tool tool = Tool::pen) {
        Sample s;
        s.t_host_s = t_s += 0.01;
        s.tool = tool;
        s.pointer_id = tool == Tool::pen ? -1 : 3;
        s.phase = phase;
        s.x_px = px(x_mm, y_mm).x();
        s.y_px = px(x_mm, y_mm).y();
        s.pressure = pressure;
        s.action = action;
        take_sample(s, session);
    }
    // Strokes 8 mm along x.
    void stroke(double x_mm, double y_mm, double pressure) {
        sample(Phase::down, x_mm - 4.0, y_mm, 0.1);
        for (int i = -8; i <= 8; ++i) sample(Phase::move, x_mm + 0.5 * i, y_mm, pressure);
        sample(Phase::up, x_mm + 4.0, y_mm, 0.0);
    }
    void make_window_small() {
        Sample resize;
        resize.t_host_s = t_s += 0.01;
        resize.phase = Phase::ui;
        resize.action = Action::resize;
        resize.x_px = 300.0;
        resize.y_px = 0.0;
        resize.width_px = 500.0;
        resize.height_px = 420.0;
        take_sample(resize, session);
    }
    void act(Action action, double x_mm = 0.0, double y_mm = 0.0) { sample(Phase::ui, x_mm, y_mm, kMissing, action); }
};

}  // namespace

TEST_CASE("trial: trials on one tissue share its plan, however it is turned and scaled") {
    Trainee person;
    const auto plan = person.session.plan;
    Scene turned = person.session.scene;
    turned.mapping.rotate_deg = 90;
    turned.stiffness_scale = 2.0;
    Session other;
    change_tissue(turned, plan, {1280, 800}, other);
    begin_trial({}, person.info, TrialMode::test, other);
    CHECK(other.plan.get() == plan.get());
    begin_trial({}, person.info, TrialMode::test, person.session);
    CHECK(person.session.plan.get() == plan.get());
}

TEST_CASE("trial: found, pressed too lightly, never touched; marks with confidence, undone and false") {
    Trainee person;
    const std::vector<Nodule>& nodules = person.session.plan->nodules;
    REQUIRE(nodules.size() == 3);
    const auto at = [&](std::size_t i) { return Eigen::Vector2d(1e3 * nodules[i].x_m, 1e3 * nodules[i].y_m); };
    person.stroke(at(0).x(), at(0).y(), 0.85);
    person.act(Action::mark, at(0).x() + 2.0, at(0).y());
    person.act(Action::confidence_4);
    person.stroke(at(1).x(), at(1).y(), 0.05);
    person.act(Action::mark, 5.0, 110.0);
    person.act(Action::undo);
    person.act(Action::mark, 110.0, 110.0);
    person.act(Action::mark, -50.0, 10.0);  // beside the tissue: none
    person.act(Action::finish);
    person.act(Action::mark, 20.0, 20.0);  // after the end: none

    const Trial& trial = person.session.trial;
    CHECK(trial.finished);
    REQUIRE(trial.marks.size() == 2);
    CHECK(trial.marks[0].confidence == 4);
    CHECK(trial.marks[1].confidence == 0);
    const Debrief result = debrief(*person.session.plan, trial);
    CHECK(result.findings[0] == Finding::found);
    CHECK(result.findings[1] == Finding::too_light);
    CHECK(result.findings[2] == Finding::not_touched);
    CHECK(result.score.false_positives == 1);
    CHECK(result.score.sensitivity == close_to(1.0 / 3.0));
    CHECK(result.score.ppv == close_to(0.5));
    CHECK(result.area.at_least[1] > 0.0);
    CHECK(result.area.at_least[1] < 0.05);
    REQUIRE(person.session.ended.size() == 1);
    CHECK(person.session.ended[0]["tp"] == 1);
    CHECK(person.session.ended[0]["nodules"][1]["finding"] == "pressed too lightly");
}

TEST_CASE("trial: pressed well but not marked is told apart from pressed too lightly") {
    Trainee person;
    const Nodule& nodule = person.session.plan->nodules[1];
    person.stroke(1e3 * nodule.x_m, 1e3 * nodule.y_m, 0.85);
    CHECK(debrief(*person.session.plan, person.session.trial).findings[1] == Finding::not_marked);
}

TEST_CASE("trial: where nobody has named the nodules a mark is neither a hit nor false") {
    Trainee person;
    Plan plan = *person.session.plan;
    plan.nodules.clear();
    plan.nodules_known = false;
    person.session.plan = std::make_shared<const Plan>(plan);
    person.stroke(30.0, 30.0, 0.5);
    person.act(Action::mark, 30.0, 30.0);
    person.act(Action::finish);
    const Debrief result = debrief(*person.session.plan, person.session.trial);
    CHECK_FALSE(result.scored);
    CHECK(result.score.false_positives == 0);
    CHECK(std::isnan(result.score.ppv));
    const Json json = trial_json(*person.session.plan, person.session.trial);
    CHECK(json["ppv"].is_null());
    REQUIRE(json["marks"].size() == 1);
    CHECK(json["marks"][0]["kind"] == "not scored");
}

TEST_CASE("trial: a pen that lies on the screen without pressure does not press") {
    Trainee person;
    Plan plan = *person.session.plan;
    plan.profile.curve = {calibration::CurveModel::power, 3.0, 1.0, 0.0, {}, {}, {}};  // no force at no pressure
    person.session.plan = std::make_shared<const Plan>(std::move(plan));
    person.sample(Phase::down, 40.0, 40.0, 0.5);
    for (int i = 0; i < 20; ++i) person.sample(Phase::move, 40.0, 40.0, 0.5);
    const double pressed_s = person.session.trial.pressed_s;
    CHECK(pressed_s == close_to(0.2));
    for (int i = 0; i < 100; ++i) person.sample(Phase::move, 40.0, 40.0, 0.0);
    CHECK(person.session.trial.pressed_s == close_to(0.21));  // until the first sample without force
    for (int i = 0; i < 11; ++i) person.sample(Phase::move, 40.0, 40.0, 0.5);
    CHECK(person.session.trial.pressed_s == close_to(0.31));
}

TEST_CASE("trial: a press that is held without samples counts until it is lifted") {
    Trainee person;
    person.sample(Phase::down, 40.0, 40.0, 0.5);
    const double light_N = person.session.state.touch.force_N;
    person.t_s += 4.0;
    person.sample(Phase::up, 40.0, 40.0, 0.0);
    person.sample(Phase::down, 40.0, 40.0, 0.9);
    const double hard_N = person.session.state.touch.force_N;
    person.t_s += 1.0;
    person.sample(Phase::up, 40.0, 40.0, 0.0);
    const Trial& trial = person.session.trial;
    CHECK(trial.pressed_s == close_to(5.02));
    CHECK(trial.impulse_Ns == close_to(4.01 * light_N + 1.01 * hard_N));
    CHECK(hard_N > 2.0 * light_N);
}

TEST_CASE("trial: a press that is held when the trial is finished, or its window changed, counts up to then") {
    for (const bool resized : {false, true}) {
        CAPTURE(resized);
        Trainee person;
        person.sample(Phase::down, 40.0, 40.0, 0.5);
        const double held_N = person.session.state.touch.force_N;
        person.t_s += 4.0;
        if (resized) person.make_window_small();  // and the pen stays
        person.sample(Phase::ui, 40.0, 40.0, kMissing, Action::finish);
        const Trial& trial = person.session.trial;
        CHECK(trial.pressed_s == close_to(resized ? 4.02 : 4.01));
        CHECK(trial.impulse_Ns == close_to(trial.pressed_s * held_N));
    }
}

TEST_CASE("trial: a window that changes its size after a press leaves the place of the next mark on the tissue") {
    Trainee person;
    SUBCASE("tissue under the pen") {}
    SUBCASE("a pad beside the tissue") {
        Scene pad = person.session.scene;
        pad.mapping.kind = MappingKind::indirect;
        change_tissue(pad, person.session.plan, {1280, 800}, person.session);
        begin_trial({}, person.info, TrialMode::test, person.session);
    }
    person.stroke(40.0, 30.0, 0.5);
    const auto place = [&] { return tissue_of_px(person.session.state.view, *person.session.trial.last_px); };
    const Eigen::Vector2d pressed_m = place();
    person.make_window_small();
    CHECK((place() - pressed_m).norm() < 1e-9);
    CHECK(on_tissue(person.session.state.view, place()));
}

TEST_CASE("trial: a window that changes its size under a pen that presses adds nothing to the pen's way") {
    Trainee person;
    person.sample(Phase::down, 40.0, 30.0, 0.5);
    for (int i = 1; i <= 10; ++i) person.sample(Phase::move, 40.0 + i, 30.0, 0.5);
    const double way_m = person.session.trial.pressed_m;
    CHECK(way_m == close_to(0.01).epsilon(0.1));
    person.make_window_small();
    person.sample(Phase::move, 80.0, 60.0, 0.5);  // where the tissue is now
    CHECK(person.session.trial.pressed_m == way_m);
    CHECK(person.session.trial.path.back().begins);
}

TEST_CASE("trial: the way from a resting finger to the pen that takes over was not pressed") {
    Trainee person;
    const auto finger = [&](Phase phase) { person.sample(phase, 70.0, 70.0, 0.4, Action::none, Tool::finger); };
    finger(Phase::down);
    for (int i = 0; i < 5; ++i) finger(Phase::move);
    person.sample(Phase::down, 30.0, 30.0, 0.4);
    for (int i = 0; i < 5; ++i) person.sample(Phase::move, 30.0, 30.0, 0.4);
    CHECK(person.session.trial.pressed_m == 0.0);
    const auto begins = [](const PathPoint& point) { return point.begins; };
    CHECK(std::count_if(person.session.trial.path.begin(), person.session.trial.path.end(), begins) == 2);
}

TEST_CASE("trial: a very long path is thinned, not cut") {
    Trainee person;
    for (int i = 0; i < 400; ++i) {
        person.sample(Phase::down, 5.0, 1.0 + 0.29 * i, 0.5);
        for (int k = 1; k <= 180; ++k) person.sample(Phase::move, 5.0 + 0.6 * k, 1.0 + 0.29 * i, 0.5);
        person.sample(Phase::up, 113.0, 1.0 + 0.29 * i, 0.0);
    }
    const Trial& trial = person.session.trial;
    CHECK(trial.path.size() <= kPathPoints);
    CHECK(trial.path.capacity() == kPathPoints);
    CHECK(trial.path.front().p_m.y() < 0.0011);
    CHECK(trial.path.back().p_m.y() > 0.115);
    CHECK(trial.path_step_m > 0.5e-3);
}

TEST_CASE("trial: it replays from its trace, and its log holds what happened as it happened") {
    const TemporaryFolder folder;
    Json live;
    {
        SessionFiles files{(folder / "log").string(), "03", (folder / "t.tsv").string()};
        Trainee person(files);
        const Nodule& nodule = person.session.plan->nodules[0];
        person.stroke(1e3 * nodule.x_m, 1e3 * nodule.y_m, 0.8);
        person.act(Action::mark, 1e3 * nodule.x_m, 1e3 * nodule.y_m);
        person.act(Action::confidence_5);
        const std::string events = read_text(folder / "log/sub-03/beh/sub-03_task-palpation_run-01_events.tsv");
        CHECK(std::count(events.begin(), events.end(), '\n') ==
              4);  // header, start, mark, confidence: on the disk already
        person.act(Action::finish);
        live = person.session.ended[0];
        CHECK(close_files({{"any", 1}}, person.session));
    }
    const std::string stem = "log/sub-03/beh/sub-03_task-palpation_run-01";
    CHECK(read_text(folder / (stem + "_events.tsv")).find("\tfinish\ttest\t1\t") != std::string::npos);
    const std::string marks = read_text(folder / (stem + "_marks.tsv"));
    CHECK(std::count(marks.begin(), marks.end(), '\n') == 2);
    CHECK(marks.find("\t5\tA\t") != std::string::npos);
    CHECK(std::filesystem::exists(folder / (stem + "_settings.json")));

    const Trace trace = read_trace(folder / "t.tsv");
    Session again;
    again.scene = load_scene("");
    again.plan = std::make_shared<const Plan>(make_plan(again.scene));
    begin_trial({}, trace.info, TrialMode::test, again);
    for (const Sample& sample : trace.samples) take_sample(sample, again);
    REQUIRE(again.ended.size() == 1);
    CHECK(again.ended[0] == live);
}

TEST_CASE("session: a trial that is broken off keeps its marks with their places, and counts as interrupted") {
    const TemporaryFolder folder;
    const std::string stem = (folder / "log/sub-05/beh/sub-05_task-palpation_run-01").string();
    {
        SessionFiles files{(folder / "log").string(), "05", ""};
        Trainee person(files);
        person.stroke(30.0, 40.0, 0.8);
        person.act(Action::mark, 30.0, 40.0);
        person.act(Action::confidence_3);
        person.act(Action::mark, 60.0, 60.0);
        const std::string events = read_text(stem + "_events.tsv");
        const auto row = events.rfind('\n', events.find("\tmark\t")) + 1;
        const auto fields = fields_of(std::string_view(events).substr(row, events.find('\n', row) - row), '\t');
        REQUIRE(fields.size() == 22);  // as it happens: a kill leaves them too
        CHECK(std::stod(std::string(fields[20])) == close_to(30.0));
        CHECK(std::stod(std::string(fields[21])) == close_to(40.0));
        note_event("device_gone", 1e9, person.session);
        CHECK(close_files({}, person.session));
        for (int i = 0; i < 2; ++i) begin_trial({}, person.info, TrialMode::test, person.session);
        const files::Json trials = trials_json(person.session);
        REQUIRE(trials.size() == 2);  // that one and the last; nobody touched the one between them
        CHECK(trials[0]["finished"] == false);
        CHECK(trials[0]["marks"].size() == 2);
    }
    const std::string marks = read_text(stem + "_marks.tsv");
    CHECK(std::count(marks.begin(), marks.end(), '\n') == 3);
    const auto first = fields_of(std::string_view(marks).substr(marks.find('\n') + 1), '\t');
    CHECK(std::stod(std::string(first[3])) == close_to(30.0));
    CHECK(std::stod(std::string(first[4])) == close_to(40.0));
    CHECK(first[5] == "3");
    const std::string events = read_text(stem + "_events.tsv");
    CHECK(events.find("\tdevice_gone\t") != std::string::npos);
    CHECK(events.find("\tinterrupted\t") != std::string::npos);
    CHECK(events.find("\tfinish\t") == std::string::npos);
    const auto onset_s = [&](const char* type) {
        return std::stod(events.substr(events.rfind('\n', events.find(type)) + 1));
    };
    CHECK(onset_s("\tdevice_gone\t") > 1e8);
    CHECK(onset_s("\tinterrupted\t") == onset_s("\tdevice_gone\t"));  // never before what came before it
    const Observations seen = read_study(folder / "log");
    CHECK(seen.interrupted_trials == 1);
    CHECK(seen.trials.empty());
}

TEST_CASE("session: a second trial gets its own run and its own trace; a full disk is noticed and closes the files") {
    const TemporaryFolder folder;
    SessionFiles files{(folder / "log").string(), "01", (folder / "t.tsv").string()};
    Trainee person(files);
    CHECK(close_files({}, person.session));
    begin_trial(files, person.info, TrialMode::practice, person.session);
    CHECK(std::filesystem::exists(folder / "t-2.tsv"));
    CHECK(std::filesystem::exists(folder / "log/sub-01/beh/sub-01_task-palpation_run-02_events.tsv"));
    person.session.trials = 0;  // the first name once more: refused, and nothing stays half open
    CHECK_THROWS(begin_trial(files, person.info, TrialMode::practice, person.session));
    CHECK_FALSE(person.session.log);
    CHECK(files_good(person.session));
    CHECK(person.session.trial.began == false);
}

TEST_CASE("session: what a run reports covers all its trials, and not the last one alone") {
    Trainee person;
    person.stroke(0.0, 0.0, 0.8);
    const Json first = run_json(person.session, 0, {});
    CHECK(first["max_force_N"].get<double>() > 0.0);
    CHECK(first["samples"] == 19);
    begin_trial({}, person.info, TrialMode::test, person.session);
    const Json begun = run_json(person.session, 0, {});
    CHECK(begun["max_force_N"] == first["max_force_N"]);
    CHECK(begun["max_depth_mm"] == first["max_depth_mm"]);
    CHECK(begun["samples"] == first["samples"]);
    Scene scene = person.session.scene;
    scene.name = "another";
    const std::string pressed = person.session.scene.name;
    CHECK_FALSE(begun.contains("earlier_scenes"));
    change_tissue(std::move(scene), person.session.plan, screen_of(person.info), person.session);
    begin_trial({}, person.info, TrialMode::test, person.session);
    person.stroke(0.0, 0.0, 0.4);
    const Json last = run_json(person.session, 0, {});
    CHECK(last["scene"] == "another");
    CHECK(last["earlier_scenes"] == Json{pressed});  // also where its last trial had no press
    CHECK(last["max_force_N"] == first["max_force_N"]);
    CHECK(last["samples"] == 38);
    CHECK(last["steps"].get<std::int64_t>() > first["steps"].get<std::int64_t>());
}

TEST_CASE("trial: the clock starts at the first touch and stands still in a pause") {
    Trainee person;
    const auto clock = [&] { return clock_s(person.session.trial, person.session.trial.now_s); };
    person.sample(Phase::hover, 40.0, 40.0, kMissing);
    person.t_s += 5.0;
    person.act(Action::pause);  // before the first touch
    person.t_s += 5.0;
    person.act(Action::resume);
    CHECK(clock() == 0.0);
    person.stroke(40.0, 40.0, 0.5);
    const double stroked_s = clock();
    CHECK(stroked_s == close_to(0.18));
    person.t_s += 1.0;
    person.act(Action::pause);
    person.t_s += 30.0;
    person.act(Action::pause);  // it is stopped already
    CHECK(clock_s(person.session.trial, person.t_s + 100.0) == close_to(stroked_s + 1.01));
    person.act(Action::resume);
    person.act(Action::resume);  // it runs already
    person.t_s += 2.0;
    person.act(Action::finish);
    CHECK(person.session.trial.finished);
    CHECK(clock() == close_to(stroked_s + 1.01 + 0.01 + 2.01));
    CHECK(clock_s(person.session.trial, 1e6) == clock());
    CHECK(person.session.ended[0]["clock_s"].get<double>() == close_to(clock()));
    CHECK(person.session.ended[0]["duration_s"].get<double>() > 40.0);
}

TEST_CASE("trial: the path knows how deep a pen that stays was at each time, and until when it stayed") {
    Trainee person;
    person.sample(Phase::down, 40.0, 40.0, 0.1);
    person.sample(Phase::move, 40.0, 40.0, 0.2);
    const float light_m = person.session.trial.path.back().depth_m;
    person.t_s += 2.0;
    person.sample(Phase::move, 40.0, 40.0, 0.9);
    person.t_s += 3.0;
    person.sample(Phase::up, 40.0, 40.0, 0.0);
    const std::vector<PathPoint>& path = person.session.trial.path;
    REQUIRE(path.size() >= 3);
    const auto deep = path.end() - 2;
    CHECK((path.end() - 3)->depth_m == light_m);
    CHECK(deep->depth_m > 2.0f * light_m);
    CHECK(deep->t_s == close_to(2.02).epsilon(0.01));
    CHECK(path.back().t_s - deep->t_s == close_to(3.01).epsilon(0.01));
}

TEST_CASE("trial: the path of a pen that stays and goes deeper by little at a time is deep when it was") {
    Trainee person;
    person.sample(Phase::down, 40.0, 40.0, 0.05);
    for (int i = 0; i <= 200; ++i) person.sample(Phase::move, 40.0, 40.0, 0.05 + 0.004 * i);
    const std::vector<PathPoint>& path = person.session.trial.path;
    REQUIRE(path.size() > 8);
    for (std::size_t i = 1; i < path.size(); ++i) CHECK(path[i].depth_m < path[i - 1].depth_m + 1e-3f);
    CHECK(path.front().depth_m < 1.5e-3f);
}

TEST_CASE("trial: points of the path know when they were pressed") {
    Trainee person;
    person.stroke(40.0, 40.0, 0.5);
    person.t_s += 3.0;
    person.stroke(60.0, 60.0, 0.5);
    const std::vector<PathPoint>& path = person.session.trial.path;
    REQUIRE(path.size() > 10);
    for (std::size_t i = 1; i < path.size(); ++i) CHECK(path[i].t_s >= path[i - 1].t_s);
    CHECK(path.back().t_s - path.front().t_s == close_to(3.3).epsilon(0.05));
}

TEST_CASE("trial: where a device leads its presses count in the trial, and those of the pen on the screen do not") {
    const TactileScene slab(R"({"arm": {"device": "arm.json"}, "leads": "arm"})");
    Session session;
    session.scene = slab.scene;
    session.plan = slab.plan;
    SUBCASE("an arm") {}
    SUBCASE("a soft device, where the place is given") {
        session.scene.tactile.reset();
        session.scene.tangible.emplace();
        session.scene.tangible->at_m = Eigen::Vector2d(0.02, 0.02);
    }
    begin_trial({}, {1280, 800, kMissing, kMissing, "test"}, TrialMode::practice, session);
    Sample pen;
    pen.tool = Tool::pen;
    const auto touch = [&](double t_s, Phase phase) {
        const Eigen::Vector2d px = px_of_tissue(session.state.view, {0.02, 0.02});
        pen.t_host_s = t_s;
        pen.phase = phase;
        pen.pressure = 0.5;
        pen.x_px = px.x();
        pen.y_px = px.y();
        take_sample(pen, session);
    };
    touch(0.0, Phase::down);
    touch(0.1, Phase::move);
    CHECK(session.state.touch.down);
    CHECK(session.state.touch.force_N == 0.0);
    CHECK(session.trial.max_force_N == 0.0);
    CHECK(session.trial.path.empty());
    for (int k = 0; k <= 10; ++k) take_device_press({{0.02, 0.02}, 2e-3, 1.5}, 0.2 + 0.1 * k, session);
    touch(1.25, Phase::up);  // does not end the device's press
    take_device_press({{0.025, 0.02}, 3e-3, 1.5}, 1.3, session);
    take_device_press({}, 1.4, session);
    CHECK(session.trial.max_force_N == 1.5);
    CHECK(mean_force_N(session.trial) == close_to(1.5));
    CHECK(session.trial.pressed_s == close_to(1.2).epsilon(1e-6));
    CHECK(session.trial.pressed_m == close_to(5e-3));
    CHECK(session.state.extremes.depth_m == 3e-3);
    CHECK(study::deepest_near(session.trial.coverage, 0.025, 0.02, 1e-3) == close_to(3e-3));
}
