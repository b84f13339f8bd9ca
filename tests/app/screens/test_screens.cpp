// Every screen at the sizes of desks and tablets: nothing blank, nothing that does not fit. Drawn without a display.

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <stdlib.h>

#include "app/scene_choices.h"
#include "app/screens/calibrate_form.h"
#include "app/screens/calibrate_screen.h"
#include "app/screens/frame.h"
#include "app/screens/history_screen.h"
#include "app/screens/map_screen.h"
#include "app/screens/tactile_screen.h"
#include "app/screens/tangible_screen.h"
#include "app/study/study_run.h"
#include "scene/advance.h"
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

struct Pixels {
    int width = 0;
    int height = 0;
    std::vector<unsigned char> rgb;
};

// Counts up to `enough` colours.
std::size_t colours_in(const Pixels& picture, const PanelArea& area, std::size_t enough) {
    std::vector<bool> seen(std::size_t{1} << 24);
    std::size_t colours = 0;
    for (int y = static_cast<int>(area.y0); y < static_cast<int>(area.y1); ++y) {
        for (int x = static_cast<int>(area.x0); x < static_cast<int>(area.x1); ++x) {
            const unsigned char* p = &picture.rgb[3 * static_cast<std::size_t>(y * picture.width + x)];
            const auto colour = static_cast<std::size_t>((p[0] << 16) | (p[1] << 8) | p[2]);
            if (seen[colour]) continue;
            seen[colour] = true;
            if (++colours == enough) return colours;
        }
    }
    return colours;
}

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

struct Case {
    int width_px, height_px;
    double px_per_mm;
    bool left_handed;
    bool above_finger = false;
    int text_percent = 100;
};

// The folder for pictures to be looked at, or null.
const char* kept_pictures() { return ::getenv("PALPA_KEEP_PICTURES"); }

// What is open, and what the app says.
struct Screens {
    Notices notices{};
    Doing doing{};
    std::optional<Wishes> asked{};
    ViewState view{};
    const TactileShown* tactile = nullptr;
    const TangibleShown* tangible = nullptr;
};

bool covers_all(const Screens& screens) {
    return screens.asked || screens.view.help || (menu_of(screens.doing) == nullptr && !palpates(screens.doing));
}

// Draws a few frames, since panels find their size in the first. Returns the pixels of the last.
Pixels draw(const Session& session, const Settings& settings, const Screens& screens, OffScreen& screen, State& state) {
    ViewState view = screens.view;
    for (int i = 0; i < 3; ++i) {
        screen.draw({session.scene, *session.plan, session.trial, settings, screens.notices, screens.doing,
                     screens.asked, state.timeline.now_s, 1.0 / 60.0, screens.tactile, screens.tangible},
                    view, state);
    }
    return {screen.window().width_px(), screen.window().height_px(), screen.pixels()};
}

OffScreen screen_of(const Case& c) { return {c.width_px, c.height_px, c.px_per_mm, c.text_percent}; }

