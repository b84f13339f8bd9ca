#pragma once
// Widgets that all screens share: large targets with their key beside the word, and colours that everybody can
// distinguish.

#include <imgui.h>
#include <string>
#include <vector>

#include "app/screens/gui.h"
#include "render/tissue.h"

namespace palpa::app {

inline constexpr ImU32 kInk = IM_COL32(236, 239, 241, 255);
inline constexpr ImU32 kPale = IM_COL32(180, 188, 194, 255);
inline constexpr ImU32 kLag = IM_COL32(255, 214, 90, 255);
inline constexpr ImU32 kDark = IM_COL32(20, 22, 24, 255);

// Light, medium, deep: three tints of one hue for the force, three steps of cividis (made for red-green colour
// blindness; PLOS ONE 13 (2018) e0199239) for areas, all of them light enough for dark lines.
inline constexpr ImU32 kForceTints[3] = {IM_COL32(44, 66, 84, 255), IM_COL32(58, 92, 120, 255),
                                         IM_COL32(76, 122, 160, 255)};
inline constexpr ImU32 kAreaTints[3] = {IM_COL32(122, 158, 214, 215), IM_COL32(186, 190, 176, 215),
                                        IM_COL32(250, 221, 76, 215)};
inline constexpr ImU32 kHatch = IM_COL32(20, 22, 24, 190);

inline constexpr float kTarget_mm = 9.0f;  // least height of a control that is touched
inline constexpr float kMark_mm = 12.0f;

// Before the end of a child window: a finger that is drawn over what scrolls moves the content, and presses no button on its
// way. A text field keeps it.
void scroll_by_drag(const Gui& gui);

// Begins a panel that fills exactly this area, without decoration, and claims the area. Content that does not fit can
// be scrolled, and gui.note_overflow() is called.
void begin_panel(const char* name, const PanelArea& area, Gui& gui, float opacity = 1.0f);
void end_panel(const char* name, Gui& gui);
// Begins a part of a panel that fills its window without margins (begin_bare_panel). Arrow keys move from the controls of one
// part to those of the others, which they do not between panels.
void begin_bare_panel(const char* name, Gui& gui);
void begin_part(const char* name, const PanelArea& area);
void end_part(const char* name, Gui& gui);
// Ends a child that scrolls down: what is cut off at its right side is noted as an overflow. Page Up, Page Down, Home and
// End scroll a child without controls.
void end_scrolled(const char* name, Gui& gui);
// An area that takes presses of a pointer alone. Returns true if it is pressed.
bool press_area(const char* name, ImVec2 size);

struct ButtonLook {
    float width_px = 0.0f;  // 0: the rest of the line
    float height_mm = kTarget_mm;
    bool enabled = true;
    bool chosen = false;    // filled brightly: the present choice
    const char* hint = "";  // shown after the pointer has rested on the button
    bool stops = false;     // red: stops everything
};
// Draws a button. Returns true if it is pressed. `key` is shown small beside the label, for people who use the
// keyboard; it may be empty.
bool big_button(const char* label, const char* key, const ButtonLook& look, const Gui& gui);

enum class Icon : std::uint8_t { pause, play, question };
// Draws a square button with an icon instead of a word; `hint` says what it does. Returns true if it is pressed.
bool icon_button(Icon icon, const char* hint, const Gui& gui);

// Explains the control drawn last, once the pointer has rested on it.
void hint_for_last(const char* text);

// Draws a field for a number, whose decimal sign may be a point or a comma; NaN is an empty field. `format`: as printf's.
void number_field(const char* name, double& value, const char* format);

// Returns the width of one of `count` buttons that share the rest of the line.
float share_of_line_px(int count);

// Whether Enter has just taken the focus from the field before.
bool is_deactivated_by_enter();

std::string broken_at_spaces(const std::string& text, float width_px);
void wrapped_text(const std::string& text);  // lines break at spaces, never within a number
void paragraph(const std::string& text);     // the same, pale
// Pale; text that does not fit is cut, so that nothing below it moves.
void one_line(std::string text);
void warning_paragraph(const std::string& text);                               // wrapped, with a mark in front
void value_line(const char* name, const std::string& value, float column_px);  // the value is wrapped

std::string clock_text(double seconds);       // such as 1:07
std::string fixed(double value, int digits);  // with this many decimals; "-" if not finite

// Makes the next fields and sliders as high as a control that is touched; to be ended by ImGui::PopStyleVar().
void push_touchable_frame(float side_mm, const Gui& gui);

// Returns where a place on the tissue is drawn: on the undisturbed surface, or on the surface as it is displaced now.
ImVec2 on_screen(const render::TissueView& view, double x_m, double y_m);
ImVec2 on_surface(const render::TissuePicture& picture, double x_m, double y_m);

// What is drawn on the tissue has a light core in a dark rim, since no single colour stands out from every tissue, its
// lit slopes and its shadows. Widths are of the core; the rim is `rim_px` wide on both sides.
struct RimmedLine {
    float core_px = 1.0f;
    float rim_px = 1.0f;
    bool dashed = false;
};

void cross(ImDrawList& draw, ImVec2 at, float radius_px, ImU32 colour, float width_px);
void dashed_circle(ImDrawList& draw, ImVec2 at, float radius_px, ImU32 colour, float width_px);
// Draws text on a dark plate, so that it can be read on any tissue; in lines of wrap_px at most if that is > 0.
// Returns the text's area.
PanelArea plated_text(ImDrawList& draw, ImVec2 at, ImU32 colour, const std::string& text, float wrap_px = -1.0f);
struct Label {
    ImVec2 at;  // of its mark
    std::string text;
};
// Returns where each label goes beside its mark: the first of eight places where it covers no mark, no other label and
// nothing that is `taken`, and stays in the window right of left_px; if there is none, the first that stays there.
std::vector<PanelArea> label_areas(const std::vector<Label>& labels, std::vector<PanelArea> taken, float left_px,
                                   float mm);
void place_labels(const std::vector<Label>& labels, const std::vector<PanelArea>& taken, float left_px, float mm,
                  ImDrawList& draw);
// Says that the window has no room for controls.
void draw_too_small();

}  // namespace palpa::app
