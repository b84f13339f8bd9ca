// The numbers of a scale are typed while the pen is held down. Off screen.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <doctest/doctest.h>
#include <filesystem>
#include <memory>
#include <stdlib.h>
#include <string>
#include <thread>

#include "app/screens/calibrate_screen.h"
#include "app/screens/words.h"
#include "devices/force_sensor.h"
#include "tests/app/live/desk.h"
#include "tests/app/screens/typing.h"
#include "tests/close_to.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::app;
using namespace palpa::test;

namespace {

// A pen that has been held still at this pressure for so long.
void hold(double pressure, calibration::Recording& recording, double seconds = 2.0) {
    std::vector<Sample> samples;
    const double now_s = devices::steady_s();
    for (int i = 0; i <= 200; ++i) {
        Sample sample;
        sample.t_host_s = now_s - seconds * (200 - i) / 200.0;
        sample.tool = Tool::pen;
        sample.phase = i == 0 ? Phase::down : Phase::move;
        sample.pressure = pressure;
        samples.push_back(sample);
    }
    calibration::step(samples, recording);
}

std::shared_ptr<CalibrateForm> open_form(Desk& desk) {
    open_screen(Screen::calibrate, desk.window, desk.app);
    return std::get<Calibrating>(desk.app.doing).form;
}

// Begins a recording whose forces are typed in.
void open_typed(const TemporaryFolder& folder, CalibrateForm& form) {
    calibration::RecordArguments arguments;
    arguments.folder = (folder / "c").string();
    arguments.sensor = "typed";
    form.recording = calibration::open_recording(arguments);
}

}  // namespace

TEST_CASE("calibrate screen: Enter takes the number that the scale shows, and the next one can be typed at once") {
    const TemporaryFolder folder;
    Desk desk("");
    CalibrateForm& form = *open_form(desk);
    open_typed(folder, form);
    form.guide.again = true;  // as if the field had been clicked
    frames(desk, 5);
    hold(0.02, *form.recording);
    type(desk.window, '5');
    tap(desk.window, SDLK_RETURN);
    frames(desk, 8);
    REQUIRE(form.recording->session.points.size() == 1);
    CHECK(form.recording->session.points[0].force_N == close_to(5.0 * calibration::kN_per_gf));
    CHECK(form.guide.note == "Recorded.");
    tap(desk.window, SDLK_RETURN);  // twice
    frames(desk, 8);
    CHECK(form.recording->session.points.size() == 1);
    CHECK(form.guide.note == "Recorded.");
    form.guide.again = true;
    frames(desk, 5);
    hold(0.02, *form.recording);  // still, also on a computer that took long for these frames
    type(desk.window, '7');
    tap(desk.window, SDLK_RETURN);
    frames(desk, 8);
    CHECK(std::isnan(form.guide.shown_gf));
    CHECK(form.recording->session.points.size() == 2);
    form.guide.again = true;
    frames(desk, 5);
    for (const char letter : std::string("12000")) type(desk.window, letter);
    tap(desk.window, SDLK_RETURN);
    frames(desk, 16);
    CHECK(form.guide.note == words::kNotAForce);
    CHECK(form.recording->session.points.size() == 2);
    form.guide.note.clear();
    form.guide.again = true;
    frames(desk, 5);
    tap(desk.window, SDLK_BACKSPACE);  // the field is empty now
    tap(desk.window, SDLK_RETURN);
    frames(desk, 16);
    CHECK(form.guide.note == words::kNotAForce);
    CHECK(form.recording->session.points.size() == 2);
    calibration::drop_last_point(*form.recording);
    CHECK(form.recording->session.points.size() == 1);
    hold(0.02, *form.recording);
    CHECK(calibration::take_typed_N(7.0 * calibration::kN_per_gf, *form.recording));  // the same place again
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    hold(0.06, *form.recording, 1.0);  // another level, and the scale shows the same number
    form.guide.again = true;
    frames(desk, 5);
    type(desk.window, '7');
    tap(desk.window, SDLK_RETURN);
    frames(desk, 8);
    REQUIRE(form.recording->session.points.size() == 3);
    CHECK(form.recording->session.points[2].force_N == close_to(7.0 * calibration::kN_per_gf));
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    hold(0.5, *form.recording, 1.0);  // another level, where nothing was read from the scale yet
    tap(desk.window, SDLK_RETURN);
    frames(desk, 8);
    CHECK(form.recording->session.points.size() == 3);
    CHECK(form.guide.note == "Recorded.");
    for (int left = 2; left >= 0; --left) {
        calibration::drop_last_point(*form.recording);
        frames(desk, 8);
        CHECK(form.recording->session.points.size() == static_cast<std::size_t>(left));
    }
    frames(desk, 30);  // without any point there is no curve
    CHECK_FALSE(form.guide.fit);
}

TEST_CASE("calibrate screen: while the pen presses the field takes the keys, also after another button was pressed") {
    const TemporaryFolder folder;
    Desk desk("");
    CalibrateForm& form = *open_form(desk);
    open_typed(folder, form);
    form.guide.again = false;
    form.guide.note = words::kRecorded;  // of the press before
    frames(desk, 5);
    hold(0.02, *form.recording);
    frames(desk, 8);
    CHECK(form.guide.note.empty());
    hold(0.02, *form.recording);
    for (const char letter : std::string("110")) type(desk.window, letter);
    tap(desk.window, SDLK_RETURN);
    frames(desk, 12);
    REQUIRE(form.recording->session.points.size() == 1);
    CHECK(form.recording->session.points[0].force_N == close_to(110.0 * calibration::kN_per_gf));
}