void check_case(const Session& session, Screens& screens, const Case& c, const std::string& name, OffScreen& screen) {
    CAPTURE(name);
    CAPTURE(c.width_px);
    CAPTURE(c.height_px);
    Settings settings;
    settings.left_handed = c.left_handed;
    settings.above_finger = c.above_finger;
    settings.text_percent = c.text_percent;
    screens.notices.px_per_mm = c.px_per_mm;
    State state = session.state;
    const auto width_px = static_cast<float>(c.width_px);
    const auto height_px = static_cast<float>(c.height_px);
    const float hand_mm = control_scale(c.px_per_mm, width_px, height_px);
    const float mm = larger_scale(hand_mm, 0.01f * static_cast<float>(c.text_percent), width_px, height_px);
    const Layout layout = layout_of(width_px, height_px, mm, c.left_handed, c.above_finger, hand_mm);
    const PanelArea& t = layout.tissue_px;
    Sample resize;
    resize.phase = Phase::ui;
    resize.action = Action::resize;
    resize.x_px = static_cast<double>(t.x0);
    resize.y_px = static_cast<double>(t.y0);
    resize.width_px = static_cast<double>(t.width());
    resize.height_px = static_cast<double>(t.height());
    advance(session.scene, *session.plan, resize, state);
    const Pixels picture = draw(session, settings, screens, screen, state);
    CHECK(screen.gui().overflow() == "");
    CHECK(picture.width == c.width_px);
    constexpr std::size_t kTextHas = 40;  // colours of smoothed letters
    const PanelArea all{0.0f, 0.0f, static_cast<float>(c.width_px), static_cast<float>(c.height_px)};
    if (layout.controls)
        CHECK(colours_in(picture, covers_all(screens) ? all : layout.controls_px, kTextHas) == kTextHas);
    CHECK(colours_in(picture, covers_all(screens) ? all : layout.tissue_px, kTextHas) == kTextHas);
    if (const char* keep = kept_pictures()) {
        const std::string size = std::to_string(c.width_px) + "x" + std::to_string(c.height_px);
        save_screen(screen.window(), std::filesystem::path(keep) / (name + "-" + size + (c.left_handed ? "-left" : "") +
                                                                    (c.text_percent > 100 ? "-large" : "") + ".png"));
    }
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
        trial.notices.device_notes = {"This pen reports always the same pressure: it has no sensor."};
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
                          {1024, 600, kMissing, true},
                          {1280, 800, kMissing, false, false, 140},
                          {200, 100, kMissing, false}};
    for (const Case& c : cases) {
        OffScreen screen = screen_of(c);
        check_case(session, trial, c, "trial", screen);
        if (c.width_px < 600) continue;  // panels need some room
        check_case(marked, asked, c, "asked", screen);
        check_case(session, menu, c, "menu", screen);
        check_case(session, menu_settings, c, "menu-settings", screen);
        check_case(session, menu_experimenter, c, "menu-experimenter", screen);
        check_case(session, help, c, "help", screen);
        check_case(session, guided, c, "guided", screen);
        check_case(stopped, trial, c, "paused", screen);
        check_case(session, history, c, "history", screen);
        check_case(done, guided_result, c, "guided-result", screen);
        check_case(session, cost, c, "cost", screen);
        check_case(session, scale, c, "scale", screen);
        check_case(session, devices, c, "devices", screen);
        check_case(session, calibrate, c, "calibrate", screen);
        check_case(session, calibrating, c, "calibrating", screen);
        check_case(session, maps, c, "maps", screen);
        check_case(done, reveal, c, "reveal", screen);
    }
}

namespace {

// Arm and pins in the middle of a press, shown by a simulator.
TactileShown pressed_tactile() {
    TactileShown tactile;
    TactileMoment& m = tactile.moment;
    m.time_s = 12.0;
    m.depth_m = 4.1e-3;
    m.force_N = 1.25;
    m.sensor_N = 1.31;
    m.arm = true;
    m.rows = m.columns = 6;
    m.stroke_m = 2e-3;
    for (std::size_t i = 0; i < 36; ++i) {
        const double x = static_cast<double>(i % 6) - 2.5;
        const double y = static_cast<double>(i / 6) - 2.5;
        m.wanted_m[i] = std::clamp(0.16e-3 * (x * x + y * y), 0.0, m.stroke_m);
        m.reached_m[i] = std::max(0.0, m.wanted_m[i] - 1e-4 * static_cast<double>(i % 3));
    }
    m.reached = ReachedBy::simulator;
    m.mismatch_m = 0.087e-3;
    m.mismatch_s = 31e-3;
    m.shape_scale = 0.71;
    m.clipped = 4;
    m.linearity = 0.14;
    m.stiffness_delay_N_s_per_m = 9.5;
    m.round_trip_p50_s = 0.21e-3;
    m.round_trip_p99_s = 0.48e-3;
    m.lost = 3;
    m.step_p50_s = 11e-6;
    m.step_p99_s = 38e-6;
    m.steps = 12000;
    m.late_steps = 2;
    tactile.devices = {{"arm", "One-axis arm with a long name, 1 kHz", "127.0.0.1:49152", true},
                       {"force sensor", "Net F/T", "192.168.1.1:49152", false},
                       {"pins", "6 x 6 pins, three boards", "/dev/serial/by-id/usb-Pololu_Maestro-if00", true}};
    tactile.runs = true;
    tactile.force_limit_N = 2.5;
    return tactile;
}

}  // namespace

