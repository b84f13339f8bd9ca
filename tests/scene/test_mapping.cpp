#include <Eigen/LU>
#include <doctest/doctest.h>

#include "scene/mapping.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

const TissueArea kArea{{0.06, 0.05}, {0.12, 0.10}};

}  // namespace

TEST_CASE("mapping: direct mapping draws a point where the pen that means it is, for all eight turns") {
    for (const int deg : {0, 90, 180, 270}) {
        for (const bool flip : {false, true}) {
            Mapping mapping;
            mapping.rotate_deg = deg;
            mapping.flip = flip;
            const View view = make_view(mapping, kArea, {1280, 800});
            for (const Eigen::Vector2d& px : {Eigen::Vector2d(640, 400), {300, 120}, {900.5, 777}}) {
                CAPTURE(deg);
                CAPTURE(flip);
                CHECK((px_of_tissue(view, tissue_of_px(view, px)) - px).norm() < 1e-9);
            }
            CHECK((tissue_of_px(view, {640, 400}) - kArea.centre_m).norm() < 1e-15);
            CHECK(std::abs(view.axes.determinant()) == close_to(1.0));
        }
    }
}

TEST_CASE("mapping: x to the right, y upwards; turned counter-clockwise; flipped before it is turned") {
    const auto right_of_centre = [](int deg, bool flip) {
        Mapping mapping;
        mapping.rotate_deg = deg;
        mapping.flip = flip;
        const View view = make_view(mapping, kArea, {1000, 1000});
        const Eigen::Vector2d d = px_of_tissue(view, kArea.centre_m + Eigen::Vector2d(0.01, 0.0)) - view.centre_px;
        return Eigen::Vector2d(d / view.px_per_m / 0.01);
    };
    CHECK((right_of_centre(0, false) - Eigen::Vector2d(1, 0)).norm() < 1e-12);
    CHECK((right_of_centre(90, false) - Eigen::Vector2d(0, -1)).norm() < 1e-12);  // up on the screen
    CHECK((right_of_centre(0, true) - Eigen::Vector2d(-1, 0)).norm() < 1e-12);
    CHECK((right_of_centre(90, true) - Eigen::Vector2d(0, 1)).norm() < 1e-12);
    const View view = make_view({}, kArea, {1000, 1000});
    CHECK(px_of_tissue(view, kArea.centre_m + Eigen::Vector2d(0.0, 0.01)).y() < 500.0);
}

TEST_CASE("mapping: indirect stretches the whole pad over the tissue") {
    Mapping mapping;
    mapping.kind = MappingKind::indirect;
    const View view = make_view(mapping, kArea, {1280, 800});
    CHECK((tissue_of_px(view, {0, 800}) - Eigen::Vector2d(0.0, 0.0)).norm() < 1e-12);
    CHECK((tissue_of_px(view, {1280, 0}) - Eigen::Vector2d(0.12, 0.10)).norm() < 1e-12);
    CHECK(on_tissue(view, {0.0001, 0.0001}));
    CHECK_FALSE(on_tissue(view, {-0.0001, 0.0}));
}

TEST_CASE("mapping: the tissue fits onto any screen") {
    for (const Eigen::Vector2d& screen : {Eigen::Vector2d(1280, 800), {800, 1280}, {200, 100}, {2560, 1600}}) {
        for (const int deg : {0, 90}) {
            Mapping mapping;
            mapping.rotate_deg = deg;
            const View view = make_view(mapping, kArea, {screen.x(), screen.y()});
            for (const double sx : {-0.5, 0.5}) {
                for (const double sy : {-0.5, 0.5}) {
                    const Eigen::Vector2d corner = kArea.centre_m + Eigen::Vector2d(sx, sy).cwiseProduct(kArea.size_m);
                    const Eigen::Vector2d px = px_of_tissue(view, corner);
                    CHECK(px.minCoeff() >= 0.0);
                    CHECK(px.x() <= screen.x());
                    CHECK(px.y() <= screen.y());
                }
            }
        }
    }
}

TEST_CASE("mapping: direct mapping is true to size where the screen's scale is known, unless that does not fit") {
    constexpr double kScale_px_per_m = 3780.0;  // 96 per inch
    const ScreenArea known{1000, 700, 236, 0, kScale_px_per_m};
    const View view = make_view({}, kArea, known);
    CHECK(view.px_per_m == close_to(kScale_px_per_m));
    CHECK(view.scale == close_to(1.0));
    CHECK((tissue_of_px(view, {236 + 500, 350}) - kArea.centre_m).norm() < 1e-12);

    const View small = make_view({}, kArea, {300, 300, 0, 0, kScale_px_per_m});
    CHECK(small.scale == close_to(0.94 * 300 / 0.12 / kScale_px_per_m));
    Mapping fitted;
    fitted.true_size = false;
    CHECK(make_view(fitted, kArea, known).px_per_m == close_to(0.94 * 700 / 0.10));
    CHECK(std::isnan(make_view({}, kArea, {1000, 700}).scale));
}

TEST_CASE("mapping: every corner of the area that input has is on the tissue, and a little beyond it is not") {
    for (const MappingKind kind : {MappingKind::direct, MappingKind::indirect}) {
        for (int turn = 0; turn < 8; ++turn) {
            Mapping mapping;
            mapping.kind = kind;
            mapping.rotate_deg = 90 * (turn % 4);
            mapping.flip = turn >= 4;
            const ScreenArea screen{1013.7, 799.3, 241.9, 1.3};
            const View view = make_view(mapping, kArea, screen);
            const ScreenArea a = input_area(view, screen);
            for (int corner = 0; corner < 4; ++corner) {
                const Eigen::Vector2d side(corner % 2, corner / 2);
                const Eigen::Vector2d px =
                    Eigen::Vector2d(a.x_px, a.y_px) + side.cwiseProduct(Eigen::Vector2d(a.width_px, a.height_px));
                CHECK(on_tissue(view, tissue_of_px(view, px)));
                CHECK_FALSE(on_tissue(view, tissue_of_px(view, px + 0.01 * (2.0 * side - Eigen::Vector2d::Ones()))));
            }
        }
    }
}
