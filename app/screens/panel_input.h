#pragma once
// Input of the panels, in the order of its arrival. Dear ImGui 1.86 looks only once per frame at which keys and buttons
// are down, so input that is quicker than a frame waits here for a frame of its own.

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace palpa::app {

struct PanelInput {
    enum class Kind : std::uint8_t { button, key, text, replace };
    Kind kind = Kind::button;
    bool down = false;  // of a button or key
    float x_px = 0.0f;  // of a button
    float y_px = 0.0f;
    int key = 0;        // platform/window_event.h
    bool ctrl = false;  // with the key
    bool shift = false;
    bool for_panels = false;  // the key may work a control; else it is only a shortcut
    std::string text{};       // UTF-8; replace: the new text of the field
};

// Appends `input`. A field's new text replaces one that still waits, if nothing came between them.
void wait_for_frame(PanelInput input, std::deque<PanelInput>& waiting);

// Takes from the front what one frame can distinguish: a button's press or release by itself; or keys that come up and
// letters, and at their end one key that goes down, with the letter that it types. A key that comes up in this frame
// goes down in the next one at the earliest.
void take_frame(std::deque<PanelInput>& waiting, std::vector<PanelInput>& out);

}  // namespace palpa::app
