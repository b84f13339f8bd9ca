#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

#include "mechanics/bellows.h"
#include "mechanics/error.h"
#include "mechanics/mesh_check.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

TEST_CASE("bellows: the counts of the paper's accordion, each within 3 %") {
    Bellows shape;
    shape.plate_cells = 3;
    const BellowsMesh made = bellows(shape);
    const Mesh tets = split_columns_to_tets(made.mesh);
    CHECK(std::abs(static_cast<double>(tets.nodes_m.cols()) / 858.0 - 1.0) < 0.03);
    CHECK(std::abs(static_cast<double>(tets.cells.cols()) / 2743.0 - 1.0) < 0.03);
}

TEST_CASE("bellows: cells have volume, neighbours match, and the tetrahedra fill the hexahedra") {
    for (const int rings : {0, 1, 3}) {
        CAPTURE(rings);
        Bellows shape;
        shape.rings = rings;
        shape.through = 2;
        const BellowsMesh made = bellows(shape);
        const MeshReport hexes = check_mesh(made.mesh);
        const Mesh split = split_columns_to_tets(made.mesh);
        const MeshReport tets = check_mesh(split);
        CHECK(tets.volume_m3 == close_to(hexes.volume_m3).epsilon(2e-3));
        // a face between cells that do not match would be an outer one
        CHECK(boundary_faces(split).cell.size() == 2 * boundary_faces(made.mesh).cell.size());
        CHECK(parts_of(split).count == 1);
    }
}

TEST_CASE("bellows: a straight wall has the volume of a tube and a disc") {
    Bellows shape;
    shape.amplitude_m = 0.0;
    shape.sectors = 64;
    const double wall = std::numbers::pi * (0.024 * 0.024 - 0.022 * 0.022) * 0.06;
    const double plate = std::numbers::pi * 0.024 * 0.024 * 0.004;
    CHECK(check_mesh(bellows(shape).mesh).volume_m3 == close_to(wall + plate).epsilon(2e-3));
}

TEST_CASE("bellows: sizes that cannot be are refused") {
    for (const auto& spoil :
         {+[](Bellows& b) { b.sectors = 18; }, +[](Bellows& b) { b.wall_m = 0.03; },
          +[](Bellows& b) { b.radius_m = 0.004; }, +[](Bellows& b) { b.height_m = std::nan(""); }}) {
        Bellows shape;
        spoil(shape);
        CHECK_THROWS_AS(bellows(shape), MeshError);
    }
}
