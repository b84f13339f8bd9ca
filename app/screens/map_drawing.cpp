// Draws a map's matrix in colour with its axes, colour bar and nodules, and the curves of force over depth.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/screens/map_screen.h"
#include "app/screens/nodule_outline.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "figures/colour_maps.h"
#include "figures/tic_step.h"
#include "files/text.h"

namespace palpa::app {
namespace {

// The colours of Okabe and Ito, which colour-blind people can distinguish; numbers distinguish the curves too.
constexpr ImU32 kCurves[kPins + 1] = {IM_COL32(230, 159, 0, 255), IM_COL32(86, 180, 233, 255),
                                      IM_COL32(0, 158, 115, 255), IM_COL32(204, 121, 167, 255),
                                      IM_COL32(236, 239, 241, 255)};

std::string tic_text(double value) { return files::short_number(std::abs(value) < 1e-12 ? 0.0 : value); }

struct Values {
    const stiffnessmaps::Map& map;
    const MapBrowser& browser;
    double low = 0.0;
    double high = 1.0;
    bool apart = false;
    const char* unit = "N";

    double at(std::size_t cell) const {
        const std::size_t k = static_cast<std::size_t>(browser.depth) * map.n_cells() + cell;
        switch (browser.quantity) {
            case MapQuantity::normal:
                return static_cast<double>(map.normal_N[k]);
            case MapQuantity::tangential_x:
                return static_cast<double>(map.tangential_x_N[k]);
            case MapQuantity::tangential_y:
                return static_cast<double>(map.tangential_y_N[k]);
            case MapQuantity::stiffness:
                return 1e-3 * browser.stiffness_N_per_m[cell];
        }
        return 0.0;
    }
    ImU32 colour(double value) const {
        const double share = high > low ? (value - low) / (high - low) : 0.5;
        const figures::Colour c =
            figures::colour_at(apart ? figures::kApart : figures::kViridis, static_cast<float>(share));
        return IM_COL32(c.r, c.g, c.b, 255);
    }
};

// Returns the values of the shown matrix with a colour scale of their own: on the scale of the deepest matrix, shallow
// ones would have a single colour.
Values values_of(const MapBrowser& browser) {
    Values out{browser.map, browser};
    out.apart = browser.quantity == MapQuantity::tangential_x || browser.quantity == MapQuantity::tangential_y;
    if (browser.quantity == MapQuantity::stiffness) out.unit = words::kNewtonsPerMm;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t cell = 0; cell < browser.map.n_cells(); ++cell) {
        const double v = out.at(cell);
        if (std::isnan(v)) continue;
        low = std::min(low, v);
        high = std::max(high, v);
    }
    if (!(low <= high)) low = high = 0.0;
    if (out.apart) low = -(high = std::max(std::abs(low), std::abs(high)));
    // a matrix that is the same everywhere stands in the middle of its bar
    const double size = std::max({std::abs(low), std::abs(high), 1e-3});
    const double spread = high - low > 1e-6 * size ? 0.0 : 0.1 * size;
    out.low = low - spread;
    out.high = high + spread;
    return out;
}

struct Frame {
    ImVec2 low, high;  // of the cells, px
    const stiffnessmaps::Map* map;
    float px_per_m;

