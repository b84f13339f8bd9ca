#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "mechanics/error.h"
#include "tactile/renderer.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"
#include "tests/tactile/finger_block.h"

using namespace palpa;
using namespace palpa::tactile;
using namespace palpa::test;
using Eigen::Vector2d;

namespace {

Finger finger_of(FingerContact contact) { return {contact, 16e-3, {}}; }

Observation pins_with_sheet() {
    mechanics::PinShapeOptions options;
    options.sheet = mechanics::Sheet::free;
    return observation_of(mechanics::make_pin_shape({}, options));
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("renderer: stiffness_scale multiplies the tissue's force at every depth, for each contact") {
    const scene::LinearTissue& tissue = finger_block().tissue;
    for (const FingerContact contact : {FingerContact::parabola, FingerContact::rigid}) {
        const Renderer plain = make_renderer(tissue, finger_of(contact), 1.0, 50.0);
        const Renderer stiff = make_renderer(tissue, finger_of(contact), 3.0, 50.0);
        RendererWork of_plain = make_work(plain);
        RendererWork of_stiff = make_work(stiff);
        const double plain_N = press_to_depth(plain, {0.03, 0.03}, 2e-3, of_plain).force_N;
        CHECK(press_to_depth(stiff, {0.03, 0.03}, 2e-3, of_stiff).force_N == close_to(3.0 * plain_N));
        CHECK(press_with_force(stiff, {0.03, 0.03}, 3.0 * plain_N, of_stiff).depth_m == close_to(2e-3).epsilon(1e-6));
    }
}

TEST_CASE("renderer: above the force limit force, depth and shape hold") {
    const scene::LinearTissue& tissue = finger_block().tissue;
    for (const double scale : {1.0, 2.5}) {
        const Renderer renderer =
            make_renderer(tissue, finger_of(FingerContact::parabola), scale, 1.2, pins_with_sheet());
        RendererWork work = make_work(renderer);
        const Press at_limit = press_with_force(renderer, {0.03, 0.03}, 1.2, work);
        CHECK_FALSE(at_limit.capped);
        Eigen::VectorXd there_m(36), beyond_m(36);
        shape_m(renderer, work, there_m);
        const Press beyond = press_to_depth(renderer, {0.03, 0.03}, 2.0 * at_limit.depth_m, work);
        shape_m(renderer, work, beyond_m);
        CHECK(beyond.capped);
        CHECK(beyond.force_N == close_to(1.2));
        CHECK(beyond.depth_m == close_to(at_limit.depth_m));
        CHECK((there_m - beyond_m).cwiseAbs().maxCoeff() < 1e-12);
    }
}

TEST_CASE("renderer: above the surface there is no force and no shape") {
    const Renderer renderer =
        make_renderer(finger_block().tissue, finger_of(FingerContact::parabola), 1.0, 2.5, pins_with_sheet());
    RendererWork work = make_work(renderer);
    press_to_depth(renderer, {0.03, 0.03}, 2e-3, work);
    Eigen::VectorXd sink_m(36);
    for (const double depth_m : {0.0, -1e-9, -5e-3}) {
        CHECK(press_to_depth(renderer, {0.03, 0.03}, depth_m, work).force_N == 0.0);
        shape_m(renderer, work, sink_m);
        CHECK(sink_m.isZero());
    }
}

TEST_CASE("renderer: the observed sinks are those of the surface under the pins") {
    const mechanics::PinShape shape = mechanics::make_pin_shape({}, {});
    const Renderer renderer =
        make_renderer(finger_block().tissue, finger_of(FingerContact::parabola), 1.0, 2.5, observation_of(shape));
    RendererWork work = make_work(renderer);
    press_to_depth(renderer, {0.031, 0.028}, 2e-3, work);
    Eigen::VectorXd sink_m(36), surface(36);
    shape_m(renderer, work, sink_m);
    surface_m(renderer, work, shape.pin_m, surface);
    CHECK((sink_m - surface).isZero());
    CHECK(sink_m.minCoeff() > 0.0);
    pressure_Pa(renderer, work, shape.pin_m, surface);
    // half the pressure of the parabola's middle is its mean
    CHECK(surface.maxCoeff() == close_to(2.0 * work.last.force_N / (3.14159265 * 64e-6)).epsilon(0.1));
}

TEST_CASE("renderer: NaN anywhere holds the last answer") {
    const Renderer renderer = make_renderer(finger_block().tissue, finger_of(FingerContact::rigid), 1.0, 2.5);
    RendererWork work = make_work(renderer);
    const Press good = press_to_depth(renderer, {0.03, 0.03}, 1e-3, work);
    for (const Press& press :
         {press_to_depth(renderer, {kNan, 0.03}, 1e-3, work), press_to_depth(renderer, {0.03, 0.03}, kNan, work),
          press_with_force(renderer, {0.03, 0.03}, kNan, work), press_with_force(renderer, {0.03, kNan}, 1.0, work)}) {
        CHECK(press.held);
        CHECK(press.force_N == good.force_N);
    }
    CHECK_FALSE(press_to_depth(renderer, {0.03, 0.03}, 1e-3, work).held);
}

TEST_CASE("renderer: a force curve answers depth with force and force with depth, without a surface") {
    const Renderer renderer = make_renderer({{1e-3, 2e-3, 3e-3}, {0.1, 0.4, 2.0}}, 2.0, 3.0);
    RendererWork work = make_work(renderer);
    CHECK(press_to_depth(renderer, {0.0, 0.0}, 0.5e-3, work).force_N == close_to(0.1));
    CHECK(press_to_depth(renderer, {0.0, 0.0}, 1.5e-3, work).force_N == close_to(0.5));
    CHECK(press_with_force(renderer, {0.0, 0.0}, 0.5, work).depth_m == close_to(1.5e-3));
    const Press held = press_to_depth(renderer, {0.0, 0.0}, 2.9e-3, work);  // 3.68 N
    CHECK(held.capped);
    CHECK(held.force_N == close_to(3.0));
    CHECK(press_to_depth(renderer, {0.0, 0.0}, 1.0, work).capped);
    CHECK(press_to_depth(renderer, {0.0, 0.0}, 0.0, work).force_N == 0.0);
    CHECK(press_to_depth(renderer, {0.0, 0.0}, kNan, work).held);
    Eigen::VectorXd sink_m = Eigen::VectorXd::Ones(4);
    shape_m(renderer, work, sink_m);
    CHECK(sink_m.isZero());
    // a last point below the limit is the end too
    const Renderer short_curve = make_renderer({{1e-3}, {0.1}}, 1.0, 3.0);
    RendererWork of_short = make_work(short_curve);
    const Press end = press_to_depth(short_curve, {0.0, 0.0}, 5e-3, of_short);
    CHECK(end.capped);
    CHECK(end.force_N == close_to(0.1));
    CHECK(end.depth_m == close_to(1e-3));

    CHECK_THROWS_AS(make_renderer({{1e-3, 1e-3}, {0.1, 0.2}}, 1.0, 1.0), mechanics::LoadError);
    CHECK_THROWS_AS(make_renderer({{1e-3}, {}}, 1.0, 1.0), mechanics::LoadError);
    CHECK_THROWS_AS(make_renderer(DepthForce{}, 1.0, 1.0), mechanics::LoadError);
    CHECK_THROWS_AS(make_renderer({{kNan}, {1.0}}, 1.0, 1.0), mechanics::LoadError);
    CHECK_THROWS_AS(make_renderer({{1e-3}, {0.1}}, 0.0, 1.0), mechanics::LoadError);
}

TEST_CASE("renderer: live it allocates nothing") {
    for (const FingerContact contact : {FingerContact::parabola, FingerContact::rigid, FingerContact::pad}) {
        const Renderer renderer = make_renderer(finger_block().tissue, finger_of(contact), 1.0, 2.5, pins_with_sheet());
        RendererWork work = make_work(renderer);
        Eigen::VectorXd sink_m(36);
        const long before = allocation_count();
        for (int k = 0; k < 30; ++k) {
            press_to_depth(renderer, {0.02 + 0.0007 * k, 0.03}, 1e-4 * k, work);
            shape_m(renderer, work, sink_m);
            press_with_force(renderer, {0.02 + 0.0007 * k, 0.03}, 0.05 * k, work);
        }
        CHECK(allocation_count() == before);
    }
}
