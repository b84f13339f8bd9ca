#include "app/screens/pins_drawing.h"

#include <algorithm>
#include <cmath>

#include "app/screens/tactile_screen.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

// From the lowest pin to the highest: two ends of cividis, in which lightness alone tells the order.
ImU32 height_tint(double share) {
    const auto mixed = [&](double low, double high) {
        return static_cast<int>(std::lround(low + (high - low) * std::clamp(share, 0.0, 1.0)));
    };
    return IM_COL32(mixed(16, 250), mixed(46, 221), mixed(92, 76), 255);
}

double share_of(const PinField& field, int row, int column) {
    const double height_m = field.height_m[row * field.columns + column];
    return std::isfinite(height_m) && field.stroke_m > 0.0 ? height_m / field.stroke_m : 0.0;
}

// From here on black text stands out more than white: a contrast of 4.5 at least at every height.
constexpr double kDarkTextFrom = 0.425;

void draw_pin(ImVec2 at, float radius_px, double height_m, double share, ImDrawList& draw) {
    draw.AddCircleFilled(at, radius_px, height_tint(share), 20);
    draw.AddCircle(at, radius_px, kPale, 20, 1.0f);
    const float text_px = 0.9f * radius_px;
    if (text_px < 8.0f) return;
    const std::string text = fixed(1e4 * height_m, 0);
    const float width_px = ImGui::CalcTextSize(text.c_str()).x * text_px / ImGui::GetFontSize();
    draw.AddText(ImGui::GetFont(), text_px, ImVec2(at.x - 0.5f * width_px, at.y - 0.5f * text_px),
                 share > kDarkTextFrom ? IM_COL32(0, 0, 0, 255) : IM_COL32(255, 255, 255, 255), text.c_str());
}

// The upper left corner of the tissue, or the lower left one while the contact is near that.
PanelArea inset_area(const Shown& shown, float mm) {
    const scene::ScreenArea& screen = shown.state.screen;
    const float side_px = 26.0f * mm;
    const float gap_px = 2.0f * mm;
    PanelArea area;
    area.x0 = static_cast<float>(screen.x_px) + gap_px;
    area.y0 = static_cast<float>(screen.y_px) + gap_px;
    const ImVec2 contact = on_screen(shown.view, shown.avatar.p_m.x(), shown.avatar.p_m.y());
    const float near_px = side_px + 14.0f * mm;
    if (shown.state.touch.down && contact.x < area.x0 + near_px && contact.y < area.y0 + near_px)
        area.y0 = static_cast<float>(screen.y_px + screen.height_px) - side_px - gap_px;
    area.x1 = area.x0 + side_px;
    area.y1 = area.y0 + side_px;
    return area;
}

}  // namespace

PanelArea draw_pin_field(const PanelArea& area, const PinField& field, float mm, ImDrawList& draw) {
    if (field.rows <= 0 || field.columns <= 0) return {area.x0, area.y0, area.x0, area.y0};
    const auto rows = static_cast<float>(field.rows);
    const auto columns = static_cast<float>(field.columns);
    const float pitch_px = std::floor(std::min(area.width() / columns, area.height() / rows));
    const PanelArea used{area.x0, area.y0, area.x0 + pitch_px * columns, area.y0 + pitch_px * rows};
    draw.AddRectFilled(ImVec2(used.x0, used.y0), ImVec2(used.x1, used.y1), IM_COL32(28, 31, 34, 255), 0.8f * mm);
    for (int row = 0; row < field.rows; ++row) {
        for (int column = 0; column < field.columns; ++column) {
            const ImVec2 at(used.x0 + (static_cast<float>(column) + 0.5f) * pitch_px,
                            used.y1 - (static_cast<float>(row) + 0.5f) * pitch_px);
            draw_pin(at, 0.4f * pitch_px, field.height_m[row * field.columns + column], share_of(field, row, column),
                     draw);
        }
    }
    return used;
}

void draw_pin_section(const PanelArea& area, const PinField& wanted, const double* reached_m, float mm,
                      ImDrawList& draw) {
    if (wanted.rows <= 0 || wanted.columns <= 0) return;
    const int row = wanted.rows / 2;
    const float pitch_px = area.width() / static_cast<float>(wanted.columns);
    const PinField reached{wanted.rows, wanted.columns, wanted.stroke_m, reached_m};
    const auto y_of = [&](double share) {
        return area.y1 - area.height() * static_cast<float>(std::clamp(share, 0.0, 1.0));
    };
    draw.AddRectFilled(ImVec2(area.x0, area.y0), ImVec2(area.x1, area.y1), IM_COL32(28, 31, 34, 255));
    for (int column = 0; column < wanted.columns; ++column) {
        const float x = area.x0 + (static_cast<float>(column) + 0.5f) * pitch_px;
        const double share = share_of(wanted, row, column);
        draw.AddRectFilled(ImVec2(x - 0.25f * pitch_px, y_of(share)), ImVec2(x + 0.25f * pitch_px, area.y1),
                           height_tint(share));
        if (reached_m == nullptr) continue;
        const float y = y_of(share_of(reached, row, column));
        draw.AddLine(ImVec2(x - 0.42f * pitch_px, y), ImVec2(x + 0.42f * pitch_px, y), kInk, 0.5f * mm);
    }
    draw.AddRect(ImVec2(area.x0, area.y0), ImVec2(area.x1, area.y1), kPale);
}

void draw_pins_inset(const Shown& shown, const Gui& gui) {
    if (shown.tactile == nullptr || shown.tactile->moment.rows <= 0) return;
    const StudyRun* study = study_of(shown.doing);
    if (study != nullptr && due_compares(*study)) return;
    const float mm = gui.mm();
    const PanelArea area = inset_area(shown, mm);
    if (area.width() > 0.35f * static_cast<float>(shown.state.screen.width_px)) return;  // too small a window
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled(ImVec2(area.x0 - mm, area.y0 - mm), ImVec2(area.x1 + mm, area.y1 + 1.6f * ImGui::GetFontSize()),
                       kDark, mm);
    const session::TactileMoment& moment = shown.tactile->moment;
    const bool reached = moment.reached != session::ReachedBy::nothing;
    const PinField field{moment.rows, moment.columns, moment.stroke_m,
                         reached ? moment.reached_m.data() : moment.wanted_m.data()};
    draw_pin_field(area, field, mm, draw);
    draw.AddText(ImVec2(area.x0, area.y1 + 0.2f * ImGui::GetFontSize()), kPale,
                 reached ? words::kPins : words::kPinsDrawn);
}

}  // namespace palpa::app
