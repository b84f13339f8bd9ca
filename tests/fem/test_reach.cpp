// An indenter over a .msh whose top is not one plane.

#include <doctest/doctest.h>
#include <functional>

#include "tests/error_message.h"
#include "tests/fem/fem_cases.h"
#include "tests/files/msh_writer.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

// 6 x 6 x 2 bricks, 30 x 30 x 10 mm; `height` gives z at the top.
MshWritten block(const std::function<double(double x_mm, double y_mm)>& height_mm) {
    MshWritten mesh;
    mesh.names = {{2, 1, "base"}, {3, 3, "gel"}};
    const auto at = [](int i, int j, int k) { return (k * 7 + j) * 7 + i; };
    for (int k = 0; k <= 2; ++k) {
        for (int j = 0; j <= 6; ++j) {
            for (int i = 0; i <= 6; ++i)
                mesh.nodes.push_back({5.0 * i, 5.0 * j, 0.5 * k * height_mm(5.0 * i, 5.0 * j)});
        }
    }
    for (int j = 0; j < 6; ++j) {
        for (int i = 0; i < 6; ++i) {
            mesh.cells.push_back({3, {1}, {at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0)}});
            for (int k = 0; k < 2; ++k) {
                mesh.cells.push_back(
                    {5,
                     {3},
                     {at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1),
                      at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)}});
            }
        }
    }
    return mesh;
}

double flat(double, double) { return 10.0; }

std::string pressed(const MshWritten& mesh, double depth_mm, double radius_mm = 20.0) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "m.msh", msh_2(mesh, false));
    const std::string tool = R"([{"indenter": {"shape": "sphere", "centre_mm": [15, 15], "radius_mm": )" +
                             number_text(radius_mm) + R"(, "depth_mm": )" + number_text(depth_mm) + "}}]";
    return message_of([&] {
        solved(case_text(R"({"file": "m.msh"})", "hex8-bbar", R"([{"physical": "base", "fix": "xyz"}])", tool),
               folder.path());
    });
}

}  // namespace

TEST_CASE("indenter: a body without a face in its highest plane is refused, with its highest node") {
    const auto dome = [](double x, double y) { return x == 15.0 && y == 15.0 ? 11.0 : 10.0; };
    CHECK(contains(pressed(block(dome), 1.0),
                   "loads[0].indenter: found a body without a face in its highest plane; its highest is node "
                   "1227 (15, 15, 11 mm)"));
    CHECK(contains(pressed(block([](double x, double) { return 10.0 + 0.1 * x; }), 1.0),
                   "expected a flat surface at zmax"));
    CHECK(pressed(block(flat), 1.0).empty());
}

TEST_CASE("indenter: nodes that no cell uses do not raise the surface or thicken the tissue") {
    MshWritten mesh = block(flat);
    mesh.nodes.push_back({15.0, 15.0, 25.0});
    mesh.nodes.insert(mesh.nodes.begin(), {15.0, 15.0, -9.0});  // the numbers of all others shift
    for (auto& cell : mesh.cells) {
        for (int& node : cell.nodes) ++node;
    }
    CHECK(pressed(mesh, 1.0).empty());
    CHECK(contains(pressed(mesh, 20.0), "depth_mm: found 20, expected less than the tissue is thick, 10"));
}

TEST_CASE("indenter: a tool that comes down on a lower part of the surface as well is refused, one above it not") {
    const auto capped = [](double x, double) { return x > 20.0 ? 9.0 : 10.0; };  // a slope from x 20 to 25 mm
    CHECK(contains(pressed(block(capped), 3.0), "reaches a lower part of the surface at "));
    CHECK(contains(pressed(block(capped), 3.0), "expected a flat surface at zmax, 10 mm, wherever the tool reaches"));
    CHECK(pressed(block(capped), 0.5, 8.0).empty());
}