TEST_CASE("screens: arm and pins fit at the sizes of desks and tablets: running, stopped, failed, only drawn") {
    Session session;
    session.scene = load_scene("");
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    const Trace whole = read_trace(default_trace());
    begin_trial({}, whole.info, TrialMode::practice, session);
    for (std::size_t i = 0; i < 400; ++i) take_sample(whole.samples[i], session);
    const TactileShown running = pressed_tactile();
    TactileShown stopped = running;
    stopped.moment.stopped = true;
    stopped.moment.fault = "F12";
    TactileShown failed;
    failed.problem =
        "assets/devices/pins-6x6.json: boards[0].port: found nothing at /dev/ttyACM0, expected the serial port of a "
        "board";
    TactileShown drawn = running;
    drawn.devices.clear();
    drawn.runs = false;
    drawn.moment.reached = ReachedBy::nothing;
    drawn.moment.arm = false;
    TactileShown many = running;  // as many pins as there may be
    many.moment.rows = many.moment.columns = 12;
    many.moment.held = true;
    Screens screen{{}, WatchingTactile{}};
    Screens trial;
    constexpr double kTablet_px_per_mm = 11.8;
    for (const Case& c : {Case{1280, 800, kMissing, false}, Case{800, 1280, kMissing, false},
                          Case{2560, 1600, kTablet_px_per_mm, false}, Case{1024, 600, kMissing, true},
                          Case{1280, 800, kMissing, false, false, 140}}) {
        OffScreen off_screen = screen_of(c);
        const auto draw_it = [&](Screens& screens, const TactileShown& tactile, const char* name) {
            screens.tactile = &tactile;
            check_case(session, screens, c, name, off_screen);
        };
        draw_it(screen, running, "tactile");
        draw_it(screen, stopped, "tactile-stopped");
        draw_it(screen, failed, "tactile-failed");
        draw_it(screen, drawn, "tactile-drawn");
        draw_it(screen, many, "tactile-many");
        draw_it(trial, running, "trial-pins");
        draw_it(trial, stopped, "trial-pins-stopped");
    }
}

namespace {

// The surface of a strip of 50 x 4 x 2 cells, sagged by a press in its middle.
void strip_surface(TangibleShown& soft) {
    constexpr int kX = 50, kY = 4, kZ = 2;
    const auto node = [](int i, int j, int k) { return (i * (kY + 1) + j) * (kZ + 1) + k; };
    auto& body = soft.body;
    for (int i = 0; i <= kX; ++i) {
        for (int j = 0; j <= kY; ++j) {
            for (int k = 0; k <= kZ; ++k) {
                const double x = -50e-3 + 2e-3 * i, y = -10e-3 + 5e-3 * j, z = -2e-3 + 2e-3 * k;
                const double sag = 5e-3 * std::exp(-x * x / (18e-3 * 18e-3));
                body.rest_m.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
                soft.shape->node_m[body.rest_m.size() - 1] = {static_cast<float>(x), static_cast<float>(y),
                                                              static_cast<float>(z - sag)};
            }
        }
    }
    for (int i = 0; i < kX; ++i) {
        for (int j = 0; j < kY; ++j) {
            for (const int k : {0, kZ})
                body.faces.push_back({node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)});
        }
        for (int k = 0; k < kZ; ++k) {
            for (const int j : {0, kY})
                body.faces.push_back({node(i, j, k), node(i + 1, j, k), node(i + 1, j, k + 1), node(i, j, k + 1)});
        }
    }
    soft.has_shape = true;
}

