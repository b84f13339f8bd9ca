#include "app/screens/plot.h"

#include <algorithm>
#include <cmath>

#include "figures/tic_step.h"
#include "files/text.h"

namespace palpa::app {
namespace {

constexpr float kSmall = 0.8f;  // of the text
constexpr ImU32 kGrid = IM_COL32(70, 76, 82, 255);

void small_text(ImVec2 at, const char* text, ImDrawList& draw) {
    draw.AddText(ImGui::GetFont(), kSmall * ImGui::GetFontSize(), at, kPale, text);
}

// The first tick at or above `least`.
double first_tick(double least, double step) { return std::ceil(least / step - 1e-9) * step; }

}  // namespace

ImVec2 Plot::at(double x, double y) const {
    const double sx = std::clamp((x - least_x) / (most_x - least_x), -0.03, 1.03);
    const double sy = std::clamp((y - least_y) / (most_y - least_y), -0.03, 1.03);
    return {area.x0 + static_cast<float>(sx) * area.width(), area.y1 - static_cast<float>(sy) * area.height()};
}

PanelArea data_area(const PanelArea& whole, float mm) {
    const float text_px = ImGui::GetFontSize();
    return {whole.x0 + 3.0f * text_px, whole.y0 + 2.4f * text_px + mm, whole.x1 - text_px - mm,
            whole.y1 - 2.2f * text_px - mm};
}

void draw_plot_axes(const Plot& plot, const PlotTitles& titles, float mm, ImDrawList& draw) {
    const PanelArea& a = plot.area;
    const float text_px = ImGui::GetFontSize();
    const float small_px = kSmall * text_px;
    const double y_span = plot.most_y - plot.least_y;
    const double y_step = figures::tic_step(y_span, static_cast<double>(a.height() / (2.5f * small_px)));
    for (double v = first_tick(plot.least_y, y_step); v <= plot.most_y + 1e-9 * y_span; v += y_step) {
        const ImVec2 at = plot.at(plot.least_x, v);
        const std::string text = files::short_number(std::abs(v) < 1e-9 * y_span ? 0.0 : v);
        draw.AddLine(at, ImVec2(a.x1, at.y), kGrid);
        small_text(ImVec2(at.x - mm - kSmall * ImGui::CalcTextSize(text.c_str()).x, at.y - 0.5f * small_px),
                   text.c_str(), draw);
    }
    const double x_span = plot.most_x - plot.least_x;
    double x_step = figures::tic_step(x_span, static_cast<double>(a.width() / (5.0f * small_px)));
    if (plot.counts_x) x_step = std::max(1.0, x_step);
    for (double v = first_tick(plot.least_x, x_step); v <= plot.most_x + 1e-9 * x_span; v += x_step) {
        const ImVec2 at = plot.at(v, plot.least_y);
        const std::string text = files::short_number(std::abs(v) < 1e-9 * x_span ? 0.0 : v);
        draw.AddLine(at, ImVec2(at.x, at.y + mm), kPale);
        small_text(ImVec2(at.x - 0.5f * kSmall * ImGui::CalcTextSize(text.c_str()).x, at.y + 1.2f * mm), text.c_str(),
                   draw);
    }
    draw.AddRect(ImVec2(a.x0, a.y0), ImVec2(a.x1, a.y1), kPale);
    const float room_px = a.x1 + text_px - ImGui::CalcTextSize(titles.top).x;  // else the title's end is cut off
    draw.AddText(ImVec2(std::clamp(room_px, a.x0 - 2.9f * text_px, a.x0), a.y0 - 2.3f * text_px), kInk, titles.top);
    small_text(ImVec2(a.x0 - 2.2f * text_px, a.y0 - 1.1f * text_px), titles.y, draw);
    small_text(ImVec2(a.x1 - kSmall * ImGui::CalcTextSize(titles.x).x, a.y1 + 1.4f * mm + small_px), titles.x, draw);
}

}  // namespace palpa::app