    ImVec2 px(double x_m, double y_m) const {
        return {low.x + px_per_m * static_cast<float>(x_m - map->origin_m[0] + 0.5 * map->spacing_m[0]),
                high.y - px_per_m * static_cast<float>(y_m - map->origin_m[1] + 0.5 * map->spacing_m[1])};
    }
    Eigen::Vector2d metres(ImVec2 p) const {
        return {map->origin_m[0] - 0.5 * map->spacing_m[0] + static_cast<double>((p.x - low.x) / px_per_m),
                map->origin_m[1] - 0.5 * map->spacing_m[1] + static_cast<double>((high.y - p.y) / px_per_m)};
    }
};

// Returns the largest frame in which the matrix fits, true to shape.
Frame frame_of(const stiffnessmaps::Map& map, ImVec2 low, ImVec2 high) {
    const auto width_m = static_cast<float>(map.spacing_m[0] * static_cast<double>(map.n_x));
    const auto height_m = static_cast<float>(map.spacing_m[1] * static_cast<double>(map.n_y));
    Frame f;
    f.map = &map;
    f.px_per_m = std::min((high.x - low.x) / width_m, (high.y - low.y) / height_m);
    f.low = ImVec2(low.x + 0.5f * (high.x - low.x - f.px_per_m * width_m),
                   low.y + 0.5f * (high.y - low.y - f.px_per_m * height_m));
    f.high = ImVec2(f.low.x + f.px_per_m * width_m, f.low.y + f.px_per_m * height_m);
    return f;
}

void hatch(ImDrawList& draw, ImVec2 low, ImVec2 high, float step_px) {
    draw.PushClipRect(low, high, true);
    draw.AddRectFilled(low, high, IM_COL32(58, 63, 68, 255));
    const float size = high.y - low.y;
    for (float x = low.x - size; x < high.x; x += step_px)
        draw.AddLine(ImVec2(x, high.y), ImVec2(x + size, low.y), IM_COL32(110, 118, 124, 255));
    draw.PopClipRect();
}

void draw_cells(const Values& values, const Frame& f, float mm, ImDrawList& draw) {
    const stiffnessmaps::Map& map = values.map;
    // a cell has four corners, and a draw list holds 65,536; larger maps are thinned
    constexpr std::size_t kMostCells = 12000;
    std::size_t stride = 1;
    while (((map.n_x + stride - 1) / stride) * ((map.n_y + stride - 1) / stride) > kMostCells) ++stride;
    hatch(draw, f.low, f.high, 1.6f * mm);
    const ImDrawListFlags flags = draw.Flags;
    draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // neighbours would show seams
    const auto dx = 0.5 * map.spacing_m[0];
    const auto dy = 0.5 * map.spacing_m[1];
    for (std::size_t j = 0; j < map.n_y; j += stride) {
        for (std::size_t i = 0; i < map.n_x; i += stride) {
            const double v = values.at(j * map.n_x + i);
            if (std::isnan(v)) continue;
            const std::size_t right = std::min(i + stride, map.n_x) - 1;
            const std::size_t top = std::min(j + stride, map.n_y) - 1;
            draw.AddRectFilled(f.px(map.x_of(i) - dx, map.y_of(top) + dy), f.px(map.x_of(right) + dx, map.y_of(j) - dy),
                               values.colour(v));
        }
    }
    draw.Flags = flags;
}

void draw_axes(const stiffnessmaps::Map& map, const Frame& f, float mm, ImDrawList& draw) {
    const float text_px = 0.8f * ImGui::GetFontSize();
    const auto small = [&](ImVec2 at, const std::string& text, float anchor_x) {
        const float width = 0.8f * ImGui::CalcTextSize(text.c_str()).x;
        draw.AddText(ImGui::GetFont(), text_px, ImVec2(at.x - anchor_x * width, at.y), kPale, text.c_str());
    };
    draw.AddRect(f.low, f.high, kPale);
    const double width_mm = 1e3 * map.spacing_m[0] * static_cast<double>(map.n_x);
    const double height_mm = 1e3 * map.spacing_m[1] * static_cast<double>(map.n_y);
    const double step_x = figures::tic_step(width_mm, static_cast<double>((f.high.x - f.low.x) / (6.0f * text_px)));
    const double step_y = figures::tic_step(height_mm, static_cast<double>((f.high.y - f.low.y) / (5.0f * text_px)));
    const double x0 = 1e3 * map.x_of(0);
    const double y0 = 1e3 * map.y_of(0);
    for (double x = std::ceil((x0 - 1e-6) / step_x) * step_x; x <= 1e3 * map.x_of(map.n_x - 1) + 1e-6; x += step_x) {
        const ImVec2 at(f.px(1e-3 * x, 0.0).x, f.high.y);
        draw.AddLine(at, ImVec2(at.x, at.y + mm), kPale);
        small(ImVec2(at.x, at.y + 1.3f * mm), tic_text(x), 0.5f);
    }
    for (double y = std::ceil((y0 - 1e-6) / step_y) * step_y; y <= 1e3 * map.y_of(map.n_y - 1) + 1e-6; y += step_y) {
        const ImVec2 at(f.low.x, f.px(0.0, 1e-3 * y).y);
        draw.AddLine(ImVec2(at.x - mm, at.y), at, kPale);
        small(ImVec2(at.x - 1.4f * mm, at.y - 0.5f * text_px), tic_text(y), 1.0f);
    }
    small(ImVec2(f.high.x, f.high.y + 1.5f * mm + text_px), words::kAxesInMm, 1.0f);
}

void draw_bar(const Values& values, const Frame& f, ImVec2 low, float width_px, float mm, ImDrawList& draw) {
    const float height = f.high.y - f.low.y;
    constexpr int kSteps = 64;
    const ImDrawListFlags flags = draw.Flags;
    draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;
    for (int k = 0; k < kSteps; ++k) {
        const float y1 = f.high.y - height * static_cast<float>(k) / kSteps;
        const float y0 = f.high.y - height * static_cast<float>(k + 1) / kSteps;
        draw.AddRectFilled(ImVec2(low.x, y0), ImVec2(low.x + width_px, y1),
                           values.colour(values.low + (values.high - values.low) * (k + 0.5) / kSteps));
    }
    draw.Flags = flags;
    draw.AddRect(ImVec2(low.x, f.low.y), ImVec2(low.x + width_px, f.high.y), kPale);
    const float text_px = 0.8f * ImGui::GetFontSize();
    const float tics = std::max(3.0f, height / (4.0f * text_px));  // a bar without numbers tells nothing
    const double step = figures::tic_step(values.high - values.low, static_cast<double>(tics));
    const double near = 1e-6 * (values.high - values.low);
    for (double v = std::ceil((values.low - near) / step) * step; v <= values.high + near; v += step) {
        const float y = f.high.y - height * static_cast<float>((v - values.low) / (values.high - values.low));
        draw.AddLine(ImVec2(low.x + width_px, y), ImVec2(low.x + width_px + mm, y), kPale);
        draw.AddText(ImGui::GetFont(), text_px, ImVec2(low.x + width_px + 1.4f * mm, y - 0.5f * text_px), kPale,
                     tic_text(v).c_str());
    }
    draw.AddText(ImVec2(low.x, f.low.y - ImGui::GetFontSize() - mm), kInk, values.unit);
}

// Detected nodules are dashed.
void draw_nodule(const stiffnessmaps::Nodule& nodule, const Frame& f, float mm, ImDrawList& draw) {
    const auto px = [&](double x_m, double y_m) { return f.px(x_m, y_m); };
    draw_outline(outline_of(nodule), px, {0.6f * mm, 0.25f * mm, !nodule.placed}, draw);
    const ImVec2 at = f.px(nodule.x_m, nodule.y_m);
    const ImVec2 size = ImGui::CalcTextSize(nodule.id.c_str());
    plated_text(draw, ImVec2(at.x - 0.5f * size.x, at.y - 0.5f * size.y), kInk, nodule.id);
}

void draw_pin(ImVec2 at, std::size_t number, float mm, ImDrawList& draw) {
    draw.AddCircleFilled(at, 2.6f * mm, kDark);
    draw.AddCircleFilled(at, 2.2f * mm, kCurves[number % kPins]);
    const std::string text = std::to_string(number + 1);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    draw.AddText(ImVec2(at.x - 0.5f * size.x, at.y - 0.5f * size.y), kDark, text.c_str());
}

// A title begins at `x`, or further left where it would go over `right`, but never left of `least`.
void draw_title(float least, float x, float right, float y, const char* text, ImDrawList& draw) {
    draw.AddText(ImVec2(std::clamp(right - ImGui::CalcTextSize(text).x, least, x), y), kInk, text);
}

std::string title_of(const MapBrowser& browser) {
    const std::string depth =
        ", " +
        words::filled(words::kMmDeep,
                      {files::short_number(1e3 * browser.map.depths_m[static_cast<std::size_t>(browser.depth)])});
    switch (browser.quantity) {
        case MapQuantity::normal:
            return words::kNormalForce + depth;
        case MapQuantity::tangential_x:
            return words::kForceAgainstX + depth;
        case MapQuantity::tangential_y:
            return words::kForceAgainstY + depth;
        case MapQuantity::stiffness:
            return words::kStiffness;
    }
    return "";
}

}  // namespace

