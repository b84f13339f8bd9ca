// Keys, letters and clicks that come quicker than frames reach the controls, each in its turn. Off screen.

#include <SDL.h>
#include <cstring>
#include <doctest/doctest.h>
#include <imgui.h>
#include <numbers>

#include "app/screens/font.h"
#include "app/screens/gui.h"
#include "app/screens/nodule_outline.h"
#include "app/screens/widgets.h"
#include "study/score.h"
#include "tests/app/screens/typing.h"
#include "tests/close_to.h"
#include "tests/off_screen.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::app;
using namespace palpa::test;

namespace {

// A field for letters and a button, as screens have them.
struct Form {
    Window window{off_screen()};
    Gui gui{window};
    char text[64] = "";
    int entered = 0;
    int clicks = 0;
    std::string shortcuts;
    ImVec2 button{};
    bool focus = true;
    bool enabled = true;  // the button

    void frame() {
        std::vector<Sample> samples;
        window.poll(0.0, samples);
        gui.begin_frame(1.0 / 60.0, true);
        for (const int letter : {'c', 'd'}) {
            if (gui.pressed(letter)) shortcuts += static_cast<char>(letter);
        }
        ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
        ImGui::SetNextWindowSize(ImVec2(640.0f, 400.0f));
        ImGui::Begin("form");
        gui.claim({0.0f, 0.0f, 640.0f, 400.0f});
        if (focus) ImGui::SetKeyboardFocusHere();
        focus = false;
        entered += ImGui::InputText("code", text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue);
        clicks += big_button("press", "", {100.0f, 50.0f / gui.mm(), enabled}, gui);
        const ImVec2 at = ImGui::GetItemRectMin();
        button = ImVec2(at.x + 20.0f, at.y + 20.0f);
        ImGui::End();
        gui.end_frame();
    }
    void frames(int count) {
        for (int i = 0; i < count; ++i) frame();
    }

    void send_key(Uint32 type, SDL_Keycode code) const { test::send_key(window, type, code); }
    void tap(SDL_Keycode code) const { test::tap(window, code); }
    void type(char letter) const { test::type(window, letter); }
    void click() const { test::click(window, static_cast<int>(button.x), static_cast<int>(button.y)); }
};

}  // namespace

TEST_CASE("gui: Backspaces between two frames each take a letter") {
    Form form;
    std::strcpy(form.text, "abcdefgh");
    form.frames(4);
    form.tap(SDLK_END);
    for (int i = 0; i < 5; ++i) form.tap(SDLK_BACKSPACE);
    form.frames(20);
    CHECK(std::string(form.text) == "abc");
}

TEST_CASE("gui: letters, Backspace and Enter between two frames are taken in their order") {
    Form form;
    form.frames(4);
    for (const char letter : {'1', '2', '3'}) form.type(letter);
    form.tap(SDLK_BACKSPACE);
    form.type('4');
    form.tap(SDLK_BACKSPACE);
    form.tap(SDLK_BACKSPACE);
    form.type('5');
    form.tap(SDLK_RETURN);
    form.frames(40);
    CHECK(std::string(form.text) == "15");
    CHECK(form.entered == 1);
}

TEST_CASE("gui: Enter works again after it has ended the typing") {
    Form form;
    form.frames(4);
    form.send_key(SDL_KEYDOWN, SDLK_RETURN);
    form.frames(4);
    form.send_key(SDL_KEYUP, SDLK_RETURN);  // no field takes letters any more
    form.frames(2);
    CHECK(form.entered == 1);
    form.focus = true;
    form.frames(4);
    form.tap(SDLK_RETURN);
    form.frames(4);
    CHECK(form.entered == 2);
}

TEST_CASE("gui: a button that is disabled while the keyboard is on it takes no Enter and no Space") {
    Form form;
    form.frames(4);
    form.tap(SDLK_ESCAPE);  // leaves the field
    form.frames(4);
    form.tap(SDLK_DOWN);
    form.frames(4);
    form.tap(SDLK_SPACE);
    form.frames(4);
    REQUIRE(form.clicks == 1);
    form.enabled = false;
    for (const SDL_Keycode key : {SDLK_RETURN, SDLK_SPACE}) {
        form.tap(key);
        form.frames(4);
    }
    form.click();
    form.frames(4);
    CHECK(form.clicks == 1);
    form.enabled = true;
    form.frames(2);
    form.click();
    form.frames(4);
    CHECK(form.clicks == 2);
}

TEST_CASE("gui: quick clicks are all counted, and shortcuts come one by one") {
    Form form;
    form.frames(4);
    form.tap(SDLK_RETURN);  // leave the field
    form.frames(4);
    for (int i = 0; i < 3; ++i) form.click();
    form.tap('c');
    form.tap('d');
    form.tap('c');
    form.frames(20);
    CHECK(form.clicks == 3);
    CHECK(form.shortcuts == "cdc");
    CHECK_FALSE(form.gui.in_use());
}

