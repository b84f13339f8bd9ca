// The app does one thing at a time; what it leaves ends there. Off screen.

#include <doctest/doctest.h>

#include "app/screens/calibrate_screen.h"
#include "tests/app/live/desk.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

Wishes wish(Screen screen) {
    Wishes wishes;
    wishes.screen = screen;
    return wishes;
}

}  // namespace

TEST_CASE("go to: each screen that can be asked for opens, and leads back to the trial") {
    Desk desk("");
    const auto open = [&](Screen screen) { carry_out(wish(screen), desk.window, desk.gui, desk.app); };
    open(Screen::devices);
    CHECK(std::holds_alternative<CheckingDevices>(desk.app.doing));
    desk.show_frame();
    open(Screen::scale);
    CHECK(std::holds_alternative<MeasuringScreen>(desk.app.doing));
    desk.show_frame();
    open(Screen::calibrate);
    CHECK(std::holds_alternative<Calibrating>(desk.app.doing));
    desk.show_frame();
    open(Screen::maps);
    CHECK(std::holds_alternative<BrowsingMaps>(desk.app.doing));
    CHECK(desk.app.view.maps);
    desk.show_frame();
    open(Screen::tactile);
    CHECK(std::holds_alternative<WatchingTactile>(desk.app.doing));
    desk.show_frame();
    open(Screen::trial);
    CHECK(std::holds_alternative<Palpating>(desk.app.doing));
    CHECK_FALSE(desk.app.view.maps);
    CHECK(desk.app.check);  // what it measured outlives its screen
    desk.show_frame();
}

TEST_CASE("go to: back from a screen is the trial that goes on, or what the finished one revealed") {
    Desk desk("");
    act(Action::finish, desk.window, desk.app);
    const double score = std::get<Reviewing>(desk.app.doing).debrief.area.at_least[0];
    open_screen(Screen::scale, desk.window, desk.app);
    open_screen(Screen::trial, desk.window, desk.app);
    REQUIRE(std::holds_alternative<Reviewing>(desk.app.doing));
    CHECK(std::get<Reviewing>(desk.app.doing).debrief.area.at_least[0] == score);
}

TEST_CASE("go to: a press ends with the screen that it began on, and with the trial") {
    Desk desk("");
    desk.sample(Phase::down);
    REQUIRE(desk.app.session.state.pointer);
    SUBCASE("another screen") { open_screen(Screen::devices, desk.window, desk.app); }
    SUBCASE("a new trial") { begin_anew(desk.window, desk.gui, desk.app); }
    CHECK_FALSE(desk.app.session.state.pointer);
    CHECK_FALSE(desk.app.session.state.touch.down);
}

TEST_CASE("go to: a calibration that a new trial is begun from is closed") {
    Desk desk("");
    desk.keeper.busy = false;
    open_screen(Screen::calibrate, desk.window, desk.app);
    const std::shared_ptr<CalibrateForm> form = std::get<Calibrating>(desk.app.doing).form;
    desk.app.notices.profiles.clear();
    begin_anew(desk.window, desk.gui, desk.app);
    CHECK(std::holds_alternative<Palpating>(desk.app.doing));
    CHECK(form.use_count() == 1);                    // nobody holds it, or its sensor
    CHECK_FALSE(desk.app.notices.profiles.empty());  // what it kept can be chosen
}

TEST_CASE("go to: the menu is of the trial and of the verdict, and closes with them") {
    Desk desk("");
    Wishes menu;
    menu.menu = true;
    carry_out(menu, desk.window, desk.gui, desk.app);
    CHECK(std::get<Palpating>(desk.app.doing).menu);
    CHECK_FALSE(keys_move_indenter(desk.app.doing));
    open_screen(Screen::devices, desk.window, desk.app);
    CHECK(keys_move_indenter(desk.app.doing));
    carry_out(menu, desk.window, desk.gui, desk.app);  // there is none here
    CHECK(keys_move_indenter(desk.app.doing));
    open_screen(Screen::trial, desk.window, desk.app);
    CHECK_FALSE(std::get<Palpating>(desk.app.doing).menu);
}

TEST_CASE("go to: a trial that was stopped stays stopped on every screen, until another one begins") {
    Desk desk("");
    desk.keeper.busy = false;
    desk.app.course = TrialStopped{"the disk is full"};
    open_screen(Screen::scale, desk.window, desk.app);
    open_screen(Screen::trial, desk.window, desk.app);
    CHECK(trial_stopped(desk.app));
    begin_anew(desk.window, desk.gui, desk.app);
    CHECK_FALSE(trial_stopped(desk.app));
}

TEST_CASE("go to: during a test maps and history stay closed, and the note speaks of both") {
    Desk desk("");
    desk.app.session.trial.mode = TrialMode::test;
    for (const Screen screen : {Screen::maps, Screen::history}) {
        desk.app.notices.note.clear();
        open_screen(screen, desk.window, desk.app);
        CHECK(std::holds_alternative<Palpating>(desk.app.doing));
        CHECK(desk.app.notices.note == "Maps and results show where the nodules are. Finish the test first.");
    }
}