bool has_quantity(const stiffnessmaps::Map& map, MapQuantity quantity) {
    if (quantity == MapQuantity::tangential_x) return !map.tangential_x_N.empty();
    if (quantity == MapQuantity::tangential_y) return !map.tangential_y_N.empty();
    return true;
}

std::optional<Eigen::Vector2d> draw_map_matrix(const MapBrowser& browser, ImVec2 size_px, const Gui& gui,
                                               bool& pressed) {
    const float mm = gui.mm();
    const stiffnessmaps::Map& map = browser.map;
    const float text_px = ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float bar_px = 4.0f * mm;
    const Frame f = frame_of(map, ImVec2(corner.x + 3.0f * text_px, corner.y + 1.3f * text_px + mm),
                             ImVec2(corner.x + size_px.x - bar_px - 3.0f * mm - 3.0f * text_px,
                                    corner.y + size_px.y - 2.2f * text_px - 2.0f * mm));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw_title(corner.x, f.low.x, f.high.x + 2.0f * mm, f.low.y - text_px - mm, title_of(browser).c_str(), draw);
    const Values values = values_of(browser);
    draw_cells(values, f, mm, draw);
    draw_axes(map, f, mm, draw);
    draw_bar(values, f, ImVec2(f.high.x + 3.0f * mm, f.low.y), bar_px, mm, draw);
    for (const stiffnessmaps::Nodule& nodule : map.nodules) draw_nodule(nodule, f, mm, draw);
    for (std::size_t k = 0; k < browser.pins_m.size(); ++k)
        draw_pin(f.px(browser.pins_m[k].x(), browser.pins_m[k].y()), k, mm, draw);
    if (browser.pointed_m) {
        const ImVec2 at = f.px(browser.pointed_m->x(), browser.pointed_m->y());
        cross(draw, at, 2.0f * mm, kDark, 1.2f * mm);
        cross(draw, at, 2.0f * mm, kInk, 0.6f * mm);
    }
    ImGui::SetCursorScreenPos(f.low);
    pressed = press_area("cells", ImVec2(std::max(1.0f, f.high.x - f.low.x), std::max(1.0f, f.high.y - f.low.y)));
    const ImVec2 mouse = ImGui::GetMousePos();
    const bool over =
        ImGui::IsItemHovered() && mouse.x >= f.low.x && mouse.x < f.high.x && mouse.y >= f.low.y && mouse.y < f.high.y;
    if (!over) return std::nullopt;
    return f.metres(mouse);
}