// The strip in the middle of a press, shown by a simulated plant.
TangibleShown pressed_strip() {
    TangibleShown soft;
    strip_surface(soft);
    auto& body = soft.body;
    body.device = "Silicone strip";
    body.actuators = {{"left cable", false, 0.25, 5.5, {{-0.09f, 0.0f, -0.04f}}, 7},
                      {"right cable", false, 0.25, 5.5, {{0.09f, 0.0f, -0.04f}}, 757}};
    body.bearings = {{{-0.03f, -0.012f, -0.01f}, {-0.03f, 0.012f, -0.01f}, 8e-3},
                     {{0.03f, -0.012f, -0.01f}, {0.03f, 0.012f, -0.01f}, 8e-3}};
    body.effector_m = {0.0f, 0.0f, 2e-3f};
    body.effector_radius_m = 6e-3;
    body.rate_Hz = 100.0;
    body.rendered = "plant";
    body.algorithm = "step";
    TangibleMoment& m = soft.moment;
    m.time_s = 12.0;
    m.depth_m = m.world_depth_m = m.proxy_m = 5.0e-3;
    m.wanted_N = 0.50;
    m.rendered_N = 0.493;
    m.pressed = true;
    m.gap_m = 0.0412e-3;
    m.by_actuators_m = -0.0400e-3;
    m.compliance[0] = m.compliance[1] = -1.62e-3;
    m.residual_m = 1.2e-6;
    m.rank = 1;
    m.iterations = 3;
    m.actuation[0] = m.actuation[1] = 1.94;
    m.command[0] = m.command[1] = 40.72e-3;
    m.period_p50_s = 10e-3;
    m.period_p99_s = 10.3e-3;
    m.step_p50_s = 3.1e-3;
    m.step_p99_s = 4.6e-3;
    m.ticks = 12034;
    m.missed_ticks = 2;
    m.saturated_ticks = 118;
    m.force_rms_percent = 0.61;
    for (int i = 0; i <= 60; ++i) {
        const double depth_m = 5e-3 * i / 60.0;
        soft.press.push_back({i, depth_m, 100.0 * depth_m, 98.6 * depth_m});
    }
    soft.devices = {{"motors", "Dynamixel, two", "/dev/serial/by-id/usb-FTDI_USB__-__Serial_Converter-if00", true},
                    {"sensor", "displacement", "/dev/pts/7", false}};
    soft.runs = true;
    return soft;
}

}  // namespace

