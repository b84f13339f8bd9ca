// Every control is reached by keys alone. Off screen.

#include <doctest/doctest.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <memory>
#include <string>

#include "app/screens/history_screen.h"
#include "app/screens/map_screen.h"
#include "app/screens/tactile_screen.h"
#include "tests/app/live/desk.h"
#include "tests/app/screens/typing.h"

using namespace palpa;
using namespace palpa::app;
using namespace palpa::test;

namespace {

void press(Desk& desk, SDL_Keycode key) {
    tap(desk.window, key);
    live_frames(desk, 6);
}

std::shared_ptr<HistoryView> open_history(Desk& desk) {
    auto history = std::make_shared<HistoryView>();
    for (int i = 0; i < 3; ++i) {
        session::KeptTrial kept;
        kept.utc = "2026-11-1" + std::to_string(i) + "T09:30:00Z";
        kept.scene = "s";
        kept.width_mm = kept.height_mm = 100.0;
        kept.path = {{0.0, 0.0, 0.0, 0.0, true}, {60.0, 1.0, 1.0, 1.0, false}};
        history->trials.push_back(kept);
    }
    choose_trial(2, *history);
    open_screen(Screen::history, desk.window, desk.app);
    desk.app.view.history = history;
    live_frames(desk, 6);
    return history;
}

}  // namespace

TEST_CASE("keys: the list of trials is reached by arrows, and from it what deletes them and what plays them") {
    for (const bool deletes : {true, false}) {
        CAPTURE(deletes);
        Desk desk("");
        const std::shared_ptr<HistoryView> shown = open_history(desk);
        HistoryView& history = *shown;
        press(desk, SDLK_DOWN);  // shows the ring
        press(desk, SDLK_DOWN);
        press(desk, SDLK_RETURN);
        CHECK(history.chosen == 0);
        press(desk, SDLK_DOWN);  // below the oldest trial
        if (!deletes) press(desk, SDLK_DOWN);
        const bool played = history.plays;
        press(desk, SDLK_RETURN);
        CHECK(history.asks == deletes);
        CHECK((history.plays != played) == !deletes);
        press(desk, SDLK_ESCAPE);  // answers the question, or leaves the screen
        CHECK_FALSE(history.asks);
        CHECK(std::holds_alternative<BrowsingHistory>(desk.app.doing) == deletes);
    }
}

TEST_CASE("keys: the list of maps is reached by arrows") {
    Desk desk("");
    open_screen(Screen::maps, desk.window, desk.app);
    MapBrowser& browser = *desk.app.view.maps;
    REQUIRE_FALSE(browser.file.empty());
    live_frames(desk, 6);
    browser.maps.push_back({"another", "/nowhere/another.map"});
    for (int i = 0; i < 12; ++i) press(desk, SDLK_DOWN);
    press(desk, SDLK_RETURN);
    CHECK(browser.problem.find("another.map") != std::string::npos);  // which is not there
}

TEST_CASE("keys: no arrow leads onto the frame of the screen's scale, which is dragged") {
    Desk desk("");
    open_screen(Screen::scale, desk.window, desk.app);
    live_frames(desk, 6);
    const double before = desk.app.view.scale.card_px_per_mm;
    for (int i = 0; i < 3; ++i) press(desk, SDLK_DOWN);  // the field, *Save*, and nothing below
    press(desk, SDLK_RETURN);
    CHECK(desk.app.view.scale.card_px_per_mm == before);
}

TEST_CASE("keys: Escape dismisses a problem only where it is seen, and leads back from other screens, list and menu") {
    Desk desk("");
    desk.app.notices.problems = {"the result could not be written"};
    live_frames(desk, 6);
    for (const SDL_Keycode opens : {SDLK_v, SDLK_b, SDLK_t, SDLK_F1, SDLK_F10}) {
        CAPTURE(opens);
        press(desk, opens);
        press(desk, SDLK_ESCAPE);
        CHECK(palpates(desk.app.doing));
        CHECK_FALSE(desk.app.view.help);
        CHECK(desk.app.notices.problems.size() == 1);
    }
    press(desk, SDLK_ESCAPE);
    CHECK(desk.app.notices.problems.empty());
}

TEST_CASE("keys: a problem below the tools of parts is scrolled to, so that Escape dismisses what was seen") {
    Desk desk("button");
    live_frames(desk, 6);
    desk.app.notices.problems = {"the change could not be kept"};
    live_frames(desk, 6);
    press(desk, SDLK_ESCAPE);
    CHECK(desk.app.notices.problems.empty());
}

TEST_CASE("keys: Y asks for the list of studies in the browser, and for nothing elsewhere") {
    for (const bool browser : {false, true}) {
        Desk desk("");
        desk.app.notices.keeps_trials = browser;
        live_frames(desk, 6);
        tap(desk.window, SDLK_y);
        bool asked = false;
        std::vector<platform::Sample> samples;
        for (int i = 0; i < 6; ++i) {
            desk.window.poll(0.0, samples);
            asked = desk.show_frame().studies || asked;
        }
        CHECK(asked == browser);
    }
}

TEST_CASE("keys: a list of keys that does not fit scrolls") {
    Desk desk("");
    desk.app.view.help = true;
    desk.gui.set_scale(3.78f, 1.4f);
    live_frames(desk, 6);
    const auto scrolled = [] {
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            if (std::string(window->Name).find("help/keys") != std::string::npos) return window->Scroll.y;
        }
        return -1.0f;
    };
    REQUIRE(scrolled() == 0.0f);
    press(desk, SDLK_END);
    const float all_px = scrolled();
    CHECK(all_px > 0.0f);
    press(desk, SDLK_UP);
    CHECK(scrolled() < all_px);
    press(desk, SDLK_HOME);
    CHECK(scrolled() == 0.0f);
    press(desk, SDLK_END);
    desk.app.view.help = false;
    live_frames(desk, 6);
    desk.app.view.help = true;
    live_frames(desk, 6);
    CHECK(scrolled() == 0.0f);  // opened again, a page begins at its top
}

TEST_CASE("keys: devices that F12 stopped are released in the next trial too") {
    Desk desk("");
    TactileShown& shown = desk.app.tactile.shown.emplace();
    shown.moment.rows = shown.moment.columns = 6;
    shown.moment.stopped = true;
    shown.moment.fault = "F12";
    open_screen(Screen::tactile, desk.window, desk.app);
    live_frames(desk, 6);
    press(desk, SDLK_RIGHT);
    press(desk, SDLK_RIGHT);
    press(desk, SDLK_RETURN);
    CHECK_FALSE((desk.app.tactile.shown && desk.app.tactile.shown->moment.stopped));
}
