// Who types a code never types into nothing. Off screen.

#include <algorithm>
#include <doctest/doctest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "files/text.h"
#include "tests/app/live/desk.h"
#include "tests/app/screens/typing.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::study;
using namespace palpa::app;
using namespace palpa::test;

namespace {

void open_code_page(const TemporaryFolder& folder, Desk& desk) {
    desk.keeper.busy = false;
    desk.app.doing =
        open_study_run(read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json"), folder / "log", "");
}

void open_questions(const TemporaryFolder& folder, Desk& desk) {
    desk.keeper.busy = false;
    desk.app.doing =
        open_study_run(read_protocol(PALPA_SOURCE_DIR "/assets/protocols/paper.json"), folder / "log", "p1");
    live_frames(desk, 3);
    REQUIRE(std::holds_alternative<step::Questions>(study_of(desk.app.doing)->step));
}

}  // namespace

TEST_CASE("study screen: the code's field has the letters again after Escape") {
    const TemporaryFolder folder;
    Desk desk("");
    open_code_page(folder, desk);
    frames(desk, 5);
    CHECK(desk.app.view.study.code == "01");  // offered
    tap(desk.window, SDLK_ESCAPE);
    frames(desk, 5);
    tap(desk.window, SDLK_END);
    type(desk.window, 'x');
    frames(desk, 5);
    CHECK(desk.app.view.study.code.find('x') != std::string::npos);
}

TEST_CASE("study screen: a second Enter after the screen before does not take the code that is only offered") {
    const TemporaryFolder folder;
    Desk desk("");
    open_code_page(folder, desk);
    live_frames(desk, 3);
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 5);
    CHECK(std::holds_alternative<step::Code>(study_of(desk.app.doing)->step));
    CHECK(study_of(desk.app.doing)->code.empty());
    tap(desk.window, SDLK_END);
    type(desk.window, 'x');
    live_frames(desk, 3);
    CHECK(desk.app.view.study.code == "01x");
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 5);
    CHECK(study_of(desk.app.doing)->code == "01x");
}

TEST_CASE("study screen: the first question takes the keys at once, and Enter ends its field before it ends the page") {
    const TemporaryFolder folder;
    Desk desk("");
    open_questions(folder, desk);
    for (const char digit : {'3', '4'}) type(desk.window, digit);
    live_frames(desk, 6);
    CHECK(desk.app.view.study.answers.at(0) == "34");
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 5);
    CHECK(std::holds_alternative<step::Questions>(study_of(desk.app.doing)->step));
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 5);
    CHECK_FALSE(std::holds_alternative<step::Questions>(study_of(desk.app.doing)->step));
}

TEST_CASE("study screen: an answer in words may be long") {
    const TemporaryFolder folder;
    files::write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 4, "order": "fixed",
        "conditions": [{"id": "pad", "modality": "touchpad", "scene": ")" PALPA_SOURCE_DIR
                                                    R"(/assets/scenes/default.json"}],
        "repeats": 1, "demographics": [{"id": "why", "text": "Why do you palpate?"}]})");
    Desk desk("");
    desk.keeper.busy = false;
    desk.app.doing = open_study_run(read_protocol(folder / "p.json"), folder / "log", "p1");
    live_frames(desk, 3);
    REQUIRE(std::holds_alternative<step::Questions>(study_of(desk.app.doing)->step));
    desk.app.view.study.answers = {""};
    std::string said;
    for (int k = 0; k < 300; ++k) {
        said.push_back(static_cast<char>('a' + k % 26));
        type(desk.window, said.back());
        live_frames(desk, 1);
    }
    live_frames(desk, 6);
    CHECK(desk.app.view.study.answers.at(0) == said);
}

TEST_CASE("study screen: an age that is refused keeps the keys, so that it can be mended at once") {
    const TemporaryFolder folder;
    Desk desk("");
    open_questions(folder, desk);
    for (const char digit : {'3', '4', '0'}) type(desk.window, digit);
    live_frames(desk, 6);
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 5);
    CHECK(desk.app.view.study.answers.at(0) == "340");
    tap(desk.window, SDLK_END);
    tap(desk.window, SDLK_BACKSPACE);
    live_frames(desk, 6);
    CHECK(desk.app.view.study.answers.at(0) == "34");
}

