#include "app/screens/panel_input.h"

#include <algorithm>
#include <utility>

#include "platform/window_event.h"

namespace palpa::app {
namespace {

using Kind = PanelInput::Kind;

bool types_letter(int key) {
    return (key >= platform::key::space && key < platform::key::del) || key >= platform::key::pad_plus;
}

bool is_press(const PanelInput& input) {
    return input.kind == Kind::key && input.down && input.key != platform::key::other;
}

// True for input after which no letters may follow in the same frame: a key that types nothing, or the emptying of a
// field, which Dear ImGui does by a Backspace on a selection.
bool ends_letters(const PanelInput& input) {
    return (is_press(input) && !types_letter(input.key)) || (input.kind == Kind::replace && input.text.empty());
}

bool same_key(const PanelInput& a, const PanelInput& b) {
    return a.kind == Kind::key && b.kind == Kind::key && a.key == b.key;
}

bool fits(const PanelInput& next, const std::vector<PanelInput>& frame) {
    if (frame.empty()) return true;
    const PanelInput& last = frame.back();
    if (next.kind == Kind::button || last.kind == Kind::button || next.kind == Kind::replace || ends_letters(last))
        return false;
    const bool pressed = std::any_of(frame.begin(), frame.end(), is_press);
    if (pressed) return next.kind == Kind::text;
    if (!is_press(next)) return true;
    return std::none_of(frame.begin(), frame.end(), [&](const PanelInput& taken) { return same_key(taken, next); });
}

}  // namespace

void wait_for_frame(PanelInput input, std::deque<PanelInput>& waiting) {
    if (input.kind == Kind::replace && !waiting.empty() && waiting.back().kind == Kind::replace) waiting.pop_back();
    waiting.push_back(std::move(input));
}

void take_frame(std::deque<PanelInput>& waiting, std::vector<PanelInput>& out) {
    out.clear();
    while (!waiting.empty() && fits(waiting.front(), out)) {
        out.push_back(std::move(waiting.front()));
        waiting.pop_front();
    }
}

}  // namespace palpa::app