TEST_CASE("calibrate screen: a decimal comma is a decimal point, and not left out") {
    const TemporaryFolder folder;
    Desk desk("");
    CalibrateForm& form = *open_form(desk);
    open_typed(folder, form);
    frames(desk, 5);
    hold(0.02, *form.recording);
    frames(desk, 8);
    for (const char letter : std::string("12,5")) type(desk.window, letter);
    tap(desk.window, SDLK_RETURN);
    frames(desk, 12);
    REQUIRE(form.recording->session.points.size() == 1);
    CHECK(form.recording->session.points[0].force_N == close_to(12.5 * calibration::kN_per_gf));
}

TEST_CASE("calibrate screen: points that make no profile say why, and the session goes on") {
    const TemporaryFolder folder;
    ::setenv("XDG_DATA_HOME", folder.path().c_str(), 1);
    CalibrateForm form;
    std::snprintf(form.name, sizeof form.name, "pen");
    open_typed(folder, form);
    const auto press = [&](double pressure, double force_N) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1200));
        hold(pressure, *form.recording, 1.0);
        CHECK(calibration::take_typed_N(force_N, *form.recording));
    };
    press(0.1, 0.3);
    press(0.3, 0.9);
    keep_profile(form);
    CHECK(form.problem.find("found 2 distinct levels") != std::string::npos);
    REQUIRE(form.recording);
    press(0.6, 60.5);  // N, mistyped
    keep_profile(form);
    CHECK(form.problem.find("found forces up to 60.5 N") != std::string::npos);
    REQUIRE(form.recording);
    calibration::drop_last_point(*form.recording);
    press(0.6, 2.5);
    keep_profile(form);
    CHECK(form.problem.empty());
    CHECK_FALSE(form.recording);
    CHECK(std::filesystem::exists(folder / "palpa/profiles/pen.json"));
}

TEST_CASE("calibrate screen: the curve is the one that the profile gets, and why there is none stays on the screen") {
    const TemporaryFolder folder;
    Desk desk("");
    CalibrateForm& form = *open_form(desk);
    open_typed(folder, form);
    std::vector<calibration::CapturedPoint>& points = form.recording->session.points;
    const auto frames_until_fitted = [&] {
        for (int i = 0; i < 2000 && (form.guide.fitted != points.size() || form.guide.next_fit.valid()); ++i) {
            frames(desk, 1);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    };
    for (int i = 1; i <= 8; ++i) points.push_back({0.1 * i, 0.1 * i, 0.1 * std::exp(2.8 * i / 8.0), i % 2});
    frames_until_fitted();
    REQUIRE(form.guide.fit);
    const calibration::Calibration fitted = calibration::calibrate(calibration::rows_of(points), {});
    for (const double level : {0.1, 0.25, 0.8}) {
        CHECK(calibration::value_N(form.guide.fit->profile.curve, level) ==
              close_to(calibration::value_N(fitted.profile.curve, level)));
    }
    points.push_back({0.9, 0.9, 117.0, 1});  // a slip
    frames_until_fitted();
    keep_profile(form);
    frames(desk, 3);
    REQUIRE(form.recording);
    CHECK(form.guide.note.find("found forces up to 117") != std::string::npos);
    calibration::drop_last_point(*form.recording);
    frames(desk, 3);
    CHECK(form.guide.note.empty());
}

TEST_CASE("calibrate screen: a load cell's newtons per count are asked for, and never assumed") {
    CalibrateForm form;
    CHECK(std::string(number_to_type(form)).empty());  // a scale needs none
    form.kind = 2;
    CHECK(std::string(number_to_type(form)) == words::kGiveNPerCount);
    form.N_per_count = std::nan("");
    CHECK(std::string(number_to_type(form)) == words::kGiveNPerCount);
    form.N_per_count = -2e-5;
    CHECK(std::string(number_to_type(form)).empty());
    form.kind = 1;
    CHECK(std::string(number_to_type(form)).empty());  // the sensor's own default
    for (const double wrong : {0.0, -1e6, std::nan(""), HUGE_VAL}) {
        form.counts_per_N = wrong;
        CHECK(std::string(number_to_type(form)) == words::kGiveCountsPerN);
    }
}

TEST_CASE("calibrate screen: a mouse has no pressure, and is told so instead of being recorded") {
    const TemporaryFolder folder;
    Desk desk("");
    CalibrateForm& form = *open_form(desk);
    open_typed(folder, form);
    Sample sample;
    sample.t_host_s = devices::steady_s();
    sample.tool = Tool::mouse;
    sample.phase = Phase::down;
    sample.pressure = 0.0;
    step_calibrate({sample}, form);
    CHECK(form.recording->session.levels.empty());
    CHECK(form.guide.note.find("mouse") != std::string::npos);
    sample.tool = Tool::pen;
    sample.pressure = 0.3;
    step_calibrate({sample}, form);
    CHECK(form.recording->session.levels.size() == 1);
}

TEST_CASE("calibrate screen: a device that does not report the level is told so, and its samples are counted") {
    const TemporaryFolder folder;
    calibration::RecordArguments arguments;
    arguments.folder = (folder / "c").string();
    arguments.sensor = "typed";
    arguments.level.level = calibration::LevelField::contact_area;
    const auto recording = calibration::open_recording(arguments);
    CHECK(calibration::advice(*recording).rfind("press to ", 0) == 0);
    hold(0.5, *recording);  // a pen without a contact area
    CHECK(calibration::advice(*recording) == "this device reports no contact_area");
    CHECK(calibration::close_recording(*recording)["without_level"] == 201);
}
