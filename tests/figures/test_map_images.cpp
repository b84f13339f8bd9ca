#include <cmath>
#include <doctest/doctest.h>

#include "figures/map_images.h"
#include "tests/stiffnessmaps/test_maps.h"

using namespace palpa;
using namespace palpa::figures;
using namespace palpa::test;

TEST_CASE("map images: the depth at a force says that cells are hatched where it is not reached") {
    const stiffnessmaps::Map map =
        map_of(5, 4, {1e-3, 2e-3}, [](double x, double, double d) { return 500.0 * d * (1.0 + 100.0 * x); });
    const stiffnessmaps::Field field = stiffnessmaps::make_field(map, {});
    CHECK(depth_image(map, field, 0.5).title == "Depth at 0.5 N");
    const Image beyond = depth_image(map, field, 1.05);  // more than at the first column's greatest depth
    CHECK(std::isnan(beyond.values.front()));
    CHECK(beyond.title == "Depth at 1.05 N (hatched: not reached or measured)");
}
