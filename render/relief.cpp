#include "render/relief.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpa::render {
namespace {

// Catmull-Rom weights of the four neighbours of a place between the middle two, and their derivatives.
struct Weights {
    int first = 0;
    float value[4];
    float slope[4];
};

Weights weights_at(float at) {
    Weights w;
    const float low = std::floor(at);
    const float t = at - low;
    w.first = static_cast<int>(low) - 1;
    w.value[0] = 0.5f * (-t + 2.0f * t * t - t * t * t);
    w.value[1] = 0.5f * (2.0f - 5.0f * t * t + 3.0f * t * t * t);
    w.value[2] = 0.5f * (t + 4.0f * t * t - 3.0f * t * t * t);
    w.value[3] = 0.5f * (-t * t + t * t * t);
    w.slope[0] = 0.5f * (-1.0f + 4.0f * t - 3.0f * t * t);
    w.slope[1] = 0.5f * (-10.0f * t + 9.0f * t * t);
    w.slope[2] = 0.5f * (1.0f + 8.0f * t - 9.0f * t * t);
    w.slope[3] = 0.5f * (-2.0f * t + 3.0f * t * t);
    return w;
}

// The weights at vertex i of an axis whose nodes are spacing_m apart. The first and the last vertex are on the border too.
Weights weights_of_vertex(std::size_t i, int cells, float focus, float size_m, float shift_m, float spacing_m) {
    const int on_tissue = std::clamp(static_cast<int>(i) - 1, 0, cells);
    const float u = crowded(static_cast<float>(on_tissue) / static_cast<float>(cells), focus);
    return weights_at((u * size_m - shift_m) / spacing_m);
}

}  // namespace

float crowded(float u, float focus) {
    constexpr float kAtFocus = 0.22f;
    const float side_m = u < focus ? focus : 1.0f - focus;
    const float t = side_m > 0.0f ? std::abs(u - focus) / side_m : 0.0f;
    const float moved = side_m * t * (kAtFocus + (1.0f - kAtFocus) * t * t);
    return u < focus ? focus - moved : focus + moved;
}

glm::vec2 focus_of(const TissuePicture& picture) {
    const TissueView& view = picture.view;
    const glm::vec2 at = (picture.grip.centre_m - view.centre_m) / view.size_m + 0.5f;
    return {std::clamp(at.x, 0.0f, 1.0f), std::clamp(at.y, 0.0f, 1.0f)};
}

void refine(const Relief& relief, const glm::vec2& size_m, int cells, const glm::vec2& focus, std::vector<float>& rows,
            std::vector<float>& out) {
    const auto n = static_cast<std::size_t>(cells) + 3;
    const float dx_m = size_m.x / static_cast<float>(relief.n_x - 1);
    const float dy_m = size_m.y / static_cast<float>(relief.n_y - 1);
    // along x first: value and slope of every row at the n places
    rows.resize(2 * n * static_cast<std::size_t>(relief.n_y));
    for (std::size_t i = 0; i < n; ++i) {
        const Weights w = weights_of_vertex(i, cells, focus.x, size_m.x, relief.shift_m.x, dx_m);
        for (int j = 0; j < relief.n_y; ++j) {
            float value = 0.0f;
            float slope = 0.0f;
            for (int k = 0; k < 4; ++k) {
                const int x = std::clamp(w.first + k, 0, relief.n_x - 1);
                const float sink = relief.sink_m[static_cast<std::size_t>(j * relief.n_x + x)];
                value += w.value[k] * sink;
                slope += w.slope[k] * sink;
            }
            const std::size_t at = 2 * (static_cast<std::size_t>(j) * n + i);
            rows[at] = value;
            rows[at + 1] = slope / dx_m;
        }
    }
    out.resize(3 * n * n);
    for (std::size_t j = 0; j < n; ++j) {
        const Weights w = weights_of_vertex(j, cells, focus.y, size_m.y, relief.shift_m.y, dy_m);
        for (std::size_t i = 0; i < n; ++i) {
            float* vertex = &out[3 * (j * n + i)];
            vertex[0] = vertex[1] = vertex[2] = 0.0f;
            for (int k = 0; k < 4; ++k) {
                const int y = std::clamp(w.first + k, 0, relief.n_y - 1);
                const float* row = &rows[2 * (static_cast<std::size_t>(y) * n + i)];
                vertex[0] += w.value[k] * row[0];
                vertex[1] += w.value[k] * row[1];
                vertex[2] += w.slope[k] * row[0] / dy_m;
            }
        }
    }
}

float sink_m(const Dent& dent, const glm::vec2& p_m) {
    const float r_m = glm::length(p_m - dent.centre_m);
    if (!(r_m < dent.reach_m)) return 0.0f;
    const float at = static_cast<float>(kSinkPoints - 1) * std::sqrt(r_m / dent.reach_m);
    const auto below = static_cast<std::size_t>(at);
    const float next = below + 1 < dent.sink_m.size() ? dent.sink_m[below + 1] : 0.0f;
    return dent.sink_m[below] + (at - static_cast<float>(below)) * (next - dent.sink_m[below]);
}

float sink_m(const Relief& relief, const TissueView& view, const glm::vec2& p_m) {
    if (relief.n_x < 2 || relief.n_y < 2) return 0.0f;
    const glm::vec2 unit = (p_m - relief.shift_m - view.centre_m) / view.size_m + 0.5f;
    const float x = std::clamp(unit.x, 0.0f, 1.0f) * static_cast<float>(relief.n_x - 1);
    const float y = std::clamp(unit.y, 0.0f, 1.0f) * static_cast<float>(relief.n_y - 1);
    const int i = std::min(static_cast<int>(x), relief.n_x - 2);
    const int j = std::min(static_cast<int>(y), relief.n_y - 2);
    const auto at = [&](int column, int row) {
        return relief.sink_m[static_cast<std::size_t>(row * relief.n_x + column)];
    };
    const float s = x - static_cast<float>(i);
    const float low = at(i, j) + s * (at(i + 1, j) - at(i, j));
    const float high = at(i, j + 1) + s * (at(i + 1, j + 1) - at(i, j + 1));
    return low + (y - static_cast<float>(j)) * (high - low);
}

}  // namespace palpa::render
