// The picture of the tissue, off screen.

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <vector>

#include "platform/window.h"
#include "render/gl.h"
#include "render/tissue.h"
#include "tests/close_to.h"
#include "tests/off_screen.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::render;
using namespace palpa::test;

namespace {

constexpr int kWidth_px = 640;
constexpr int kHeight_px = 400;

// A dent 6 mm deep, wide enough to be seen, in the middle of a block of 60 mm.
TissuePicture pressed(float tilt_rad) {
    TissuePicture picture;
    TissueView& view = picture.view;
    view.area_px = {kWidth_px, kHeight_px};
    view.centre_px = {320.0f, 200.0f};
    view.size_m = {0.06f, 0.06f};
    view.axes = glm::mat2(1.0f, 0.0f, 0.0f, -1.0f);
    view.px_per_m = 6000.0f;
    view.tilt_rad = tilt_rad;
    if (tilt_rad == 0.0f) {
        view.eye_m = {0.004f, -0.003f};
        view.eye_per_m = 1.0f / 0.045f;
    }
    picture.grip.centre_m = {0.004f, -0.003f};
    picture.grip.contact_radius_m = 3.6e-3f;
    picture.grip.depth_m = 6e-3f;
    picture.grip.pull = 0.24f;
    picture.grip.pressure = 0.6f;
    picture.dent.centre_m = picture.grip.centre_m;
    picture.dent.reach_m = 0.03f;
    for (int i = 0; i < kSinkPoints; ++i) {
        const float r_m = 0.03f * static_cast<float>(i * i) / 3969.0f;
        picture.dent.sink_m[static_cast<std::size_t>(i)] = 6e-3f * std::exp(-(r_m * r_m) / (0.008f * 0.008f));
    }
    return picture;
}

struct Drawing {
    Window window{off_screen()};
    TissueDrawer tissue;
    std::vector<unsigned char> of(const TissuePicture& picture) {
        tissue.draw(picture, false);
        return read_pixels(kWidth_px, kHeight_px);
    }
};

int brightest_near(const std::vector<unsigned char>& rgb, const glm::vec2& at_px, int reach_px) {
    int best = 0;
    for (int y = static_cast<int>(at_px.y) - reach_px; y <= static_cast<int>(at_px.y) + reach_px; ++y) {
        for (int x = static_cast<int>(at_px.x) - reach_px; x <= static_cast<int>(at_px.x) + reach_px; ++x) {
            const unsigned char* p = &rgb[3 * static_cast<std::size_t>(y * kWidth_px + x)];
            best = std::max(best, static_cast<int>(std::min({p[0], p[1], p[2]})));
        }
    }
    return best;
}

// Mean difference between two patches of 13 x 13 px.
double difference(const std::vector<unsigned char>& a, const glm::vec2& a_px, const std::vector<unsigned char>& b,
                  const glm::vec2& b_px) {
    const auto at = [](const glm::vec2& px, int dx, int dy) {
        const int x = static_cast<int>(std::round(px.x)) + dx;
        const int y = static_cast<int>(std::round(px.y)) + dy;
        return 3 * static_cast<std::size_t>(y * kWidth_px + x);
    };
    double sum = 0.0;
    for (int y = -6; y <= 6; ++y) {
        for (int x = -6; x <= 6; ++x) sum += std::abs(a[at(a_px, x, y)] - b[at(b_px, x, y)]);
    }
    return sum / 169.0;
}

}  // namespace

TEST_CASE("tissue: what is straight below the eye, or on the undisturbed surface, stays where it is") {
    const TissueView view = pressed(0.0f).view;
    TissueView flat = view;
    flat.eye_per_m = 0.0f;
    for (const float height_m : {-0.02f, -0.007f, 0.0f, 0.004f}) {
        const glm::vec2 px = project_px(view, {view.eye_m, height_m});
        const glm::vec2 expected_px = project_px(flat, {view.eye_m, 0.0f});
        CHECK(px.x == close_to(expected_px.x));
        CHECK(px.y == close_to(expected_px.y));
    }
    for (const glm::vec2 p_m : {glm::vec2(-0.02f, 0.01f), glm::vec2(0.025f, -0.01f)}) {
        CHECK(project_px(view, {p_m, 0.0f}).x == close_to(project_px(flat, {p_m, 0.0f}).x));
        // deeper is farther away, so it looks nearer to the place below the eye
        const glm::vec2 eye_px = project_px(view, {view.eye_m, 0.0f});
        const float deep_px = std::abs(project_px(view, {p_m, -0.01f}).x - eye_px.x);
        CHECK(deep_px < std::abs(project_px(view, {p_m, 0.0f}).x - eye_px.x) - 5.0f);
    }
}

