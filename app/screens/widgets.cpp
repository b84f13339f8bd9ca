#include "app/screens/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <imgui_internal.h>
#include <numbers>
#include <optional>

#include "app/screens/words.h"

namespace palpa::app {

void begin_panel(const char* name, const PanelArea& area, Gui& gui, float opacity) {
    gui.claim(area);
    ImGui::SetNextWindowPos(ImVec2(area.x0, area.y0));
    ImGui::SetNextWindowSize(ImVec2(area.width(), area.height()));
    ImGui::SetNextWindowBgAlpha(opacity);
    constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                        ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoSavedSettings;
    ImGui::Begin(name, nullptr, kFixed);
}

void end_panel(const char* name, Gui& gui) {
    if (ImGui::GetScrollMaxY() > 1.0f || ImGui::GetScrollMaxX() > 1.0f) gui.note_overflow(name);
    ImGui::End();
}

void begin_bare_panel(const char* name, Gui& gui) {
    const WindowSize window = gui.size_px();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
    begin_panel(name, {0.0f, 0.0f, window.width, window.height}, gui);
    ImGui::PopStyleVar();
}

void begin_part(const char* name, const PanelArea& area) {
    ImGui::SetCursorScreenPos(ImVec2(area.x0, area.y0));
    ImGui::BeginChild(name, ImVec2(area.width(), area.height()), false,
                      ImGuiWindowFlags_NavFlattened | ImGuiWindowFlags_AlwaysUseWindowPadding);
}

void end_part(const char* name, Gui& gui) {
    if (ImGui::GetScrollMaxY() > 1.0f || ImGui::GetScrollMaxX() > 1.0f) gui.note_overflow(name);
    ImGui::EndChild();
}

bool press_area(const char* name, ImVec2 size) {
    ImGui::PushItemFlag(ImGuiItemFlags_NoNav, true);
    const bool pressed = ImGui::InvisibleButton(name, size);
    ImGui::PopItemFlag();
    return pressed;
}

void scroll_by_drag(const Gui& gui) {
    constexpr float kDrag_mm = 5.0f;  // a tap rolls less
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    const ImGuiWindow& window = *ImGui::GetCurrentWindow();
    const bool in_field = g.ActiveId != 0 && g.ActiveId == g.InputTextState.ID;
    if (window.ScrollMax.y <= 0.0f || !ImGui::IsMouseDown(0) || in_field) return;
    if (!window.InnerRect.Contains(g.IO.MouseClickedPos[0])) return;
    if (g.IO.MouseDragMaxDistanceAbs[0].y < kDrag_mm * gui.mm()) return;
    ImGui::ClearActiveID();
    ImGui::SetScrollY(std::clamp(ImGui::GetScrollY() - g.IO.MouseDelta.y, 0.0f, ImGui::GetScrollMaxY()));
}

void end_scrolled(const char* name, Gui& gui) {
    if (ImGui::IsWindowAppearing()) ImGui::SetScrollY(0.0f);  // the next reader begins at the top
    scroll_by_drag(gui);
    const bool controls = ImGui::GetCurrentWindow()->DC.NavLayersActiveMaskNext != 0;
    if (!controls && ImGui::GetScrollMaxY() > 0.0f) {
        const float page_px = ImGui::GetWindowHeight() - ImGui::GetTextLineHeightWithSpacing();
        const float pages =
            (gui.pressed(platform::key::page_down) ? 1.0f : 0.0f) - (gui.pressed(platform::key::page_up) ? 1.0f : 0.0f);
        const float ends = gui.pressed(platform::key::home) ? 0.0f : ImGui::GetScrollMaxY();
        if (pages != 0.0f)
            ImGui::SetScrollY(std::clamp(ImGui::GetScrollY() + pages * page_px, 0.0f, ImGui::GetScrollMaxY()));
        if (gui.pressed(platform::key::home) || gui.pressed(platform::key::end)) ImGui::SetScrollY(ends);
    }
    if (ImGui::GetScrollMaxX() > 1.0f) gui.note_overflow(name);
    ImGui::EndChild();
}

bool is_deactivated_by_enter() {
    return ImGui::IsItemDeactivated() && (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter)) ||
                                          ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_KeyPadEnter)));
}

