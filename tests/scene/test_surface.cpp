#include <doctest/doctest.h>

#include "scene/surface.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::scene;
using namespace palpa::test;

TEST_CASE("surface: nodes are read between them linearly, beside the grid as at its edge") {
    SurfaceShape shape;
    shape.n_x = 3;
    shape.n_y = 2;
    shape.spacing_m = {2e-3, 5e-3};
    shape.sink_m = Eigen::VectorXd::Zero(6);
    const auto plane_m = [](double x_m, double y_m) { return 1e-3 + 0.1 * x_m + 0.2 * y_m; };
    for (int node = 0; node < 6; ++node) shape.sink_m[node] = plane_m(2e-3 * (node % 3), 5e-3 * (node / 3));
    for (const double x_m : {0.0, 0.7e-3, 2e-3, 3.9e-3, 4e-3}) {
        for (const double y_m : {0.0, 1.1e-3, 5e-3}) {
            CHECK(sink_at_m(shape, {x_m, y_m}) == close_to(plane_m(x_m, y_m)).epsilon(1e-12));
        }
    }
    CHECK(sink_at_m(shape, {9e-3, 5e-3}) == shape.sink_m[5]);
    CHECK(sink_at_m(shape, {-1e-3, -1e-3}) == shape.sink_m[0]);
}

TEST_CASE("surface: a curve is the same all around its centre; without a surface nothing sinks") {
    SurfaceShape shape;
    CHECK(sink_at_m(shape, {0.0, 0.0}) == 0.0);
    shape.curve = avatar::surface_curve(2e-3, 4e-3, 25e-3);
    shape.centre_m = {0.03, 0.04};
    CHECK(sink_at_m(shape, shape.centre_m) == close_to(2e-3));
    const double beside_m = sink_at_m(shape, {0.035, 0.04});
    CHECK(beside_m == close_to(avatar::sink_at_m(*shape.curve, 0.005)));
    CHECK(beside_m > 0.0);
    CHECK(sink_at_m(shape, {0.03, 0.045}) == close_to(beside_m));
}