TEST_CASE("tissue: the drawn surface is displaced as displaced_m() says, seen from above and tilted") {
    for (const float tilt_rad : {0.0f, 0.52f}) {
        CAPTURE(tilt_rad);
        Drawing drawing;
        TissuePicture picture = pressed(tilt_rad);
        const auto without = drawing.of(picture);
        picture.grip.footprint_m = 9e-3f;
        const auto with = drawing.of(picture);
        int moved = 0;
        for (int i = 0; i < 24; ++i) {
            const float angle = 6.2831853f * static_cast<float>(i) / 24.0f;
            const glm::vec2 p_m = picture.grip.centre_m + 9e-3f * glm::vec2(std::cos(angle), std::sin(angle));
            const glm::vec2 px = project_px(picture.view, displaced_m(picture, p_m));
            CAPTURE(i);
            CHECK(brightest_near(with, px, 1) > 200);  // the ring's light core
            CHECK(brightest_near(without, px, 1) < 190);
            const glm::vec2 flat_px = project_px(picture.view, {p_m, 0.0f});
            if (glm::distance(px, flat_px) > 4.0f) ++moved;
        }
        CHECK(moved > 12);
    }
}

TEST_CASE("tissue: what is drawn on the texture is dragged along with it by a finger") {
    Drawing drawing;
    TissuePicture picture = pressed(0.0f);
    picture.dent = {};
    picture.grip = {};
    const auto before = drawing.of(picture);
    picture.view.drag_at_m = {0.004f, -0.003f};
    picture.view.drag_m = {3e-3f, 2e-3f};
    const auto after = drawing.of(picture);
    CHECK(dragged_m(picture.view, {0.5f, 0.5f}) == glm::vec2(0.5f, 0.5f));
    for (const glm::vec2 p_m : {glm::vec2(0.004f, -0.003f), glm::vec2(-0.002f, 0.001f)}) {
        const glm::vec2 was_px = project_px(picture.view, {p_m, 0.0f});
        const glm::vec2 is_px = project_px(picture.view, {dragged_m(picture.view, p_m), 0.0f});
        CHECK(difference(before, was_px, after, is_px) < 0.6 * difference(before, was_px, after, was_px));
    }
}

TEST_CASE("tissue: the near rim of a dent covers the indenter where the tissue is tilted") {
    Drawing drawing;
    TissuePicture picture = pressed(0.52f);
    picture.indenter.centre_m = picture.grip.centre_m;
    picture.indenter.radius_m = 4e-3f;
    const auto steel_below_centre = [&](float depth_m) {
        for (int i = 0; i < kSinkPoints; ++i) {  // steeper than the line of sight when it is deep
            const float r_m = 0.03f * static_cast<float>(i * i) / 3969.0f;
            picture.dent.sink_m[static_cast<std::size_t>(i)] = depth_m * std::exp(-(r_m * r_m) / (5e-3f * 5e-3f));
        }
        picture.grip.depth_m = depth_m;
        picture.indenter.height_m = picture.indenter.radius_m - depth_m;
        const auto rgb = drawing.of(picture);
        const glm::vec2 centre_px = project_px(picture.view, {picture.indenter.centre_m, picture.indenter.height_m});
        int steel = 0;  // steel is not reddish, tissue is
        for (int y = static_cast<int>(centre_px.y); y < static_cast<int>(centre_px.y) + 24; ++y) {
            const unsigned char* p = &rgb[3 * static_cast<std::size_t>(y * kWidth_px + static_cast<int>(centre_px.x))];
            if (p[0] < p[2] + 12) ++steel;
        }
        return steel;
    };
    const int deep = steel_below_centre(11e-3f);
    const int shallow = steel_below_centre(1e-3f);
    CAPTURE(deep);
    CHECK(shallow >= 20);
    CHECK(deep < shallow - 4);
}

TEST_CASE("tissue: nodes and a curve of the same surface look the same") {
    Drawing drawing;
    TissuePicture picture = pressed(0.0f);
    const auto curve = drawing.of(picture);
    TissuePicture nodes = picture;
    nodes.dent = {};
    constexpr int kNodes = 61;
    nodes.relief.n_x = nodes.relief.n_y = kNodes;
    for (int j = 0; j < kNodes; ++j) {
        for (int i = 0; i < kNodes; ++i) {
            const glm::vec2 p_m = 1e-3f * (glm::vec2(i, j) - 30.0f);
            const float r_m = glm::distance(p_m, picture.dent.centre_m);
            nodes.relief.sink_m.push_back(6e-3f * std::exp(-(r_m * r_m) / (0.008f * 0.008f)));
        }
    }
    const auto grid = drawing.of(nodes);
    double difference = 0.0;
    for (std::size_t i = 0; i < curve.size(); ++i) difference += std::abs(static_cast<double>(curve[i]) - grid[i]);
    CHECK(difference / static_cast<double>(curve.size()) < 0.6);  // of 255; the curve has 64 points only
    CHECK(drawing.of(picture) == curve);
}