float share_of_line_px(int count) {
    const float gap_px = ImGui::GetStyle().ItemSpacing.x;
    return std::floor((ImGui::GetContentRegionAvail().x - gap_px * static_cast<float>(count - 1)) /
                      static_cast<float>(count));
}

namespace {

// Returns how many colours it pushed.
int push_colours(const ButtonLook& look) {
    if (look.stops) {  // white on this red: a contrast of 5.7 at least
        ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.72f, 0.11f, 0.11f, 1.0f));
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, ImVec4(0.78f, 0.13f, 0.13f, 1.0f));
        ImGui::PushStyleColor(ImGuiCol_ButtonActive, ImVec4(0.60f, 0.08f, 0.08f, 1.0f));
        ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 1.0f, 1.0f, 1.0f));
        return 4;
    }
    if (!look.chosen) return 0;
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.78f, 0.88f, 0.95f, 1.0f));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, ImVec4(0.85f, 0.92f, 0.97f, 1.0f));
    ImGui::PushStyleColor(ImGuiCol_ButtonActive, ImVec4(0.90f, 0.95f, 1.0f, 1.0f));
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.07f, 0.08f, 0.09f, 1.0f));
    return 4;
}

bool overlap(const PanelArea& a, const PanelArea& b) {
    return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

}  // namespace

bool big_button(const char* label, const char* key, const ButtonLook& look, const Gui& gui) {
    const ImVec2 size(look.width_px > 0.0f ? look.width_px : ImGui::GetContentRegionAvail().x,
                      look.height_mm * gui.mm());
    ImGui::BeginDisabled(!look.enabled);
    const int colours = push_colours(look);
    const bool pressed = ImGui::Button(label, size);
    if (gui.shows_focus() && ImGui::IsItemFocused()) gui.note_button_focus();
    ImGui::PopStyleColor(colours);
    ImGui::EndDisabled();
    hint_for_last(look.hint);
    const ImVec2 low = ImGui::GetItemRectMin();
    const ImVec2 high = ImGui::GetItemRectMax();
    const float small_px = 0.62f * ImGui::GetFontSize();
    const ImVec2 label_size = ImGui::CalcTextSize(label, nullptr, true);
    if (label_size.x > size.x && look.hint[0] == '\0') gui.note_overflow(std::string("button ") + label);
    const float key_px = ImGui::CalcTextSize(key).x * 0.62f;
    if (*key != '\0' && label_size.x + 2.0f * key_px + 3.0f * gui.mm() < size.x) {
        const ImU32 colour = look.chosen ? IM_COL32(60, 66, 70, 255) : look.stops ? IM_COL32_WHITE : kPale;
        ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), small_px,
                                            ImVec2(high.x - key_px - 1.2f * gui.mm(), low.y + 0.8f * gui.mm()), colour,
                                            key);
    }
    return pressed && look.enabled;  // one that had the keyboard as it was disabled would still take Enter
}

bool icon_button(Icon icon, const char* hint, const Gui& gui) {
    const float side_px = kTarget_mm * gui.mm();
    ImGui::PushID(static_cast<int>(icon));
    const bool pressed = ImGui::Button("##icon", ImVec2(side_px, side_px));
    ImGui::PopID();
    hint_for_last(hint);
    const ImVec2 low = ImGui::GetItemRectMin();
    const ImVec2 middle(low.x + 0.5f * side_px, low.y + 0.5f * side_px);
    const float r = 0.2f * side_px;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (icon == Icon::pause) {
        for (const float x : {-0.9f * r, 0.3f * r})
            draw.AddRectFilled(ImVec2(middle.x + x, middle.y - r), ImVec2(middle.x + x + 0.6f * r, middle.y + r), kInk);
    } else if (icon == Icon::play) {
        draw.AddTriangleFilled(ImVec2(middle.x - 0.7f * r, middle.y - r), ImVec2(middle.x + r, middle.y),
                               ImVec2(middle.x - 0.7f * r, middle.y + r), kInk);
    } else {
        const ImVec2 size = ImGui::CalcTextSize("?");
        draw.AddText(ImVec2(middle.x - 0.5f * size.x, middle.y - 0.5f * size.y), kInk, "?");
    }
    return pressed;
}