namespace {

struct DepthCurve {
    std::vector<ImVec2> points;  // mm, N
    std::string name;            // number of the curve, and its force at the shown depth
    std::string place;           // left out if there is no room
    ImU32 colour;
};

DepthCurve curve_at(const MapBrowser& browser, const Eigen::Vector2d& p_m, ImU32 colour, const std::string& name) {
    const stiffnessmaps::Place place = stiffnessmaps::place_at(browser.field, p_m);
    DepthCurve out{
        {}, name, words::filled(words::kAtPlace, {fixed(1e3 * p_m.x(), 1), fixed(1e3 * p_m.y(), 1)}), colour};
    if (!place.measured) {
        out.name += words::kNotMeasured;
        return out;
    }
    for (const double depth_m : browser.field.depths_m) {
        if (depth_m > greatest_depth_m(browser.field, place) * (1.0 + 1e-9)) break;
        out.points.emplace_back(static_cast<float>(1e3 * depth_m),
                                static_cast<float>(stiffnessmaps::normal_force_N(browser.field, place, depth_m)));
    }
    const double shown_m = browser.map.depths_m[static_cast<std::size_t>(browser.depth)];
    const bool known = shown_m <= stiffnessmaps::greatest_depth_m(browser.field, place) * (1.0 + 1e-9);
    out.name += known ? fixed(stiffnessmaps::normal_force_N(browser.field, place, shown_m), 2) + " N" : "-";
    return out;
}

}  // namespace

