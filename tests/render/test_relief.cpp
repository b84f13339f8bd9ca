#include <cmath>
#include <doctest/doctest.h>
#include <vector>

#include "render/relief.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::render;
using namespace palpa::test;

TEST_CASE("relief: vertices crowd at the focus, in order, and the border and the focus stay") {
    for (const float focus : {0.0f, 0.1f, 0.5f, 0.97f, 1.0f}) {
        CAPTURE(focus);
        CHECK(crowded(0.0f, focus) == close_to(0.0));
        CHECK(crowded(1.0f, focus) == close_to(1.0));
        CHECK(crowded(focus, focus) == close_to(focus));
        float last = -1.0f;
        for (int i = 0; i <= 100; ++i) {
            const float u = crowded(0.01f * static_cast<float>(i), focus);
            CHECK(u > last);
            last = u;
        }
    }
    CHECK(crowded(0.51f, 0.5f) - 0.5f < 0.25f * 0.01f);
}

TEST_CASE("relief: a plane and its slopes are met at every vertex, also where vertices crowd") {
    Relief relief;
    relief.n_x = 7;
    relief.n_y = 5;
    const glm::vec2 size_m(0.12f, 0.08f);
    for (int j = 0; j < relief.n_y; ++j) {
        for (int i = 0; i < relief.n_x; ++i)
            relief.sink_m.push_back(1e-3f * static_cast<float>(i) + 3e-3f * static_cast<float>(j));
    }
    constexpr int kCells = 24;
    const glm::vec2 focus(0.3f, 0.6f);
    std::vector<float> rows;
    std::vector<float> out;
    refine(relief, size_m, kCells, focus, rows, out);
    REQUIRE(out.size() == 3u * (kCells + 3) * (kCells + 3));
    for (int j = 0; j < kCells + 3; ++j) {
        for (int i = 0; i < kCells + 3; ++i) {
            // the border's last cells bend, since the values go on unchanged beyond it
            const float u = crowded(static_cast<float>(i - 1) / kCells, focus.x);
            const float v = crowded(static_cast<float>(j - 1) / kCells, focus.y);
            if (u < 0.2f || u > 0.8f || v < 0.3f || v > 0.7f) continue;
            const float* vertex = &out[3 * static_cast<std::size_t>(j * (kCells + 3) + i)];
            CHECK(vertex[0] == close_to(6e-3f * u + 12e-3f * v).epsilon(1e-4));
            CHECK(vertex[1] == close_to(6e-3f / size_m.x).epsilon(1e-4));
            CHECK(vertex[2] == close_to(12e-3f / size_m.y).epsilon(1e-4));
        }
    }
}

TEST_CASE("relief: the sink at a place is that of the values around it") {
    Dent dent;
    dent.centre_m = {0.01f, 0.02f};
    dent.reach_m = 0.03f;
    for (int i = 0; i < kSinkPoints; ++i)
        dent.sink_m[static_cast<std::size_t>(i)] = 1e-3f * static_cast<float>(kSinkPoints - 1 - i);
    CHECK(sink_m(dent, {0.01f, 0.02f}) == close_to(63e-3));
    CHECK(sink_m(dent, {0.01f + 0.03f * 0.25f, 0.02f}) == close_to(31.5e-3));  // r_i, i = 31.5
    CHECK(sink_m(dent, {0.01f, 0.051f}) == 0.0f);

    Relief relief{2, 2, {0.0f, 1e-3f, 2e-3f, 3e-3f}, {0.0f, 0.0f}};
    TissueView view;
    view.centre_m = {0.05f, 0.05f};
    view.size_m = {0.1f, 0.1f};
    CHECK(sink_m(relief, view, {0.05f, 0.05f}) == close_to(1.5e-3));
    CHECK(sink_m(relief, view, {-1.0f, -1.0f}) == close_to(0.0));  // beside it as at its edge
    relief.shift_m = {0.05f, 0.0f};
    CHECK(sink_m(relief, view, {0.05f, 0.05f}) == close_to(1e-3));
}
