#pragma once
// Widgets that all screens share: large targets with their key beside the word, and colours that everybody can
// distinguish.

#include <imgui.h>
#include <string>

#include "app/screens/gui.h"
#include "render/tissue.h"

namespace palpa::app {

inline constexpr ImU32 kInk = IM_COL32(236, 239, 241, 255);
inline constexpr ImU32 kPale = IM_COL32(180, 188, 194, 255);
inline constexpr ImU32 kLag = IM_COL32(255, 214, 90, 255);
inline constexpr ImU32 kDark = IM_COL32(20, 22, 24, 255);

// Light, medium, deep: three tints of one hue for the force; for areas, three steps from dark blue to light yellow, each
// with a luminance contrast of 3 : 1 to the next, which everybody sees.
inline constexpr ImU32 kForceTints[3] = {IM_COL32(44, 66, 84, 255), IM_COL32(58, 92, 120, 255),
                                         IM_COL32(76, 122, 160, 255)};
inline constexpr ImU32 kAreaTints[3] = {IM_COL32(44, 64, 96, 255), IM_COL32(144, 141, 116, 255),
                                        IM_COL32(250, 244, 206, 255)};

inline constexpr float kTarget_mm = 9.0f;  // least height of a control that is touched
inline constexpr float kMark_mm = 12.0f;

// Begins a panel that fills exactly this area, without decoration, and claims the area. Content that does not fit can
// be scrolled, and gui.note_overflow() is called.
void begin_panel(const char* name, const PanelArea& area, Gui& gui, float opacity = 1.0f);
void end_panel(const char* name, Gui& gui);

struct ButtonLook {
    float width_px = 0.0f;  // 0: the rest of the line
    float height_mm = kTarget_mm;
    bool enabled = true;
    bool chosen = false;    // filled brightly: the present choice
    const char* hint = "";  // shown after the pointer has rested on the button
};
// Draws a button. Returns true if it is pressed. `key` is shown small beside the label, for people who use the
// keyboard; it may be empty.
bool big_button(const char* label, const char* key, const ButtonLook& look, const Gui& gui);

enum class Icon : std::uint8_t { pause, play, question };
// Draws a square button with an icon instead of a word; `hint` says what it does. Returns true if it is pressed.
bool icon_button(Icon icon, const char* hint, const Gui& gui);

// Explains the control drawn last, once the pointer has rested on it.
void hint_for_last(const char* text);

// Returns the width of one of `count` buttons that share the rest of the line.
float share_of_line_px(int count);

void paragraph(const std::string& text);  // wrapped, pale
// Pale; text that does not fit is cut, so that nothing below it moves.
void one_line(std::string text);
void warning_paragraph(const std::string& text);  // wrapped, with a mark in front
void value_line(const char* name, const std::string& value, float column_px);

std::string clock_text(double seconds);       // such as 1:07
std::string fixed(double value, int digits);  // with this many decimals; "-" if not finite

// Returns where a place on the tissue is drawn.
ImVec2 on_screen(const render::TissueView& view, double x_m, double y_m);

void cross(ImDrawList& draw, ImVec2 at, float radius_px, ImU32 colour, float width_px);
void dashed_circle(ImDrawList& draw, ImVec2 at, float radius_px, ImU32 colour, float width_px);
// Draws text on a dark plate, so that it can be read on any tissue.
void plated_text(ImDrawList& draw, ImVec2 at, ImU32 colour, const std::string& text);

}  // namespace palpa::app
