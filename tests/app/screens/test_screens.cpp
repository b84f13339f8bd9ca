// Every screen at the sizes of desks and tablets: nothing blank, nothing that does not fit. Drawn without a display.

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "app/scene_choices.h"
#include "app/screens/calibrate_form.h"
#include "app/screens/calibrate_screen.h"
#include "app/screens/frame.h"
#include "app/screens/history_screen.h"
#include "app/screens/map_screen.h"
#include "app/screens/words.h"
#include "app/study/study_run.h"
#include "tests/app/screens/screen_checks.h"
#include "tests/close_to.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::stiffnessmaps;
using namespace palpa::scene;
using namespace palpa::study;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

Sample action_at(double t_host_s, Action action, const State& state, const Eigen::Vector2d& place_m) {
    Sample sample;
    sample.t_host_s = t_host_s;
    sample.phase = Phase::ui;
    sample.action = action;
    const Eigen::Vector2d px = px_of_tissue(state.view, place_m);
    sample.x_px = px.x();
    sample.y_px = px.y();
    return sample;
}

// The default trace, finished, with a hit and a false mark.
Trace finished_trace(const Plan& plan, const State& state) {
    Trace trace = read_trace(default_trace());
    const auto act = [&](Action action, double x_m, double y_m) {
        trace.samples.push_back(action_at(trace.samples.back().t_host_s + 0.1, action, state, {x_m, y_m}));
    };
    act(Action::mark, plan.nodules[0].x_m, plan.nodules[0].y_m);
    act(Action::confidence_5, 0.0, 0.0);
    act(Action::mark, 0.1, 0.1);
    act(Action::finish, 0.0, 0.0);
    return trace;
}

}  // namespace