void hint_for_last(const char* text) {
    constexpr float kHover_s = 0.6f;
    if (*text == '\0' || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    if (ImGui::GetCurrentContext()->HoveredIdTimer < kHover_s) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(22.0f * ImGui::GetFontSize());
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

// Dear ImGui breaks lines behind points and commas too, and so within a number. It has up to a pixel less than the width,
// since it works with whole ones: what it broke again would need a line that no panel has reckoned with.
std::string broken_at_spaces(const std::string& text, float width_px) {
    width_px -= 1.0f;
    const ImFont& font = *ImGui::GetFont();
    const auto width_of = [&](const char* from, const char* to) {
        return font.CalcTextSizeA(ImGui::GetFontSize(), FLT_MAX, 0.0f, from, to).x;
    };
    std::string out = text;
    std::size_t line = 0, space = std::string::npos;
    for (std::size_t i = 0; i <= text.size(); ++i) {
        const bool ends = i == text.size() || text[i] == '\n';
        if (!ends && text[i] != ' ') continue;
        if (space != std::string::npos && width_of(&text[line], text.data() + i) > width_px) {
            out[space] = '\n';
            line = space + 1;
        }
        space = ends ? std::string::npos : i;
        if (ends) line = i + 1;
    }
    return out;
}

void number_field(const char* name, double& value, const char* format) {
    bool* active = ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID(name));
    if (*active)
        std::replace(ImGui::GetIO().InputQueueCharacters.begin(), ImGui::GetIO().InputQueueCharacters.end(),
                     ImWchar{','}, ImWchar{'.'});
    ImGui::InputDouble(name, &value, 0.0, 0.0, std::isfinite(value) ? format : "");
    *active = ImGui::IsItemActive();
    const ImGuiInputTextState* typed = ImGui::GetInputTextState(ImGui::GetItemID());
    const bool is_typed_in = ImGui::IsItemActive() || ImGui::IsItemDeactivated();
    if (is_typed_in && typed != nullptr && typed->CurLenW == 0) value = platform::kMissing;
}

void wrapped_text(const std::string& text) {
    const std::string lines = broken_at_spaces(text, ImGui::GetContentRegionAvail().x);
    ImGui::PushTextWrapPos(0.0f);  // a word that is longer than a line
    ImGui::TextUnformatted(lines.data(), lines.data() + lines.size());
    ImGui::PopTextWrapPos();
}

void paragraph(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]);
    wrapped_text(text);
    ImGui::PopStyleColor();
}

void one_line(std::string text) {
    const float width_px = ImGui::GetContentRegionAvail().x;
    if (ImGui::CalcTextSize(text.c_str()).x > width_px) {
        while (!text.empty() && ImGui::CalcTextSize((text + "...").c_str()).x > width_px) {
            while (!text.empty() && (text.back() & 0xC0) == 0x80) text.pop_back();  // a whole character of UTF-8
            if (!text.empty()) text.pop_back();
        }
        text += "...";
    }
    ImGui::TextDisabled("%s", text.c_str());
}

void warning_paragraph(const std::string& text) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextColored(ImVec4(1.0f, 0.84f, 0.35f, 1.0f), "! %s", text.c_str());
    ImGui::PopTextWrapPos();
}

void value_line(const char* name, const std::string& value, float column_px) {
    const float left_px = ImGui::GetCursorPosX();
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine();
    ImGui::SetCursorPosX(left_px + column_px);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(value.c_str());
    ImGui::PopTextWrapPos();
}

std::string clock_text(double seconds) {
    const int whole_s = static_cast<int>(std::clamp(seconds, 0.0, 1e6));
    char text[32];
    std::snprintf(text, sizeof text, "%d:%02d", whole_s / 60, whole_s % 60);
    return text;
}

std::string fixed(double value, int digits) {
    if (!std::isfinite(value)) return "-";
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, std::clamp(value, -1e12, 1e12));
    const bool zero = text[std::strspn(text, "-0.")] == '\0';
    return zero && text[0] == '-' ? text + 1 : text;  // no "-0.00"
}