TEST_CASE("study screen: an age that is refused moves no answer below it from under a finger") {
    const TemporaryFolder folder;
    Desk desk("");
    open_questions(folder, desk);
    const auto height_px = [&](const char* age) {
        desk.app.view.study.answers.at(0) = age;
        live_frames(desk, 3);
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            if (std::string(window->Name).find("/items") != std::string::npos) return window->ContentSize.y;
        }
        return 0.0f;
    };
    const float taken_px = height_px("34");
    CHECK(taken_px > 0.0f);
    CHECK(height_px("340") == taken_px);
}

TEST_CASE("study screen: a second Enter after the code does not leave the questions open for good") {
    const TemporaryFolder folder;
    Desk desk("");
    open_questions(folder, desk);
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 5);
    CHECK(std::holds_alternative<step::Questions>(study_of(desk.app.doing)->step));
    desk.app.view.study.answers.at(0) = "30";
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 5);
    CHECK_FALSE(std::holds_alternative<step::Questions>(study_of(desk.app.doing)->step));
}

TEST_CASE("study screen: Enter chooses the answer that the ring is on, and does not leave the page") {
    const TemporaryFolder folder;
    Desk desk("");
    open_questions(folder, desk);
    for (const char digit : {'4', '4'}) type(desk.window, digit);
    live_frames(desk, 4);
    tap(desk.window, SDLK_TAB);
    live_frames(desk, 6);
    tap(desk.window, SDLK_DOWN);
    live_frames(desk, 6);
    REQUIRE(desk.gui.shows_focus());
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 6);
    CHECK(std::holds_alternative<step::Questions>(study_of(desk.app.doing)->step));
    const std::vector<std::string>& answers = desk.app.view.study.answers;
    CHECK(answers.at(0) == "44");
    const auto chosen = [](const std::string& answer) { return !answer.empty(); };
    CHECK(std::any_of(answers.begin() + 1, answers.end(), chosen));
    tap(desk.window, SDLK_RETURN);  // twice, as people press it
    live_frames(desk, 6);
    CHECK(std::any_of(answers.begin() + 1, answers.end(), chosen));
    tap(desk.window, SDLK_SPACE);
    live_frames(desk, 6);
    CHECK(std::none_of(answers.begin() + 1, answers.end(), chosen));
}

TEST_CASE("study screen: Ctrl+Q closes the study from the code's field too, and types no letter") {
    const TemporaryFolder folder;
    Desk desk("");
    open_code_page(folder, desk);
    live_frames(desk, 5);
    REQUIRE_FALSE(desk.app.quit);
    tap(desk.window, SDLK_q, KMOD_LCTRL);
    live_frames(desk, 3);
    CHECK(desk.app.quit);
    CHECK(desk.app.view.study.code == "01");
}

TEST_CASE(
    "study screen: after somebody has refused to take part, a code that is typed replaces the one that is offered") {
    const TemporaryFolder folder;
    Desk desk("");
    desk.keeper.busy = false;
    Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json");
    protocol.consent = "You press on surfaces.";
    desk.app.doing = open_study_run(protocol, folder / "log", "");
    live_frames(desk, 5);
    const auto type_code = [&](const char* code) {
        for (const char* letter = code; *letter != '\0'; ++letter) type(desk.window, *letter);
        live_frames(desk, 5);
    };
    type_code("07");
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 5);
    REQUIRE(std::holds_alternative<step::Consent>(study_of(desk.app.doing)->step));
    type(desk.window, '2');  // no
    live_frames(desk, 5);
    REQUIRE(std::holds_alternative<step::Code>(study_of(desk.app.doing)->step));
    type_code("11");
    CHECK(desk.app.view.study.code == "11");
}

TEST_CASE("study screen: answers that are not logged yet are not closed over without a question") {
    const TemporaryFolder folder;
    Desk desk("");
    open_questions(folder, desk);
    Wishes close;
    close.quit = true;
    desk.app.view.study.answers.at(0) = "30";
    carry_out(close, desk.window, desk.gui, desk.app);
    CHECK_FALSE(desk.app.quit);
    REQUIRE(desk.app.asked);
    live_frames(desk, 3);
    CHECK(desk.app.view.study.answers.at(0) == "30");
    close.sure = true;
    carry_out(close, desk.window, desk.gui, desk.app);
    CHECK(desk.app.quit);
}

