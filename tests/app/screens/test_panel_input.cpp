#include <doctest/doctest.h>

#include "app/screens/panel_input.h"
#include "platform/window_event.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::app;

namespace {

using Kind = PanelInput::Kind;

PanelInput key_input(int key, bool down, bool shift = false) {
    PanelInput input{Kind::key, down};
    input.key = key;
    input.shift = shift;
    return input;
}

PanelInput text_input(const std::string& text, Kind kind = Kind::text) {
    PanelInput input{kind};
    input.text = text;
    return input;
}

// One letter per input: B b Backspace, E e Enter, T t Tab, Q q the letter q, S s Shift, ( ) the button; what is typed
// as it is; [ ] around a new text; | between frames.
std::string name_of(const PanelInput& input) {
    if (input.kind == Kind::button) return input.down ? "(" : ")";
    if (input.kind == Kind::text) return input.text;
    if (input.kind == Kind::replace) return "[" + input.text + "]";
    const char* names = input.key == key::backspace ? "bB"
                        : input.key == key::enter   ? "eE"
                        : input.key == key::tab     ? "tT"
                        : input.key == 'q'          ? "qQ"
                                                    : "sS";
    return {names[input.down ? 1 : 0]};
}

std::string frames_of(const std::vector<PanelInput>& inputs) {
    std::deque<PanelInput> waiting;
    for (const PanelInput& input : inputs) wait_for_frame(input, waiting);
    std::string frames;
    std::vector<PanelInput> frame;
    for (take_frame(waiting, frame); !frame.empty(); take_frame(waiting, frame)) {
        if (!frames.empty()) frames += "|";
        for (const PanelInput& input : frame) frames += name_of(input);
    }
    CHECK(waiting.empty());
    return frames;
}

constexpr int B = key::backspace, E = key::enter, T = key::tab, S = key::other;

}  // namespace

TEST_CASE("panel input: every press of a key gets its frame, and its release another") {
    CHECK(frames_of({key_input(B, true), key_input(B, false), key_input(B, true), key_input(B, false)}) == "B|b|B|b");
    CHECK(frames_of({key_input(B, true), key_input(B, false), key_input(E, true), key_input(E, false)}) == "B|bE|e");
    CHECK(frames_of({key_input(B, true), key_input(E, true), key_input(B, false), key_input(E, false)}) == "B|E|be");
}

TEST_CASE("panel input: letters, Backspace and Enter stay in order") {
    CHECK(frames_of({text_input("1"), text_input("2"), key_input(B, true), key_input(B, false), text_input("3"),
                     key_input(E, true)}) == "12B|b3E");
    CHECK(frames_of({key_input('q', true), text_input("#"), key_input('q', false), key_input('q', true),
                     text_input("#")}) == "Q#|q|Q#");
    CHECK(frames_of({key_input(B, true), text_input("3")}) == "B|3");
}

TEST_CASE("panel input: a modifier does not leave the key that it goes with") {
    CHECK(frames_of({key_input(S, true, true), key_input(T, true, true), key_input(S, false), key_input(T, false)}) ==
          "ST|st");
}

TEST_CASE("panel input: each press and release of a button stands alone") {
    const PanelInput down{Kind::button, true};
    const PanelInput up{Kind::button, false};
    CHECK(frames_of({down, up, down, up}) == "(|)|(|)");
    CHECK(frames_of({text_input("1"), down, up, text_input("2"), key_input(E, true)}) == "1|(|)|2E");
}

TEST_CASE("panel input: the last text of a field takes the place of the ones that wait, and Enter comes after it") {
    const auto replace = [](const char* text) { return text_input(text, Kind::replace); };
    CHECK(frames_of({replace("a"), replace("ab"), key_input(E, true)}) == "[ab]E");
    CHECK(frames_of({replace("a"), key_input(E, true), key_input(E, false), replace("b")}) == "[a]E|e|[b]");
    CHECK(frames_of({replace(""), key_input(E, true)}) == "[]|E");
}
