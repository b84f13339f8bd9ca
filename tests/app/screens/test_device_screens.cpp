// Screens of arm and pins, soft devices and parts at the sizes of desks and tablets.

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

#include "app/scene_choices.h"
#include "app/screens/tactile_screen.h"
#include "app/screens/tangible_screen.h"
#include "tests/app/screens/screen_checks.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

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
    TactileShown silent = running;
    silent.moment.fault = "nothing comes from the arm, nor from the pins";
    silent.moment.silent_s = 1234.5;
    silent.moment.stiffness_delay_N_s_per_m = kMissing;
    CHECK(force_now_N(running.moment) == running.moment.force_N);
    CHECK(force_now_N(stopped.moment) == 0.0);
    CHECK(force_now_N(silent.moment) == 0.0);
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
        draw_it(screen, silent, "tactile-silent");
        draw_it(screen, failed, "tactile-failed");
        draw_it(screen, drawn, "tactile-drawn");
        draw_it(screen, many, "tactile-many");
        draw_it(trial, running, "trial-pins");
        draw_it(trial, stopped, "trial-pins-stopped");
    }
}

TEST_CASE("screens: a fault of a device that goes by itself is told below the trial, while the device runs") {
    Session session;
    session.scene = load_scene("");
    session.plan = std::make_shared<const Plan>(make_plan(session.scene));
    begin_trial({}, read_trace(default_trace()).info, TrialMode::practice, session);
    const Case c{1280, 800, kMissing, false};
    OffScreen off_screen = screen_of(c);
    TactileShown tactile = pressed_tactile();
    TangibleShown soft;
    soft.runs = true;
    // the pixels of the lowest rows
    const auto band = [&](const TactileShown* pins, const TangibleShown* tangible) {
        Screens trial;
        trial.tactile = pins;
        trial.tangible = tangible;
        State state = session.state;
        const Pixels picture = draw(session, {}, trial, off_screen, state);
        const auto row = static_cast<std::size_t>(3 * picture.width);
        return std::vector<unsigned char>(picture.rgb.end() - static_cast<std::ptrdiff_t>(50 * row), picture.rgb.end());
    };
    const auto quiet = band(&tactile, nullptr);
    tactile.moment.fault = "nothing comes from the arm";
    CHECK(band(&tactile, nullptr) != quiet);
    tactile.runs = false;
    CHECK(band(&tactile, nullptr) == quiet);
    const auto soft_quiet = band(nullptr, &soft);
    soft.moment.fault = "nothing comes from the sensor";
    CHECK(band(nullptr, &soft) != soft_quiet);
    soft.moment.held = true;
    CHECK(band(nullptr, &soft) == soft_quiet);
}

TEST_CASE("arm and pins: the link of an arm that is silent has the time since its last answer, and no round trips") {
    TactileMoment moment = pressed_tactile().moment;
    CHECK(link_text(moment) == "0.21 ms (p99 0.48), 3 lost");
    moment.silent_s = 25.04;
    CHECK(link_text(moment) == "no answer for 25.0 s");
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
    body.actuators = {{"left cable", false, true, 0.25, 5.5, {{-0.09f, 0.0f, -0.04f}}, 7},
                      {"right cable", false, true, 0.25, 5.5, {{0.09f, 0.0f, -0.04f}}, 757}};
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
    m.length[0] = m.length[1] = 40.72e-3;
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
    many.body.actuators.resize(kMostTangibleActuators, {"chamber in front", true, false, 0.0, 5e3, {}, -1});
    many.moment.wanted_N = many.moment.rendered_N = many.moment.depth_m = many.moment.world_depth_m = kMissing;
    many.moment.compliance.fill(kMissing);
    many.shape = std::make_shared<TangibleShape>(*running.shape);
    many.shape->node_m[10] = {NAN, NAN, NAN};
    TangibleShown led = running;
    led.device_leads = true;
    TangibleShown absent = failed;
    absent.device_leads = true;
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
        draw_it(trial, led, "trial-tangible-leads");
        draw_it(trial, absent, "trial-tangible-absent");
    }
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
    Screens keys;
    keys.view = pressed.view;
    keys.view.help = true;
    for (const Case& c :
         {Case{1280, 800, kMissing, false}, Case{800, 1280, kMissing, false}, Case{2560, 1600, 11.8, true},
          Case{1024, 600, kMissing, true}, Case{1280, 800, kMissing, false, false, 140}}) {
        OffScreen screen = screen_of(c);
        check_case(session, keys, c, "parts-keys", screen);
        CHECK(screen.pixels()[0] < 10);  // behind the list is the dark of parts, where a tissue's is 12
        check_case(session, pressed, c, "parts", screen);
        check_case(session, changed, c, "parts-changed", screen);
        check_case(button, pressed, c, "parts-button", screen);
    }
}