TEST_CASE("study screen: digits answer the scales one after the other, and Enter goes on") {
    const TemporaryFolder folder;
    Desk desk("");
    desk.keeper.busy = false;
    files::Json json = files::read_json(PALPA_SOURCE_DIR "/assets/protocols/softer.json");
    json["demographics"] = {{{"id", "tired"}, {"text", "Tired?"}, {"from", 1}, {"to", 7}},
                            {{"id", "skill"}, {"text", "Skilled?"}, {"from", 0}, {"to", 10}},
                            {{"id", "calm"}, {"text", "Calm?"}, {"from", 0}, {"to", 9}}};
    files::write_text_atomically(folder / "p.json", json.dump());
    desk.app.doing = open_study_run(read_protocol(folder / "p.json"), folder / "log", "p1");
    live_frames(desk, 3);
    StudyRun& run = *study_of(desk.app.doing);
    run.step_began_s = desk.window.now_s();
    tap(desk.window, SDLK_2);  // at once: the second press of a key that answered the step before
    live_frames(desk, 4);
    CHECK(desk.app.view.study.answers == std::vector<std::string>{"", "", ""});
    run.step_began_s = desk.window.now_s() - 5.0;
    tap(desk.window, SDLK_RETURN);  // of somebody quick, for whom the digit was an answer
    live_frames(desk, 4);
    CHECK(std::holds_alternative<step::Questions>(run.step));
    CHECK(desk.app.view.study.told_too_early);
    for (const int key : {SDLK_8, SDLK_5, SDLK_0, SDLK_3}) {
        tap(desk.window, key);
        live_frames(desk, 4);
    }
    CHECK(desk.app.view.study.answers == std::vector<std::string>{"5", "", "0"});
    CHECK_FALSE(desk.app.view.study.told_too_early);
    // nobody has to answer: after a digit that came too early, a second Enter goes on
    desk.app.view.study.answers = {"", "", ""};
    run.step_began_s = desk.window.now_s();
    tap(desk.window, SDLK_2);
    live_frames(desk, 4);
    run.step_began_s = desk.window.now_s() - 5.0;
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 4);
    CHECK(std::holds_alternative<step::Questions>(run.step));
    tap(desk.window, SDLK_RETURN);
    live_frames(desk, 4);
    CHECK_FALSE(std::holds_alternative<step::Questions>(run.step));
}

TEST_CASE("study screen: a finger drawn over a long page scrolls it and presses no answer; a tap still does") {
    const TemporaryFolder folder;
    Desk desk("");
    desk.keeper.busy = false;
    Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json");
    protocol.demographics.clear();
    for (int i = 0; i < 30; ++i) {
        Item item;
        item.id = "q" + std::to_string(i);
        item.text = "Question " + std::to_string(i);
        item.choices = {"yes", "no"};
        protocol.demographics.push_back(item);
    }
    desk.app.doing = open_study_run(protocol, folder / "log", "p1");
    live_frames(desk, 6);
    REQUIRE(std::holds_alternative<step::Questions>(study_of(desk.app.doing)->step));
    const auto items = [] {
        for (ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            if (std::string(window->Name).find("/items") != std::string::npos) return window;
        }
        return static_cast<ImGuiWindow*>(nullptr);
    };
    REQUIRE(items() != nullptr);
    const ImRect area = items()->InnerRect;
    const int x_px = static_cast<int>(area.Min.x) + 40, low_px = static_cast<int>(area.Max.y) - 20;
    const auto answered = [&] {
        const std::vector<std::string>& answers = desk.app.view.study.answers;
        return std::any_of(answers.begin(), answers.end(), [](const std::string& one) { return !one.empty(); });
    };
    for (int from_px = low_px; from_px > low_px - 100; from_px -= 12) {  // from buttons and from between them
        CAPTURE(from_px);
        const float before_px = items()->Scroll.y;
        button(desk.window, true, x_px, from_px);
        live_frames(desk, 2);
        for (int i = 1; i <= 10; ++i) {
            move_mouse(desk.window, x_px, from_px - 12 * i);
            live_frames(desk, 1);
        }
        button(desk.window, false, x_px, from_px - 120);
        live_frames(desk, 3);
        CHECK(items()->Scroll.y > before_px + 60.0f);
        CHECK(items()->Scroll.y < before_px + 121.0f);
        CHECK_FALSE(answered());
    }
    for (int y_px = static_cast<int>(area.Min.y) + 10; y_px < low_px && !answered(); y_px += 12) {
        click(desk.window, x_px, y_px);
        live_frames(desk, 4);
    }
    CHECK(answered());
}
