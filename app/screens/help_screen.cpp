// The list of keys, and the tissue's cover while the clock is stopped.

#include <algorithm>
#include <vector>

#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

struct KeyLine {
    const char* key;
    const char* does;
};

std::vector<KeyLine> key_lines(bool in_browser) {
    std::vector<KeyLine> lines{{words::kKeyArrows, words::kKeyArrowsDo},         {words::kKeySpace, words::kKeySpaceDo},
                               {words::kKeyPages, words::kKeyPagesDo},           {words::kKeyMark, words::kKeyMarkDo},
                               {words::kKeyConfidence, words::kKeyConfidenceDo}, {words::kKeyUndo, words::kKeyUndoDo},
                               {words::kKeyFinish, words::kKeyFinishDo},         {words::kKeyPause, words::kKeyPauseDo},
                               {words::kKeyAgain, words::kKeyAgainDo},           {words::kKeyNext, words::kKeyNextDo},
                               {words::kKeyPicture, words::kKeyPictureDo},       {words::kKeyMenu, words::kKeyMenuDo}};
    if (in_browser) {
        lines.push_back({words::kKeyScreensWeb, words::kKeyScreensWebDo});
    } else {
        lines.push_back({words::kKeyScreens, words::kKeyScreensDo});
    }
    lines.push_back({words::kKeyInset, words::kKeyInsetDo});
    lines.push_back({words::kKeyHold, words::kKeyHoldDo});
    lines.push_back({words::kKeyCost, words::kKeyCostDo});
    if (in_browser) {
        lines.push_back({words::kKeyWindowWeb, words::kKeyWindowWebDo});
    } else {
        lines.push_back({words::kKeyStop, words::kKeyStopDo});
        lines.push_back({words::kKeyWindow, words::kKeyWindowDo});
    }
    return lines;
}

}  // namespace

void draw_help(const Shown& shown, Gui& gui, ViewState& view) {
    const WindowSize window = gui.size_px();
    gui.claim({0.0f, 0.0f, window.width, window.height});  // nothing is palpated meanwhile
    const float width_px = std::min(window.width, 150.0f * gui.mm());
    const std::vector<KeyLine> keys = key_lines(shown.notices.keeps_trials);
    float column_px = 0.0f;
    for (const KeyLine& line : keys) column_px = std::max(column_px, ImGui::CalcTextSize(line.key).x);
    column_px += 5.0f * gui.mm();
    const float wrap_px = width_px - 2.0f * ImGui::GetStyle().WindowPadding.x - column_px;
    float needed_px = 2.5f * ImGui::GetTextLineHeightWithSpacing() + (kTarget_mm + 12.0f) * gui.mm();
    for (const KeyLine& line : keys)
        needed_px += ImGui::CalcTextSize(line.does, nullptr, false, wrap_px).y + ImGui::GetStyle().ItemSpacing.y;
    const float height_px = std::min(window.height, needed_px);
    const float x0 = 0.5f * (window.width - width_px);
    const float y0 = 0.5f * (window.height - height_px);
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0.0f, 0.0f), ImVec2(window.width, window.height),
                                                  IM_COL32(0, 0, 0, 150));
    begin_panel("help", {x0, y0, x0 + width_px, y0 + height_px}, gui);
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
    ImGui::SetWindowFontScale(1.4f);
    ImGui::TextUnformatted(words::kKeys);
    ImGui::SetWindowFontScale(1.0f);
    const float below_px = (kTarget_mm + 4.0f) * gui.mm();
    ImGui::BeginChild("keys", ImVec2(0.0f, ImGui::GetContentRegionAvail().y - below_px), false,
                      ImGuiWindowFlags_NavFlattened);
    for (const KeyLine& line : keys) {
        const float left_px = ImGui::GetCursorPosX();
        ImGui::TextUnformatted(line.key);
        ImGui::SameLine();
        ImGui::SetCursorPosX(left_px + column_px);
        paragraph(line.does);
    }
    const float lines =
        (gui.pressed(platform::key::down) ? 1.0f : 0.0f) - (gui.pressed(platform::key::up) ? 1.0f : 0.0f);
    if (lines != 0.0f)
        ImGui::SetScrollY(std::max(0.0f, ImGui::GetScrollY() + lines * ImGui::GetTextLineHeightWithSpacing()));
    end_scrolled("keys", gui);
    if (big_button(words::kClose, words::kEscape, {40.0f * gui.mm(), kTarget_mm, true, false}, gui)) view.help = false;
    end_panel("help", gui);
}

void draw_paused(const Shown&, const Layout& layout, Gui& gui, Wishes& wishes) {
    begin_panel("paused", layout.tissue_px, gui);
    const float width_px = 70.0f * gui.mm();
    ImGui::SetCursorPosY(0.4f * layout.tissue_px.height());
    const float left_px = std::max(ImGui::GetCursorPosX(), 0.5f * (layout.tissue_px.width() - width_px));
    ImGui::SetCursorPosX(left_px);
    ImGui::BeginGroup();
    ImGui::SetWindowFontScale(1.4f);
    ImGui::TextUnformatted(words::kPaused);
    ImGui::SetWindowFontScale(1.0f);
    ImGui::TextDisabled(words::kPausedMeans);
    ImGui::SetItemDefaultFocus();
    if (big_button(words::kContinue, words::kKeyPause, {width_px, kMark_mm, true, true}, gui))
        wishes.action = platform::Action::resume;
    ImGui::EndGroup();
    end_panel("paused", gui);
}

}  // namespace palpa::app