TEST_CASE("screens: every screen fits and is drawn at the sizes of desks and tablets") {
    const TemporaryFolder folder;
    const Trace whole = read_trace(default_trace());
    Session session;
    session.scene = load_scene("");
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    const auto begin_stroke = [&](Session& begun) {
        begun.scene = session.scene;
        begun.plan = session.plan;
        begin_trial({}, whole.info, TrialMode::practice, begun);
        for (std::size_t i = 0; i < 400; ++i) take_sample(whole.samples[i], begun);
    };
    begin_stroke(session);
    Session marked;
    begin_stroke(marked);
    take_sample(action_at(whole.samples[400].t_host_s, Action::mark, marked.state, {0.040, 0.036}), marked);
    Session stopped;
    begin_stroke(stopped);
    stopped.trial.paused_at_s = stopped.trial.now_s;

    Screens trial;
    trial.notices.scenes = scene_choices();
    trial.notices.profiles = profile_choices();
    trial.notices.screen_name = "DUMMY0, 1280 x 800";
    if (kept_pictures() == nullptr) {  // pictures to be looked at show the app without trouble
        trial.notices.problems = {"scene.json: tissue.map: found nothing, expected a map folder"};
        trial.notices.offer_hold = true;
        trial.notices.pressure_notes = {"This pen reports always the same pressure: it has no sensor."};
    }
    Screens asked{trial.notices};
    asked.asked.emplace().again = true;
    Screens menu{trial.notices, Palpating{true}};
    Screens menu_settings{trial.notices, Palpating{true}};
    menu_settings.view.menu_page = MenuPage::settings;
    Screens menu_experimenter{trial.notices, Palpating{true}};
    menu_experimenter.view.menu_page = MenuPage::experimenter;
    Screens help{trial.notices};
    help.view.help = true;
    Screens help_in_browser{trial.notices};
    help_in_browser.notices.keeps_trials = true;
    help_in_browser.view.help = true;
    Screens guided{trial.notices, Palpating{false, true}};
    Screens cost{trial.notices};
    cost.view.cost = true;
    Screens scale{trial.notices, MeasuringScreen{}};
    CheckingDevices checking{std::make_shared<DeviceCheck>(), {}};
    for (std::size_t i = 0; i < 400; ++i) observe(whole.samples[i], *checking.check);
    for (std::size_t i = 0; i < 400; ++i) add_dot(whole.samples[i], checking.dots);
    Screens devices{trial.notices, checking};
    devices.notices.devices = {{1, "A pen with a long name", Tool::pen, true, 0.0, 8191.0, 8192, true, false, {}}};

    Session done;
    done.scene = session.scene;
    done.plan = session.plan;
    begin_trial({}, whole.info, TrialMode::test, done);
    for (const Sample& sample : finished_trace(*done.plan, done.state).samples) take_sample(sample, done);
    REQUIRE(done.trial.finished);
    Screens reveal{trial.notices, review_of(*done.plan, done.trial, done.state.view)};
    reveal.notices.problems.clear();

    Screens guided_result{trial.notices, review_of(*done.plan, done.trial, done.state.view, true)};
    Screens history{trial.notices, BrowsingHistory{}};
    history.view.history = std::make_shared<HistoryView>();
    for (int i = 0; i < 12; ++i) {
        KeptTrial kept = kept_trial(done, "2026-11-" + std::to_string(10 + i) + "T09:30:00Z");
        kept.found = std::min(3, i / 3);
        kept.mode = i % 4 == 0 ? TrialMode::practice : TrialMode::test;
        history.view.history->trials.push_back(kept);
    }
    choose_trial(11, *history.view.history);
    history.view.history->shown_s = 20.0;
    history.view.history->plays = false;

    Calibrating recording{make_calibrate_form()};
    calibration::RecordArguments arguments;
    arguments.folder = (folder / "c").string();
    arguments.sensor = "typed";
    recording.form->recording = calibration::open_recording(arguments);
    for (int i = 1; i <= 18; ++i) {
        const double level = i / 19.0;
        const double force_N = 0.1 * std::exp(3.5 * level) * (i % 2 == 0 ? 1.04 : 0.97);
        recording.form->recording->session.points.push_back({0.0, level, force_N, i % 3});
    }
    Screens calibrating{trial.notices, recording};
    Screens calibrate{trial.notices, Calibrating{make_calibrate_form()}};

    Screens maps{trial.notices, BrowsingMaps{}};
    maps.view.maps = make_map_browser(session.scene, map_choices());
    REQUIRE(maps.view.maps->problem == "");
    add_pin({0.035, 0.035}, *maps.view.maps);
    add_pin({0.100, 0.100}, *maps.view.maps);
    maps.view.maps->pointed_m = Eigen::Vector2d(0.060, 0.088);
    maps.view.maps->quantity = MapQuantity::normal;

    constexpr double kTablet_px_per_mm = 11.8;  // 10.1 inch with 2560 x 1600
    const Case cases[] = {{1280, 800, kMissing, false},
                          {800, 1280, kMissing, false},
                          {2560, 1600, kMissing, true},
                          {2560, 1600, kTablet_px_per_mm, false, true},
                          {1600, 2560, kTablet_px_per_mm, false},
                          {1024, 600, 6.63, true},              // 7 inch, measured
                          {1024, 768, 6.3, false},              // page of a tablet, 160 px per inch
                          {800, 1280, 7.4, false, false, 140},  // 8 inch, measured
                          {1280, 800, kMissing, false, false, 140},
                          {200, 100, kMissing, false}};
    for (const Case& c : cases) {
        OffScreen screen = screen_of(c);
        check_case(session, trial, c, "trial", screen);
        if (c.width_px < 600) continue;  // panels need some room
        check_case(stopped, trial, c, "paused", screen);
        check_case(session, devices, c, "devices", screen);
        check_case(session, maps, c, "maps", screen);
        if (std::isfinite(c.px_per_mm) && c.px_per_mm < kTablet_px_per_mm) continue;  // other panels scroll there
        check_case(marked, asked, c, "asked", screen);
        check_case(session, menu, c, "menu", screen);
        check_case(session, menu_settings, c, "menu-settings", screen);
        check_case(session, menu_experimenter, c, "menu-experimenter", screen);
        check_case(session, help, c, "help", screen);
        check_case(session, help_in_browser, c, "help-browser", screen);
        check_case(session, guided, c, "guided", screen);
        check_case(session, history, c, "history", screen);
        check_case(done, guided_result, c, "guided-result", screen);
        check_case(session, cost, c, "cost", screen);
        check_case(session, scale, c, "scale", screen);
        check_case(session, calibrate, c, "calibrate", screen);
        check_case(session, calibrating, c, "calibrating", screen);
        check_case(done, reveal, c, "reveal", screen);
    }
}

