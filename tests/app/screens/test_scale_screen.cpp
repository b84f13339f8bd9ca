// The field of the screen's scale takes numbers that a screen can have, and no others. Off screen.

#include <doctest/doctest.h>

#include "tests/app/live/desk.h"
#include "tests/app/screens/typing.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::app;
using namespace palpa::test;

TEST_CASE("scale screen: what is typed counts while it is a scale that a screen can have") {
    Desk desk("");
    open_screen(Screen::scale, desk.window, desk.app);
    frames(desk, 5);
    click(desk.window, 75, 105);
    frames(desk, 5);
    REQUIRE(desk.gui.text_field());
    const auto type_anew = [&](const std::string& text) {
        tap(desk.window, SDLK_a, KMOD_LCTRL);
        for (const char letter : text) type(desk.window, letter);
        frames(desk, 30);
    };
    type_anew("8.5");
    CHECK(desk.app.view.card_px_per_mm == 8.5);
    type_anew("-1e");
    CHECK(desk.app.view.card_px_per_mm == 8.5);
    type_anew("nan");
    CHECK(desk.app.view.card_px_per_mm == 8.5);
    type_anew("0");
    CHECK(desk.app.view.card_px_per_mm == 8.5);
    tap(desk.window, SDLK_RETURN);
    frames(desk, 10);
    CHECK(desk.app.view.card_px_per_mm == 8.5);
    CHECK(std::holds_alternative<MeasuringScreen>(desk.app.doing));  // no letter was a shortcut
}
