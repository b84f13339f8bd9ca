// The screen on which the person measures the display's scale, by a bank card held against it or by a typed number.

#include <algorithm>
#include <cmath>

#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

constexpr float kCardLong_mm = 85.60f;  // ISO/IEC 7810 ID-1
constexpr float kCardShort_mm = 53.98f;
constexpr double kLeast_px_per_mm = 1.0;
constexpr double kMost_px_per_mm = 60.0;

struct CardSize {
    float width_mm = kCardLong_mm;
    float height_mm = kCardShort_mm;
    int ruler_mm = 80;  // that fit into the width
};

// The card stands upright where the room for it is taller than wide, as on a phone.
CardSize card_size(const PanelArea& area) {
    if (area.height() > area.width()) return {kCardShort_mm, kCardLong_mm, 50};
    return {};
}

// Draws a ruler, for those without a card. `low`: its left end, below.
void draw_ruler(const ImVec2& low, const CardSize& card, float px_per_mm, ImDrawList& draw) {
    constexpr float kLeastTick_px = 3.0f;
    const int numbered_mm = ruler_step_mm(px_per_mm, ImGui::CalcTextSize("80").x);
    for (int mm = 0; mm <= card.ruler_mm; ++mm) {
        if (mm % 5 != 0 && px_per_mm < kLeastTick_px) continue;
        const float x = low.x + static_cast<float>(mm) * px_per_mm;
        const float length_px = (mm % 10 == 0 ? 5.0f : mm % 5 == 0 ? 3.5f : 2.0f) * px_per_mm;
        draw.AddLine(ImVec2(x, low.y - length_px), ImVec2(x, low.y), kPale);
        if (mm % numbered_mm != 0 || mm == 0) continue;
        const std::string number = std::to_string(mm);
        const float width_px = ImGui::CalcTextSize(number.c_str()).x;
        const float right_px = low.x + (card.width_mm - 1.0f) * px_per_mm;  // of the card, with its edge free
        draw.AddText(
            ImVec2(std::min(x - 0.5f * width_px, right_px - width_px), low.y - 6.0f * px_per_mm - ImGui::GetFontSize()),
            kPale, number.c_str());
    }
}

void draw_card(const PanelArea& area, float px_per_mm) {
    const CardSize card = card_size(area);
    const float width_px = card.width_mm * px_per_mm;
    const float height_px = card.height_mm * px_per_mm;
    const ImVec2 low(0.5f * (area.x0 + area.x1 - width_px), 0.5f * (area.y0 + area.y1 - height_px));
    const ImVec2 high(low.x + width_px, low.y + height_px);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    // a scale that is much too large must not hide what changes it
    draw.PushClipRect(ImVec2(area.x0, area.y0), ImVec2(area.x1, area.y1), true);
    draw.AddRectFilled(low, high, IM_COL32(62, 69, 75, 255), 3.18f * px_per_mm);
    draw.AddRect(low, high, kLag, 3.18f * px_per_mm, 0, 2.0f);
    draw_ruler(ImVec2(low.x, high.y), card, px_per_mm, draw);
    const char* text = words::kCardSize;
    const ImVec2 text_px = ImGui::CalcTextSize(text);
    const float indent_px = 4.0f * px_per_mm;
    const bool inside = text_px.x < width_px - 2.0f * indent_px && 2.0f * text_px.y < height_px - 12.0f * px_per_mm;
    draw.AddText(inside ? ImVec2(low.x + indent_px, low.y + indent_px)
                        : ImVec2(0.5f * (low.x + high.x - text_px.x), low.y - 1.5f * text_px.y),
                 kInk, text);
    draw.PopClipRect();
}

// Lets the person drag the frame's left or right edge, or anything between, to the size of the card.
void drag_card(const PanelArea& area, ScaleForm& form) {
    constexpr float kGrip = 1.4f;  // the edges can be gripped from outside
    const float width_mm = card_size(area).width_mm;
    double& px_per_mm = form.card_px_per_mm;
    const auto half_px = static_cast<float>(0.5 * px_per_mm) * width_mm;
    const float middle_x = 0.5f * (area.x0 + area.x1);
    ImGui::SetCursorScreenPos(ImVec2(std::max(area.x0, middle_x - kGrip * half_px), area.y0));
    const float width_px = std::min(area.width(), 2.0f * kGrip * half_px);
    press_area("card", ImVec2(std::max(1.0f, width_px), std::max(1.0f, area.height())));
    if (ImGui::IsItemActivated()) form.held_px_per_mm = px_per_mm;
    if (!ImGui::IsItemActive()) return;
    // from where it was taken hold of: a finger or a pen comes down far from where the pointer was
    const float now_px = std::abs(ImGui::GetMousePos().x - middle_x);
    const float held_px = std::abs(ImGui::GetIO().MouseClickedPos[0].x - middle_x);
    px_per_mm = std::clamp(form.held_px_per_mm + static_cast<double>(2.0f * (now_px - held_px) / width_mm),
                           kLeast_px_per_mm, kMost_px_per_mm);
}