void push_touchable_frame(float side_mm, const Gui& gui) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(side_mm * gui.mm(), 0.5f * (kTarget_mm * gui.mm() - ImGui::GetFontSize())));
}

ImVec2 on_screen(const render::TissueView& view, double x_m, double y_m) {
    const glm::vec2 px = render::project_px(view, glm::vec3(x_m, y_m, 0.0));
    return {px.x, px.y};
}

ImVec2 on_surface(const render::TissuePicture& picture, double x_m, double y_m) {
    const glm::vec3 p_m = render::displaced_m(picture, render::dragged_m(picture.view, {x_m, y_m}));
    const glm::vec2 px = render::project_px(picture.view, p_m);
    return {px.x, px.y};
}

void cross(ImDrawList& draw, ImVec2 at, float r, ImU32 colour, float width_px) {
    draw.AddLine(ImVec2(at.x - r, at.y - r), ImVec2(at.x + r, at.y + r), colour, width_px);
    draw.AddLine(ImVec2(at.x - r, at.y + r), ImVec2(at.x + r, at.y - r), colour, width_px);
}

void dashed_circle(ImDrawList& draw, ImVec2 at, float radius_px, ImU32 colour, float width_px) {
    constexpr int kDashes = 16;
    for (int i = 0; i < kDashes; ++i) {
        const float from = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) / kDashes;
        draw.PathArcTo(at, radius_px, from, from + std::numbers::pi_v<float> / kDashes, 4);
        draw.PathStroke(colour, 0, width_px);
    }
}

PanelArea plated_text(ImDrawList& draw, ImVec2 at, ImU32 colour, const std::string& text, float wrap_px) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap_px);
    const float margin_px = 0.2f * ImGui::GetFontSize();
    draw.AddRectFilled(ImVec2(at.x - margin_px, at.y - 0.4f * margin_px),
                       ImVec2(at.x + size.x + margin_px, at.y + size.y + 0.4f * margin_px), IM_COL32(20, 22, 24, 205),
                       margin_px);
    draw.AddText(nullptr, 0.0f, at, colour, text.c_str(), nullptr, std::max(wrap_px, 0.0f));
    return {at.x, at.y, at.x + size.x, at.y + size.y};
}

std::vector<PanelArea> label_areas(const std::vector<Label>& labels, std::vector<PanelArea> taken, float left_px,
                                   float mm) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    for (const Label& label : labels)
        taken.push_back({label.at.x - mm, label.at.y - mm, label.at.x + mm, label.at.y + mm});
    std::vector<PanelArea> out;
    for (const Label& label : labels) {
        const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
        const float off_px = 2.4f * mm;
        PanelArea area{};
        std::optional<PanelArea> seen;  // the first place where nothing cuts it off
        bool free = false;
        for (int k = 0; k < 8 && !free; ++k) {
            const float x0 = k % 2 == 0 ? label.at.x + off_px : label.at.x - off_px - size.x;
            const float step = static_cast<float>(k / 2) * 0.9f * size.y;
            const float y0 = label.at.y - 1.2f * size.y + (k / 2 % 2 == 0 ? step : -step);
            area = {x0, y0, x0 + size.x, y0 + size.y};
            if (area.x0 < left_px || area.x1 > screen.x || area.y0 < 0.0f) continue;
            if (!seen) seen = area;
            free =
                std::none_of(taken.begin(), taken.end(), [&](const PanelArea& other) { return overlap(area, other); });
        }
        if (!free && seen) area = *seen;
        taken.push_back(area);
        out.push_back(area);
    }
    return out;
}

void place_labels(const std::vector<Label>& labels, const std::vector<PanelArea>& taken, float left_px, float mm,
                  ImDrawList& draw) {
    const std::vector<PanelArea> areas = label_areas(labels, taken, left_px, mm);
    for (std::size_t i = 0; i < labels.size(); ++i)
        plated_text(draw, ImVec2(areas[i].x0, areas[i].y0), kInk, labels[i].text);
}

void draw_too_small() {
    const ImVec2 at(4.0f, 4.0f);
    plated_text(*ImGui::GetForegroundDrawList(), at, kInk, words::kTooSmall,
                ImGui::GetIO().DisplaySize.x - 2.0f * at.x);
}

}  // namespace palpa::app