TEST_CASE("screens: a soft device fits at the sizes of desks and tablets: running, limited, stopped, failed, many") {
    Session session;
    session.scene = load_scene("");
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    const Trace whole = read_trace(default_trace());
    begin_trial({}, whole.info, TrialMode::practice, session);
    for (std::size_t i = 0; i < 400; ++i) take_sample(whole.samples[i], session);
    const TangibleShown running = pressed_strip();
    TangibleShown limited = running;
    limited.moment.limited_by = 1;
    limited.moment.active = 3;
    limited.moment.actuation[0] = limited.moment.actuation[1] = 5.5;
    limited.moment.residual_m = 0.84e-3;
    limited.moment.converged = false;
    TangibleShown stopped = running;
    stopped.moment.stopped = true;
    stopped.moment.fault = "F12";
    TangibleShown failed;
    failed.problem =
        "assets/devices/strip.json: wires.ports[0].path: found nothing at /dev/ttyUSB0, expected a serial port";
    TangibleShown many = running;  // as many actuators as there may be, and a moment that tells nothing yet
    many.body.actuators.resize(kMostTangibleActuators, {"chamber in front", true, 0.0, 5e3, {}, -1});
    many.moment.wanted_N = many.moment.rendered_N = many.moment.depth_m = many.moment.world_depth_m = kMissing;
    many.moment.compliance.fill(kMissing);
    many.shape = std::make_shared<TangibleShape>(*running.shape);
    many.shape->node_m[10] = {NAN, NAN, NAN};
    Screens screen{{}, WatchingTangible{}};
    Screens trial;
    constexpr double kTablet_px_per_mm = 11.8;
    for (const Case& c : {Case{1280, 800, kMissing, false}, Case{800, 1280, kMissing, false},
                          Case{2560, 1600, kTablet_px_per_mm, false}, Case{1024, 600, kMissing, true},
                          Case{1280, 800, kMissing, false, false, 140}}) {
        OffScreen off_screen = screen_of(c);
        const auto draw_it = [&](Screens& screens, const TangibleShown& soft, const char* name) {
            screens.tangible = &soft;
            check_case(session, screens, c, name, off_screen);
        };
        draw_it(screen, running, "tangible");
        draw_it(screen, limited, "tangible-limited");
        draw_it(screen, stopped, "tangible-stopped");
        draw_it(screen, failed, "tangible-failed");
        draw_it(screen, many, "tangible-many");
        draw_it(trial, stopped, "trial-tangible-stopped");
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
        run->step = step::Device{false, true};
        check_case(session, screens, c, "study-device-gone", screen);
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
    REQUIRE_FALSE(may_show_maps(session.trial));
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
    CHECK(may_show_maps(session.trial));
    CHECK(coloured(session) > 100000);
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

TEST_CASE("screens: parts fit at the sizes of desks and tablets: pressed, changed by the pen, a button") {
    Session session;
    session.scene = load_scene(PALPA_SOURCE_DIR "/assets/scenes/toothbrush-pull.json");
    std::get<PartOptions>(session.scene.tissue).gesture = PartGesture::press;
    std::get<PartOptions>(session.scene.tissue).both = true;
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    Session button;
    button.scene = load_scene(PALPA_SOURCE_DIR "/assets/scenes/button.json");
    button.plan = std::make_shared<const Plan>(make_plan(button.scene));
    const Trace presses = read_trace(PALPA_SOURCE_DIR "/assets/traces/three-presses.tsv");
    begin_trial({}, presses.info, TrialMode::practice, button);
    for (std::size_t i = 0; i < 95; ++i) take_sample(presses.samples[i], button);
    begin_trial({}, presses.info, TrialMode::practice, session);
    Sample pen;
    pen.tool = Tool::pen;
    for (int i = 0; i < 30; ++i) {
        pen.phase = i == 0 ? Phase::down : Phase::move;
        pen.t_host_s = 0.01 * i;
        pen.pressure = 0.02 * i;
        const Eigen::Vector2d px = px_of_tissue(session.state.view, {0.182, 0.034});
        pen.x_px = px.x();
        pen.y_px = px.y();
        take_sample(pen, session);
    }
    Screens pressed;
    pressed.view.part.magnified = true;
    for (int i = 0; i < 60; ++i) {
        const auto x = static_cast<float>(i) / 60.0f;
        pressed.view.part.press[0].push_back({x, 2.0f * x, 1e-3f * x});
        pressed.view.part.press[1].push_back({x, 2.0f * x, 2e-3f * x});
        pressed.view.part.last[0].push_back({0.8f * x, 1.5f * x, 1e-3f * x});
    }
    pressed.view.part.was_down = true;
    Screens changed;
    changed.view = pressed.view;
    changed.view.part.tool = PartTool::permute;
    changed.view.part.stroke_m = {{0.14, 0.03}, {0.142, 0.031}};
    changed.view.part.pending = 0.4;
    changed.view.part.edits = {2, 0};
    for (const Case& c :
         {Case{1280, 800, kMissing, false}, Case{800, 1280, kMissing, false}, Case{2560, 1600, 11.8, true},
          Case{1024, 600, kMissing, true}, Case{1280, 800, kMissing, false, false, 140}}) {
        OffScreen screen = screen_of(c);
        check_case(session, pressed, c, "parts", screen);
        check_case(session, changed, c, "parts-changed", screen);
        check_case(button, pressed, c, "parts-button", screen);
    }
}