TEST_CASE("gui: a text from elsewhere replaces the field's, and Enter comes after it") {
    Form form;
    std::strcpy(form.text, "old");
    form.frames(4);
    form.gui.type_instead("n");
    form.gui.type_instead("new");
    form.tap(SDLK_RETURN);
    form.frames(6);
    CHECK(std::string(form.text) == "new");
    CHECK(form.entered == 1);
    form.focus = true;
    form.frames(4);
    form.gui.type_instead("");
    form.tap(SDLK_RETURN);
    form.frames(6);
    CHECK(std::string(form.text).empty());
    CHECK(form.entered == 2);
}

TEST_CASE("gui: what is typed after Ctrl and a key is not lost, also where nobody tells that Ctrl was let go") {
    for (const bool elsewhere : {true, false}) {
        Form form;
        std::strcpy(form.text, "P7");
        form.frames(4);
        test::tap(form.window, SDLK_a, KMOD_CTRL);
        form.frames(4);
        if (elsewhere) form.gui.type_instead("8");
        if (!elsewhere) form.type('8');
        form.frames(4);
        CHECK(std::string(form.text) == "8");
    }
}

TEST_CASE("gui: letters of a study's texts are drawn where the font has them") {
    if (system_font_file().empty()) return;
    Form form;
    CHECK(ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(0x416) == nullptr);
    form.gui.add_letters("\u0416 \u2014");
    form.frames(2);
    CHECK(ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(0x416) != nullptr);
    CHECK(ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(0x2014) != nullptr);
    CHECK(ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback('A') != nullptr);
}

TEST_CASE("gui: a mark's label covers no name of a nodule, no mark and no other label") {
    Form form;
    form.frames(2);
    const float mm = form.gui.mm();
    const std::vector<PanelArea> names{{210.0f, 90.0f, 290.0f, 112.0f}, {150.0f, 60.0f, 190.0f, 85.0f}};
    const std::vector<Label> labels{{ImVec2(200.0f, 100.0f), "1 false positive, confidence 4"},
                                    {ImVec2(205.0f, 104.0f), "2 false positive"}};
    const std::vector<PanelArea> areas = label_areas(labels, names, 0.0f, mm);
    REQUIRE(areas.size() == 2);
    const auto apart = [](const PanelArea& a, const PanelArea& b) {
        return a.x1 <= b.x0 || b.x1 <= a.x0 || a.y1 <= b.y0 || b.y1 <= a.y0;
    };
    CHECK(apart(areas[0], areas[1]));
    for (const PanelArea& area : areas) {
        for (const PanelArea& name : names) CHECK(apart(area, name));
        for (const Label& mark : labels) CHECK_FALSE(area.holds(mark.at.x, mark.at.y));
    }
    // many marks on one place beside a panel: labels may cover each other, but the panel covers none
    const std::vector<Label> crowd(12, {ImVec2(200.0f, 100.0f), "2 duplicate"});
    for (const PanelArea& area : label_areas(crowd, {}, 190.0f, mm)) CHECK(area.x0 >= 190.0f);
}

TEST_CASE("gui: F12 stops at once, also while a field takes letters and before any frame is drawn") {
    Form form;
    form.frames(4);  // the field has the focus
    CHECK_FALSE(form.gui.take_stop());
    form.type('a');
    form.tap(SDLK_F12);
    std::vector<Sample> samples;
    form.window.poll(0.0, samples);  // no frame
    CHECK(form.gui.take_stop());
    CHECK_FALSE(form.gui.take_stop());  // once for each press
    form.send_key(SDL_KEYDOWN, SDLK_F12);
    form.frames(1);
    CHECK(form.gui.take_stop());
    form.send_key(SDL_KEYUP, SDLK_F12);
    form.frames(2);
    CHECK_FALSE(form.gui.take_stop());
    CHECK(std::string(form.text) == "a");
}

TEST_CASE("gui: the outline of a long nodule is a rod with round ends along its angle, and of a round one a circle") {
    const study::Target rod{"D1", 20.0, 30.0, 13.4, 63.2, std::numbers::pi * 4.8 / 180.0};
    const Outline outline = outline_of({20.0, 30.0}, 13.4, 63.2, 4.8);
    double furthest = 0.0, around = 0.0;
    for (std::size_t i = 0; i < kOutlinePoints; ++i) {
        CHECK(study::distance_m(rod, {outline[i].x(), outline[i].y()}) == close_to(6.7).epsilon(1e-9));
        furthest = std::max(furthest, (outline[i] - Eigen::Vector2d(20.0, 30.0)).norm());
        around += (outline[(i + 1) % kOutlinePoints] - outline[i]).norm();
    }
    CHECK(furthest == close_to(31.6).epsilon(1e-3));
    CHECK(around == close_to(std::numbers::pi * 13.4 + 2.0 * (63.2 - 13.4)).epsilon(1e-3));
    for (const Eigen::Vector2d& p : outline_of({1.0, 2.0}, 8.0, 3.0, 45.0))  // no longer than its diameter
        CHECK((p - Eigen::Vector2d(1.0, 2.0)).norm() == close_to(4.0).epsilon(1e-9));
}