TEST_CASE("screens: every step of a study fits, and none tells where the nodules are") {
    const TemporaryFolder folder;
    Session session;
    session.scene = load_scene("");
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    const Trace whole = read_trace(default_trace());
    begin_trial({}, whole.info, TrialMode::test, session);
    for (std::size_t i = 0; i < 400; ++i) take_sample(whole.samples[i], session);
    Screens screens;
    auto* run = &screens.doing.emplace<StudyRun>();
    run->protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/paper.json");
    run->scenes = load_study_scenes(run->protocol);
    run->directory = folder / "log";
    std::filesystem::create_directories(run->directory);
    run->code = "07";
    run->progress = progress_of(run->directory, run->protocol, run->code);
    run->progress.next = run->progress.plan.trials.front();
    const step::Stopped stopped{"log: found 12 MB free, expected 64 MB for a trial; the study has stopped"};
    run->protocol.consent =
        "You are asked to feel surfaces on a screen for about half an hour. Your answers are kept under a "
        "code and not under your name. You may stop at any time and need not say why.";
    const StudyStep steps[] = {step::Code{},
                               step::Again{},
                               step::Consent{},
                               step::Questions{},
                               step::Instructions{},
                               step::Trial{true},
                               step::Device{},
                               step::Present{},
                               step::Question{},
                               step::Told{false},
                               step::Feedback{2, 3, 1},
                               step::Typed{},
                               step::Ratings{},
                               step::Pause{},
                               step::Leaving{},
                               step::Withdrawn{},
                               step::Done{},
                               stopped};
    static_assert(std::size(steps) == std::variant_size_v<StudyStep>);
    const Case cases[] = {{1280, 800, kMissing, false},
                          {800, 1280, kMissing, false},
                          {412, 915, kMissing, false},
                          {2560, 1600, 11.8, false},
                          {1024, 600, kMissing, true}};
    for (const Case& c : cases) {
        OffScreen screen = screen_of(c);
        for (const StudyStep& step : steps) {
            run->step = step;
            ++run->entered;
            const bool by_hand = at<step::Typed>(*run);
            for (const PlannedTrial& trial : run->progress.plan.trials) {
                const Modality modality = run->protocol.conditions[trial.condition].modality;
                if (!trial.practice && (modality == Modality::hand) == by_hand) run->progress.next = trial;
            }
            screens.view.study = {};
            if (by_hand) {
                screens.view.study.step = run->entered;
                screens.view.study.typed.nodules = {4, kMissed, 0};
            }
            check_case(session, screens, c, std::string("study-") + name_of(run->step), screen);
        }
        // on a tablet there is more to do between people, and a step may have to wait
        run->on_tablet = true;
        run->where = words::pageSomeAreHere;
        run->warnings = {
            "Trial sub-07_task-palpation_run-03 is not kept: the storage of this browser is full. Menu, Trials, Export "
            "saves it "
            "to a file; the next trial waits for that."};
        for (const StudyStep& step : {StudyStep(step::Code{}), StudyStep(step::Done{}), StudyStep(stopped)}) {
            run->step = step;
            ++run->entered;
            check_case(session, screens, c, std::string("study-tablet-") + name_of(step), screen);
        }
        run->keeping_since_s = 0.0;
        check_case(session, screens, c, "study-tablet-keeping", screen);
        run->keeping_since_s.reset();
        run->on_tablet = false;
        run->where.clear();
        run->step = step::Device{.connected = true};
        check_case(session, screens, c, "study-device-gone", screen);
        run->step = step::Device{.here = true, .connected = true, .left = true, .no_level = true};
        check_case(session, screens, c, "study-nothing-felt", screen);
        run->warnings.clear();
    }
}

