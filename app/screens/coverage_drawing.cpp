// What was pressed, and how deep, over the tissue: areas with smooth edges, made of the cells of the coverage.

#include <algorithm>
#include <array>

#include "app/screens/screens.h"
#include "app/screens/widgets.h"

namespace palpa::app {
namespace {

// The tissue around the areas is darkened, so that all of them stand out.
constexpr ImU32 kVeil = IM_COL32(16, 18, 20, 200);
constexpr ImU32 kHatch = IM_COL32(168, 176, 182, 110);

// A quantity at the centres of the cells, between which it is linear along the sides of squares. Beyond the first and
// the last cell it goes on to the edge of the tissue.
struct CellField {
    const study::Coverage& c;
    bool touched;      // the quantity is 1 where something pressed, else the depth as a share of the full depth
    double threshold;  // from which a place belongs to the area

    double at(int i, int j) const {
        const int x = std::clamp(i, 0, c.n_x - 1);
        const int y = std::clamp(j, 0, c.n_y - 1);
        const auto depth_m = static_cast<double>(c.depth_m[static_cast<std::size_t>(y * c.n_x + x)]);
        if (touched) return depth_m > 0.0 ? 1.0 : 0.0;
        return depth_m / c.full_depth_m;
    }
    bool inside(int i, int j) const { return at(i, j) >= threshold; }
    Eigen::Vector2d place_m(int i, int j) const {
        const double x = std::clamp(i + 0.5, 0.0, static_cast<double>(c.n_x));
        const double y = std::clamp(j + 0.5, 0.0, static_cast<double>(c.n_y));
        return {c.x_m + x * c.cell_m, c.y_m + y * c.cell_m};
    }
};

struct AreaLook {
    ImU32 colour;
    float rim_px;            // of a light line around the area; 0: none
    const CellField* above;  // the next level, which covers its part of this one; null: none
};

// Draws the part of one square between four centres that belongs to the area.
void draw_square(const Shown& shown, const CellField& field, int i, int j, const AreaLook& look, ImDrawList& draw) {
    constexpr std::array<std::array<int, 2>, 4> kCorners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    ImVec2 outline[8];
    ImVec2 crossed[4];
    int points = 0;
    int crossings = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const int ai = i + kCorners[k][0];
        const int aj = j + kCorners[k][1];
        const int bi = i + kCorners[(k + 1) % 4][0];
        const int bj = j + kCorners[(k + 1) % 4][1];
        const double a = field.at(ai, aj);
        const double b = field.at(bi, bj);
        const Eigen::Vector2d a_m = field.place_m(ai, aj);
        if (a >= field.threshold) outline[points++] = on_screen(shown.view, a_m.x(), a_m.y());
        if ((a >= field.threshold) == (b >= field.threshold)) continue;
        const Eigen::Vector2d p_m = a_m + (field.threshold - a) / (b - a) * (field.place_m(bi, bj) - a_m);
        outline[points++] = crossed[crossings++] = on_screen(shown.view, p_m.x(), p_m.y());
    }
    if (points > 2) draw.AddConvexPolyFilled(outline, points, look.colour);
    if (look.rim_px <= 0.0f) return;
    for (int k = 0; k + 1 < crossings; k += 2) draw.AddLine(crossed[k], crossed[k + 1], kInk, look.rim_px);
}

// Draws squares that belong to the area entirely as one.
void draw_row_of_squares(const Shown& shown, const CellField& field, int first, int last, int j, ImU32 colour,
                         ImDrawList& draw) {
    const auto px = [&](int x, int y) {
        const Eigen::Vector2d p_m = field.place_m(x, y);
        return on_screen(shown.view, p_m.x(), p_m.y());
    };
    draw.AddQuadFilled(px(first, j), px(last + 1, j), px(last + 1, j + 1), px(first, j + 1), colour);
}

void draw_area(const Shown& shown, const CellField& field, const AreaLook& look, ImDrawList& draw) {
    const auto covered = [&](int i, int j) {
        return look.above != nullptr && look.above->inside(i, j) && look.above->inside(i + 1, j) &&
               look.above->inside(i, j + 1) && look.above->inside(i + 1, j + 1);
    };
    for (int j = -1; j < field.c.n_y; ++j) {
        const auto corners = [&](int i) {
            return static_cast<int>(field.inside(i, j)) + static_cast<int>(field.inside(i + 1, j)) +
                   static_cast<int>(field.inside(i, j + 1)) + static_cast<int>(field.inside(i + 1, j + 1));
        };
        for (int i = -1; i < field.c.n_x; ++i) {
            const int here = corners(i);
            if (here == 0) continue;
            if (here < 4) {
                draw_square(shown, field, i, j, look, draw);
                continue;
            }
            int last = i;
            while (last + 1 < field.c.n_x && corners(last + 1) == 4 && covered(last + 1, j) == covered(i, j)) ++last;
            if (!covered(i, j)) draw_row_of_squares(shown, field, i, last, j, look.colour, draw);
            i = last;
        }
    }
}

// Veils the tissue and hatches what was never touched, so that this is not one more colour.
void draw_untouched(const Shown& shown, const study::Coverage& c, float mm, ImDrawList& draw) {
    const double x1 = c.x_m + c.n_x * c.cell_m;
    const double y1 = c.y_m + c.n_y * c.cell_m;
    draw.AddQuadFilled(on_screen(shown.view, c.x_m, c.y_m), on_screen(shown.view, x1, c.y_m),
                       on_screen(shown.view, x1, y1), on_screen(shown.view, c.x_m, y1), kVeil);
    for (int j = 0; j < c.n_y; ++j) {
        for (int i = 0; i < c.n_x; ++i) {
            if ((i + c.n_y - j) % 4 != 0 || c.depth_m[static_cast<std::size_t>(j * c.n_x + i)] > 0.0f) continue;
            const double x_m = c.x_m + i * c.cell_m;
            const double y_m = c.y_m + j * c.cell_m;
            draw.AddLine(on_screen(shown.view, x_m, y_m), on_screen(shown.view, x_m + c.cell_m, y_m + c.cell_m), kHatch,
                         0.2f * mm);
        }
    }
}

}  // namespace

void draw_coverage(const Shown& shown, float mm, ImDrawList& draw) {
    const study::Coverage& c = shown.trial.coverage;
    draw_untouched(shown, c, mm, draw);
    const ImDrawListFlags flags = draw.Flags;
    draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // neighbours would show seams
    const CellField touched{c, true, 0.5};
    const CellField medium{c, false, 1.0 / 3.0};
    const CellField deep{c, false, 2.0 / 3.0};
    draw_area(shown, touched, {kAreaTints[0], 0.35f * mm, &medium}, draw);
    draw_area(shown, medium, {kAreaTints[1], 0.0f, &deep}, draw);
    draw_area(shown, deep, {kAreaTints[2], 0.0f, nullptr}, draw);
    draw.Flags = flags;
}

}  // namespace palpa::app
