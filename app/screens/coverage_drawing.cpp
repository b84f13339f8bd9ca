// How deep each place was pressed, as bands with smooth outlines. The outlines are dark and stand out from every tint, so
// that the bands can be told apart without their colours.

#include "app/screens/coverage_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec2.hpp>
#include <vector>

#include "app/screens/widgets.h"

namespace palpa::app {
namespace {

// One level on the grid of the cells' centres with a border around it: 1 where it was reached, 0 elsewhere, blurred.
struct Mask {
    int n_x = 0;
    int n_y = 0;
    std::vector<float> share;
    float at(int i, int j) const { return share[static_cast<std::size_t>(j * n_x + i)]; }
};

void blur(int n, int stride, float* values) {
    float before = values[0];
    for (int i = 0; i < n; ++i) {
        const float here = values[i * stride];
        const float after = i + 1 < n ? values[(i + 1) * stride] : here;
        values[i * stride] = 0.25f * before + 0.5f * here + 0.25f * after;
        before = here;
    }
}

Mask mask_of(const study::Coverage& c, study::PalpationLevel level) {
    Mask mask{c.n_x + 2, c.n_y + 2, {}};
    mask.share.resize(static_cast<std::size_t>(mask.n_x * mask.n_y));
    for (int j = 0; j < mask.n_y; ++j) {
        for (int i = 0; i < mask.n_x; ++i) {
            // the border is as the outermost cells, so that a band ends at the tissue's edge
            const int x = std::clamp(i - 1, 0, c.n_x - 1);
            const int y = std::clamp(j - 1, 0, c.n_y - 1);
            const auto depth_m = static_cast<double>(c.depth_m[static_cast<std::size_t>(y * c.n_x + x)]);
            mask.share[static_cast<std::size_t>(j * mask.n_x + i)] = level_of(c, depth_m) >= level ? 1.0f : 0.0f;
        }
    }
    for (int pass = 0; pass < 2; ++pass) {
        for (int j = 0; j < mask.n_y; ++j) blur(mask.n_x, 1, &mask.share[static_cast<std::size_t>(j * mask.n_x)]);
        for (int i = 0; i < mask.n_x; ++i) blur(mask.n_y, mask.n_x, &mask.share[static_cast<std::size_t>(i)]);
    }
    return mask;
}

// The part of a square between four centres where the level was reached: a polygon of up to six corners, and the line
// (up to two) that ends it.
struct Piece {
    std::array<glm::vec2, 8> corners;
    int count = 0;
    std::array<glm::vec2, 4> edge;
    int edge_count = 0;
};

Piece piece_of(const Mask& mask, int i, int j) {
    constexpr float kHalf = 0.5f;
    const std::array<float, 4> share{mask.at(i, j), mask.at(i + 1, j), mask.at(i + 1, j + 1), mask.at(i, j + 1)};
    const std::array<glm::vec2, 4> corner{glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)};
    Piece piece;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t next = (k + 1) % 4;
        const bool inside = share[k] >= kHalf;
        if (inside) piece.corners[static_cast<std::size_t>(piece.count++)] = corner[k];
        if (inside == (share[next] >= kHalf)) continue;
        const float s = (kHalf - share[k]) / (share[next] - share[k]);
        const glm::vec2 crossing = corner[k] + s * (corner[next] - corner[k]);
        piece.corners[static_cast<std::size_t>(piece.count++)] = crossing;
        piece.edge[static_cast<std::size_t>(piece.edge_count++)] = crossing;
    }
    return piece;
}

// Converts places of the mask to the screen, cut off at the tissue's edges.
struct OnTissue {
    const render::TissueView& view;
    const study::Coverage& c;
    ImVec2 operator()(float x, float y) const {
        const double across = std::clamp(static_cast<double>(x) - 0.5, 0.0, static_cast<double>(c.n_x));
        const double up = std::clamp(static_cast<double>(y) - 0.5, 0.0, static_cast<double>(c.n_y));
        return on_screen(view, c.x_m + across * c.cell_m, c.y_m + up * c.cell_m);
    }
};

void fill_run(const OnTissue& at, int first, int last, int j, ImU32 colour, ImDrawList& draw) {
    const auto x0 = static_cast<float>(first);
    const auto x1 = static_cast<float>(last + 1);
    const auto y = static_cast<float>(j);
    draw.AddQuadFilled(at(x0, y), at(x1, y), at(x1, y + 1.0f), at(x0, y + 1.0f), colour);
}

void fill_piece(const OnTissue& at, const Piece& piece, int i, int j, ImU32 colour, ImDrawList& draw) {
    for (int k = 0; k < piece.count; ++k) {
        const glm::vec2& p = piece.corners[static_cast<std::size_t>(k)];
        draw.PathLineTo(at(static_cast<float>(i) + p.x, static_cast<float>(j) + p.y));
    }
    draw.PathFillConvex(colour);
}

// Calls per_piece(i, j, piece) for each square that the outline crosses, per_run(first, last, j) for the rest.
template <class PerPiece, class PerRun>
void for_each_part(const Mask& mask, const PerPiece& per_piece, const PerRun& per_run) {
    for (int j = 0; j + 1 < mask.n_y; ++j) {
        int began = -1;
        for (int i = 0; i + 1 < mask.n_x; ++i) {
            const Piece piece = piece_of(mask, i, j);
            const bool whole = piece.count == 4 && piece.edge_count == 0;
            if (whole && began < 0) began = i;
            if (whole) continue;
            if (began >= 0) per_run(began, i - 1, j);
            began = -1;
            if (piece.count > 0) per_piece(i, j, piece);
        }
        if (began >= 0) per_run(began, mask.n_x - 2, j);
    }
}

void hatch_untouched(const OnTissue& at, const Mask& touched, float mm, ImDrawList& draw) {
    for (int j = 0; j + 1 < touched.n_y; ++j) {
        for (int i = 0; i + 1 < touched.n_x; ++i) {
            if ((i + touched.n_y - j) % 5 != 0 || touched.at(i, j) > 0.1f || touched.at(i + 1, j + 1) > 0.1f) continue;
            const auto x = static_cast<float>(i);
            const auto y = static_cast<float>(j);
            draw.AddLine(at(x, y), at(x + 1.0f, y + 1.0f), kHatch, 0.3f * mm);
        }
    }
}

}  // namespace

void draw_coverage(const render::TissueView& view, const study::Coverage& coverage, float mm, ImDrawList& draw) {
    const OnTissue at{view, coverage};
    const ImDrawListFlags flags = draw.Flags;
    for (int level = 1; level < study::kPalpationLevels; ++level) {
        const Mask mask = mask_of(coverage, static_cast<study::PalpationLevel>(level));
        if (level == 1) hatch_untouched(at, mask, mm, draw);
        const ImU32 tint = kAreaTints[level - 1];
        draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // neighbours would show seams
        for_each_part(
            mask, [&](int i, int j, const Piece& piece) { fill_piece(at, piece, i, j, tint, draw); },
            [&](int first, int last, int j) { fill_run(at, first, last, j, tint, draw); });
        draw.Flags = flags;
        for_each_part(
            mask,
            [&](int i, int j, const Piece& piece) {
                for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(piece.edge_count); k += 2) {
                    const glm::vec2 from = glm::vec2(i, j) + piece.edge[k];
                    const glm::vec2 to = glm::vec2(i, j) + piece.edge[k + 1];
                    draw.AddLine(at(from.x, from.y), at(to.x, to.y), kDark, 0.35f * mm);
                }
            },
            [](int, int, int) {});
    }
}

}  // namespace palpa::app
