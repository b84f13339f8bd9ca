// The field of the screen's scale takes numbers that a screen can have, and no others. Off screen.

#include <doctest/doctest.h>
#include <string>
#include <vector>

#include "tests/app/live/desk.h"
#include "tests/app/screens/typing.h"
#include "tests/close_to.h"

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
    CHECK(desk.app.view.scale.card_px_per_mm == 8.5);
    type_anew("-1e");
    CHECK(desk.app.view.scale.card_px_per_mm == 8.5);
    type_anew("nan");
    CHECK(desk.app.view.scale.card_px_per_mm == 8.5);
    type_anew("0");
    CHECK(desk.app.view.scale.card_px_per_mm == 8.5);
    tap(desk.window, SDLK_RETURN);
    frames(desk, 10);
    CHECK(desk.app.view.scale.card_px_per_mm == 8.5);
    CHECK(std::holds_alternative<MeasuringScreen>(desk.app.doing));  // no letter was a shortcut
}

TEST_CASE("scale screen: a number that is refused is not saved, nor what was typed of it before") {
    Desk desk("");
    open_screen(Screen::scale, desk.window, desk.app);
    frames(desk, 5);
    // whether a click anywhere below the field, along the left edge, saves a scale
    const auto saves = [&] {
        bool saved = false;
        for (int y_px = 125; y_px < 300; y_px += 8) {
            std::vector<Sample> samples;
            for (const bool down : {true, false}) {
                button(desk.window, down, 40, y_px);
                desk.window.poll(0.0, samples);
                saved |= desk.show_frame().px_per_mm.has_value();
                frames(desk, 2);
            }
        }
        return saved;
    };
    const auto type_anew = [&](const std::string& text) {
        click(desk.window, 75, 105);
        frames(desk, 5);
        tap(desk.window, SDLK_a, KMOD_LCTRL);
        for (const char letter : text) type(desk.window, letter);
        frames(desk, 30);
    };
    CHECK(saves());
    type_anew("96");
    CHECK_FALSE(saves());
    CHECK(desk.app.view.scale.typed_px_per_mm == 96.0);
    type_anew("7.5");
    CHECK(saves());
    CHECK(desk.app.view.scale.card_px_per_mm == 7.5);
}

TEST_CASE("scale screen: numbers of the ruler do not touch, on coarse screens with large letters either") {
    for (const float px_per_mm : {1.0f, 3.78f, 5.0f, 11.8f, 60.0f}) {
        for (const float number_px : {8.0f, 20.0f, 60.0f}) {
            CAPTURE(px_per_mm);
            CAPTURE(number_px);
            const int step_mm = ruler_step_mm(px_per_mm, number_px);
            CHECK((static_cast<float>(step_mm) * px_per_mm > 1.2f * number_px || step_mm == 80));
            CHECK(80 % step_mm == 0);
        }
    }
    CHECK(ruler_step_mm(11.8f, 20.0f) == 10);
    CHECK(ruler_step_mm(3.78f, 60.0f) == 40);
}

TEST_CASE("scale screen: the frame is as large as it is dragged") {
    Desk desk("");
    open_screen(Screen::scale, desk.window, desk.app);
    frames(desk, 5);
    const double before = desk.app.view.scale.card_px_per_mm;
    const auto drag = [&](int from_x_px, int to_x_px) {
        constexpr int kY_px = 300;
        move_mouse(desk.window, from_x_px, kY_px);
        frames(desk, 3);
        button(desk.window, true, from_x_px, kY_px);
        frames(desk, 3);
        move_mouse(desk.window, to_x_px, kY_px);
        frames(desk, 3);
        button(desk.window, false, to_x_px, kY_px);
        frames(desk, 3);
    };
    drag(480, 520);  // the right edge by 40 px
    const double wider = desk.app.view.scale.card_px_per_mm;
    CHECK(wider == close_to(before + 2.0 * 40.0 / 85.6).epsilon(1e-3));
    drag(160, 180);  // the left one
    CHECK(desk.app.view.scale.card_px_per_mm == close_to(wider - 2.0 * 20.0 / 85.6).epsilon(1e-3));
    // a finger comes down far from where the pointer was, in one frame: that is no drag
    button(desk.window, true, 500, 300);
    frames(desk, 3);
    CHECK(desk.app.view.scale.card_px_per_mm == close_to(wider - 2.0 * 20.0 / 85.6).epsilon(1e-3));
    button(desk.window, false, 500, 300);
    frames(desk, 3);
    move_mouse(desk.window, 600, 300);  // nothing is held
    frames(desk, 3);
    CHECK(desk.app.view.scale.card_px_per_mm == close_to(wider - 2.0 * 20.0 / 85.6).epsilon(1e-3));
}
