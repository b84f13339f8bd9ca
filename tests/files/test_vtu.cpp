#include <cmath>
#include <cstdint>
#include <cstring>
#include <doctest/doctest.h>

#include "files/text.h"
#include "files/vtu.h"
#include "tests/files/vtu_reader.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

VtuGrid one_cube() {
    VtuGrid grid;
    for (int k = 0; k < 8; ++k) {
        grid.points.insert(grid.points.end(), {static_cast<double>(k % 4 == 1 || k % 4 == 2),
                                               static_cast<double>(k % 4 > 1), static_cast<double>(k > 3)});
        grid.cells.push_back(k);
    }
    grid.on_points = {{"displacement_mm", 3, std::vector<double>(24, 0.1)}};
    grid.on_points[0].values[5] = -1.0 / 3.0;
    grid.in_cells = {{"strain", 6, {1e-300, -2.0, 3.0, std::nan(""), 5.0, 6.0}}, {"material", 1, {2.0}}};
    return grid;
}

}  // namespace

TEST_CASE("vtu: an independent reader finds every array, to the last bit") {
    const VtuGrid grid = one_cube();
    const VtuRead read = read_vtu_text(vtu_text(grid));
    CHECK(read.points == 8);
    CHECK(read.cells == 1);
    CHECK(read.sections == std::vector<std::string>{"PointData", "CellData", "Points", "Cells"});
    CHECK(read.doubles("Points") == grid.points);
    CHECK(read.doubles("displacement_mm") == grid.on_points[0].values);
    CHECK(read.components("displacement_mm") == 3);
    const std::vector<double> strain = read.doubles("strain");
    REQUIRE(strain.size() == 6);
    CHECK(strain[0] == 1e-300);
    CHECK(std::isnan(strain[3]));
    CHECK(read.doubles("material") == std::vector<double>{2.0});
    CHECK(read.as<std::int64_t>("connectivity") == std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(read.as<std::int64_t>("offsets") == std::vector<std::int64_t>{8});
    CHECK(read.as<std::uint8_t>("types") == std::vector<std::uint8_t>{12});
}

TEST_CASE("vtu: base64 of every length, tetrahedra, a grid without cells") {
    for (std::size_t n = 0; n < 4; ++n) {
        VtuGrid grid;
        grid.corners = 4;
        grid.points.assign(3 * 4, 0.5);
        for (std::size_t i = 0; i < n; ++i) grid.cells.insert(grid.cells.end(), {0, 1, 2, 3});
        grid.in_cells = {{"a", 1, std::vector<double>(n, 1.5)}};
        const VtuRead read = read_vtu_text(vtu_text(grid));
        CHECK(read.doubles("a") == grid.in_cells[0].values);
        CHECK(read.as<std::uint8_t>("types") == std::vector<std::uint8_t>(n, 10));
        CHECK(read.as<std::int64_t>("offsets").size() == n);
    }
}

TEST_CASE("vtu: the file is there whole or not at all") {
    const TemporaryFolder folder;
    write_vtu(folder / "a.vtu", one_cube());
    CHECK(read_text(folder / "a.vtu") == vtu_text(one_cube()));
    CHECK_THROWS_AS(write_vtu(folder / "none" / "a.vtu", one_cube()), std::runtime_error);
    CHECK_FALSE(std::filesystem::exists(folder / "none"));
}
