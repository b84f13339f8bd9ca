#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <utility>

#include "app/screens/layout.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::app;
using namespace palpa::test;

TEST_CASE("layout: controls and tissue share the window without overlapping, whatever its size") {
    for (const bool left_handed : {false, true}) {
        for (float width = 60.0f; width < 4000.0f; width *= 1.3f) {
            for (float height = 60.0f; height < 4000.0f; height *= 1.3f) {
                CAPTURE(width);
                CAPTURE(height);
                const float mm = control_scale(std::numeric_limits<double>::quiet_NaN(), width, height);
                const Layout l = layout_of(width, height, mm, left_handed);
                CHECK(l.tissue_px.width() > 0.0f);
                CHECK(l.tissue_px.height() > 0.0f);
                CHECK(l.tissue_px.x1 <= width);
                CHECK(l.tissue_px.y1 <= height);
                if (!l.controls) continue;
                const bool apart = l.controls_px.x1 <= l.tissue_px.x0 || l.controls_px.x0 >= l.tissue_px.x1 ||
                                   l.controls_px.y1 <= l.tissue_px.y0;
                CHECK(apart);
                CHECK(std::min(l.tissue_px.width(), l.tissue_px.height()) >= 30.0f * mm - 0.01f);
                CHECK(l.controls_px.width() >= 5.0f * 9.0f * mm);  // five targets of 9 mm side by side
            }
        }
    }
}

TEST_CASE("layout: a screen's own scale, measured or told by the system, is used as far as the controls fit") {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    CHECK(control_scale(unknown, 2560.0f, 1600.0f, 12.6) == close_to(12.6));
    CHECK(control_scale(unknown, 1600.0f, 2560.0f, 12.6) == close_to(12.6));
    const float small = control_scale(unknown, 1170.0f, 2532.0f, 18.9);  // a telephone
    CHECK(small < 18.0f);
    CHECK(layout_of(1170.0f, 2532.0f, small, false).controls);
    CHECK(control_scale(8.0, 1170.0f, 2532.0f, 18.9) == close_to(8.0));
    // a screen of 7" turned either way, and a measurement that went wrong: a person without a keyboard can still undo it
    for (const auto& [width, height, scale] :
         {std::tuple{1024.0f, 600.0f, 6.63}, {600.0f, 1024.0f, 7.5}, {800.0f, 480.0f, 20.0}}) {
        const float fits = control_scale(scale, width, height);
        CAPTURE(fits);
        CHECK(fits < scale);
        CHECK(layout_of(width, height, fits, false).controls);
    }
}

TEST_CASE("layout: a window as small as a phone's has its controls above a tissue as wide as itself") {
    const float mm = control_scale(std::numeric_limits<double>::quiet_NaN(), 360.0f, 640.0f);
    const Layout small = layout_of(360.0f, 640.0f, mm, false);
    CHECK(small.controls);
    CHECK_FALSE(small.column);
    CHECK(small.tissue_px.width() == 360.0f);
    CHECK(small.tissue_px.height() > 300.0f);
}

TEST_CASE("layout: a column beside the tissue away from the hand, a strip above it on an upright window") {
    const Layout right = layout_of(1280, 800, 3.78f, false);
    CHECK(right.column);
    CHECK(right.controls_px.x0 == 0.0f);
    CHECK(layout_of(1280, 800, 3.78f, true).controls_px.x1 == 1280.0f);
    const Layout upright = layout_of(800, 1280, 3.78f, false);
    CHECK_FALSE(upright.column);
    CHECK(upright.tissue_px.height() >= 0.99f * upright.tissue_px.width());
    CHECK_FALSE(layout_of(200, 100, 3.78f, false).controls);
}

TEST_CASE("layout: below the tissue is room for a finger that indents what lies above it") {
    for (const auto& [width, height] : {std::pair{1280.0f, 800.0f}, std::pair{800.0f, 1280.0f}}) {
        const Layout under = layout_of(width, height, 3.78f, false);
        const Layout above = layout_of(width, height, 3.78f, false, true);
        CHECK(above.tissue_px.y1 == close_to(under.tissue_px.y1 - 15.0f * 3.78f));
        CHECK(above.tissue_px.y0 == under.tissue_px.y0);
    }
}