void draw_map_curves(const MapBrowser& browser, const std::optional<Eigen::Vector2d>& pointed_m, ImVec2 size_px,
                     const Gui& gui) {
    const float mm = gui.mm();
    std::vector<DepthCurve> curves;
    for (std::size_t k = 0; k < browser.pins_m.size(); ++k) {
        curves.push_back(curve_at(browser, browser.pins_m[k], kCurves[k], std::to_string(k + 1) + "  "));
    }
    if (pointed_m) curves.push_back(curve_at(browser, *pointed_m, kCurves[kPins], ""));
    float most_N = 1e-3f;
    for (const DepthCurve& curve : curves) {
        for (const ImVec2& p : curve.points) most_N = std::max(most_N, p.y);
    }
    if (curves.empty()) most_N = static_cast<float>(std::max(1e-3, stiffnessmaps::force_range(browser.map).highest_N));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float text_px = ImGui::GetFontSize();
    const float small_px = 0.8f * text_px;
    const ImVec2 low(corner.x + 2.6f * text_px, corner.y + text_px + 1.5f * mm);
    const ImVec2 high(corner.x + size_px.x - 2.0f * mm, corner.y + size_px.y - 2.6f * small_px);
    const auto deepest_mm = static_cast<float>(1e3 * browser.map.depths_m.back());
    const auto px = [&](float x_mm, float y_N) {
        return ImVec2(low.x + (high.x - low.x) * x_mm / deepest_mm, high.y - (high.y - low.y) * y_N / (1.08f * most_N));
    };
    draw_title(corner.x, low.x, high.x + 2.0f * mm, corner.y, words::kForceOverDepth, draw);
    const double step_N = figures::tic_step(1.08 * static_cast<double>(most_N),
                                            static_cast<double>((high.y - low.y) / (3.0f * small_px)));
    for (double v = 0.0; v <= 1.08 * static_cast<double>(most_N); v += step_N) {
        const ImVec2 at = px(0.0f, static_cast<float>(v));
        draw.AddLine(at, ImVec2(high.x, at.y), IM_COL32(70, 76, 82, 255));
        const std::string text = tic_text(v);
        draw.AddText(ImGui::GetFont(), small_px,
                     ImVec2(at.x - mm - 0.8f * ImGui::CalcTextSize(text.c_str()).x, at.y - 0.5f * small_px), kPale,
                     text.c_str());
    }
    const double step_mm =
        figures::tic_step(static_cast<double>(deepest_mm), static_cast<double>((high.x - low.x) / (5.0f * small_px)));
    for (double v = 0.0; v <= static_cast<double>(deepest_mm) * (1.0 + 1e-9); v += step_mm) {
        const ImVec2 at = px(static_cast<float>(v), 0.0f);
        draw.AddLine(at, ImVec2(at.x, at.y + mm), kPale);
        const std::string text = tic_text(v);
        draw.AddText(ImGui::GetFont(), small_px,
                     ImVec2(at.x - 0.4f * ImGui::CalcTextSize(text.c_str()).x, at.y + 1.2f * mm), kPale, text.c_str());
    }
    draw.AddText(ImGui::GetFont(), small_px, ImVec2(low.x - 2.0f * small_px, low.y - small_px - 0.4f * mm), kPale, "N");
    const char* x_name = words::kDepthAxis;
    draw.AddText(ImGui::GetFont(), small_px,
                 ImVec2(high.x - 0.8f * ImGui::CalcTextSize(x_name).x, high.y + 1.2f * mm + small_px), kPale, x_name);
    if (browser.quantity != MapQuantity::stiffness) {  // the depth of the matrix
        const auto depth_mm = static_cast<float>(1e3 * browser.map.depths_m[static_cast<std::size_t>(browser.depth)]);
        draw.AddLine(px(depth_mm, 0.0f), ImVec2(px(depth_mm, 0.0f).x, low.y), kLag, 0.3f * mm);
    }
    float line_y = low.y + mm;
    for (const DepthCurve& curve : curves) {
        std::vector<ImVec2> points;
        for (const ImVec2& p : curve.points) points.push_back(px(p.x, p.y));
        if (points.size() > 1)
            draw.AddPolyline(points.data(), static_cast<int>(points.size()), curve.colour, 0, 0.5f * mm);
        for (const ImVec2& p : points) draw.AddCircleFilled(p, 0.8f * mm, curve.colour);
        const std::string whole = curve.name + curve.place;
        const bool fits = low.x + 2.0f * mm + ImGui::CalcTextSize(whole.c_str()).x < high.x - 0.25f * (high.x - low.x);
        draw.AddText(ImVec2(low.x + 2.0f * mm, line_y), curve.colour, fits ? whole.c_str() : curve.name.c_str());
        line_y += text_px + 0.4f * mm;
    }
    if (curves.empty()) {
        const ImVec2 at(low.x + 2.0f * mm, line_y);
        draw.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, kPale, words::kPointAtMap, nullptr, high.x - at.x);
    }
    ImGui::Dummy(size_px);
}

}  // namespace palpa::app