void step_buttons(const Gui& gui, double& px_per_mm) {
    constexpr double kSteps[] = {0.98, 0.998, 1.002, 1.02};
    constexpr const char* kLabels[] = {"- -", "-", "+", "+ +"};
    const float width_px = std::min(share_of_line_px(4), 22.0f * gui.mm());
    for (int i = 0; i < 4; ++i) {
        if (i > 0) ImGui::SameLine();
        if (big_button(kLabels[i], "", {width_px, kTarget_mm, true, false}, gui)) px_per_mm *= kSteps[i];
    }
}

// What is typed stays in the field until it is a scale, or until the card is moved. Returns false while it is none; the card
// then stays as it was.
bool type_scale(const Gui& gui, ScaleForm& form) {
    form.card_px_per_mm = std::clamp(form.card_px_per_mm, kLeast_px_per_mm, kMost_px_per_mm);
    if (form.card_px_per_mm != form.taken_px_per_mm) form.typed_px_per_mm = form.card_px_per_mm;
    ImGui::SetNextItemWidth(40.0f * gui.mm());
    push_touchable_frame(2.0f, gui);
    number_field(words::kPxPerMm, form.typed_px_per_mm, "%.3f");
    ImGui::PopStyleVar();
    const bool good = form.typed_px_per_mm >= kLeast_px_per_mm && form.typed_px_per_mm <= kMost_px_per_mm;
    if (good) {
        form.card_px_per_mm = form.typed_px_per_mm;
    } else {
        ImGui::SameLine();
        warning_paragraph(words::filled(words::kNumberFromTo, {fixed(kLeast_px_per_mm, 0), fixed(kMost_px_per_mm, 0)}));
    }
    form.taken_px_per_mm = form.card_px_per_mm;
    return good;
}

}  // namespace

int ruler_step_mm(float px_per_mm, float number_px) {
    constexpr float kAir = 1.4f;  // so that two numbers do not read as one
    for (const int step_mm : {10, 20, 40}) {
        if (static_cast<float>(step_mm) * px_per_mm >= kAir * number_px) return step_mm;
    }
    return 80;
}

void draw_scale_screen(const Shown& shown, Gui& gui, ScaleForm& form, Wishes& wishes) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    begin_panel("scale", {0.0f, 0.0f, screen.x, screen.y}, gui);
    wrapped_text(words::kHoldCard);
    step_buttons(gui, form.card_px_per_mm);
    if (!ImGui::GetIO().WantTextInput) {
        if (gui.pressed('+') || gui.pressed('=') || gui.pressed(platform::key::pad_plus)) form.card_px_per_mm *= 1.002;
        if (gui.pressed('-') || gui.pressed(platform::key::pad_minus)) form.card_px_per_mm /= 1.002;
    }
    const bool good = type_scale(gui, form);
    const float width_px = std::min(share_of_line_px(3), 42.0f * gui.mm());
    if (big_button(words::kSave, "", {width_px, kMark_mm, good, false}, gui)) wishes.px_per_mm = form.card_px_per_mm;
    ImGui::SameLine();
    if (big_button(words::kReset, "", {width_px, kMark_mm, std::isfinite(shown.notices.px_per_mm), false}, gui))
        wishes.px_per_mm = platform::kMissing;
    ImGui::SameLine();
    if (big_button(words::kBack, words::kEscape, {width_px, kMark_mm, true, false}, gui)) {
        wishes.screen = Screen::trial;
    }
    const std::string kept = std::isfinite(shown.notices.px_per_mm)
                                 ? fixed(shown.notices.px_per_mm, 3) + " " + words::kPxPerMm
                                 : words::kNotMeasured;
    paragraph(words::filled(words::kThisScreen, {shown.notices.screen_name, kept}));
    if (kCardShort_mm * static_cast<float>(form.card_px_per_mm) > std::max(screen.x, screen.y))
        warning_paragraph(words::kCardTooLarge);
    const float top_px = ImGui::GetCursorScreenPos().y;
    const PanelArea card{0.0f, top_px, screen.x, std::max(top_px + 1.0f, screen.y - 3.0f * gui.mm())};
    drag_card(card, form);
    draw_card(card, static_cast<float>(form.card_px_per_mm));
    end_panel("scale", gui);
}

}  // namespace palpa::app