TEST_CASE(
    "screens: the map browser shows every kind of matrix, cells that were not measured, placed and detected nodules") {
    Session session;
    session.scene = load_scene("");
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    begin_trial({}, read_trace(default_trace()).info, TrialMode::practice, session);
    Screens screens;
    screens.doing = BrowsingMaps{};
    screens.view.maps = make_map_browser(session.scene, map_choices());
    Map& map = screens.view.maps->map;
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        if (cell % map.n_x < 20 && cell / map.n_x < 12)
            screens.view.maps->stiffness_N_per_m[cell] = std::numeric_limits<double>::quiet_NaN();
    }
    for (std::size_t k = 0; k < map.n_depths(); ++k)
        map.normal_N[k * map.n_cells() + 700] = std::numeric_limits<float>::quiet_NaN();
    Nodule found;
    found.id = "D1";
    found.placed = false;
    found.x_m = 0.03;
    found.y_m = 0.095;
    found.diameter_m = 8e-3;
    found.length_m = 30e-3;
    found.angle_deg = 25.0;
    map.nodules.push_back(found);
    const Case c{1280, 800, kMissing, false};
    OffScreen screen = screen_of(c);
    constexpr const char* kNames[] = {"maps-normal", "maps-sideways-x", "maps-sideways-y", "maps-stiffness"};
    for (int i = 0; i < 4; ++i) {
        screens.view.maps->quantity = static_cast<MapQuantity>(i);
        check_case(session, screens, c, kNames[i], screen);
    }
}

TEST_CASE("screens: during a test the map browser shows nothing of any map") {
    Session session;
    session.scene = load_scene("");
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    const Trace whole = read_trace(default_trace());
    begin_trial({}, whole.info, TrialMode::test, session);
    for (std::size_t i = 0; i < 400; ++i) take_sample(whole.samples[i], session);
    REQUIRE_FALSE(may_show_maps(*session.plan, session.trial));
    Screens screens;
    screens.doing = BrowsingMaps{};
    screens.view.maps = make_map_browser(session.scene, map_choices());
    const auto coloured = [&](const Session& of) {
        State state = of.state;
        OffScreen screen(1280, 800);
        const Pixels picture = draw(of, {}, screens, screen, state);
        int count = 0;
        for (std::size_t at = 0; at < picture.rgb.size(); at += 3) {
            const int high = std::max({picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]});
            const int low = std::min({picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]});
            count += high - low > 60;
        }
        return count;
    };
    CHECK(coloured(session) < 2000);  // the panels are grey
    for (const Sample& sample : finished_trace(*session.plan, session.state).samples) take_sample(sample, session);
    REQUIRE(session.trial.finished);
    CHECK(may_show_maps(*session.plan, session.trial));
    CHECK(coloured(session) > 100000);
    session.scene = load_scene("button");  // a part has nodules neither to find nor to hide
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    begin_trial({}, whole.info, TrialMode::test, session);
    CHECK(may_show_maps(*session.plan, session.trial));
}

TEST_CASE("screens: a map that cannot be read leaves the one that is shown, and says why") {
    Session session;
    session.scene = load_scene("");
    const auto browser = make_map_browser(session.scene, map_choices());
    REQUIRE(browser->map.n_cells() > 0);
    const std::string name = browser->map.name;
    choose_map("/no/such.map", *browser);
    CHECK(browser->problem.find("/no/such.map") != std::string::npos);
    CHECK(browser->map.name == name);
    for (int i = 0; i < 6; ++i) add_pin({0.01 * i, 0.05}, *browser);
    CHECK(browser->pins_m.size() == kPins);
    CHECK(browser->pins_m.back().x() == close_to(0.05));
}
