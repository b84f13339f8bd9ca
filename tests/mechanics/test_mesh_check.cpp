#include <doctest/doctest.h>
#include <limits>
#include <string>

#include "mechanics/error.h"
#include "mechanics/mesh_check.h"
#include "tests/close_to.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

std::vector<int> bad_cells(const Mesh& mesh) {
    try {
        check_mesh(mesh);
    } catch (const MeshError& error) {
        CHECK(std::string(error.what()).size() > 20);
        return error.cells;
    }
    return {};
}

}  // namespace

TEST_CASE("hard case 13: inverted and flat cells are refused by number") {
    const Mesh good = hex_box({{0.1, 0.1, 0.1}, {3, 3, 3}, std::nullopt});
    CHECK(bad_cells(good).empty());

    Mesh inverted = good;
    inverted.cells.col(7).head<4>().swap(inverted.cells.col(7).tail<4>());
    CHECK(bad_cells(inverted) == std::vector<int>{7});

    Mesh flat = good;
    flat.cells.col(4).tail<4>() = flat.cells.col(4).head<4>();
    CHECK(bad_cells(flat) == std::vector<int>{4});

    Mesh one_place = good;  // 0 / 0 for a relative volume; the message names a cell all the same
    one_place.nodes_m.setConstant(0.01);
    CHECK(bad_cells(one_place).size() == 27);

    Mesh tets = split_to_tets(good);
    std::swap(tets.cells(0, 11), tets.cells(1, 11));
    std::swap(tets.cells(2, 30), tets.cells(3, 30));
    CHECK(bad_cells(tets) == std::vector<int>{11, 30});

    Mesh folded = good;  // one node pulled through the opposite side of its cells
    folded.nodes_m.col(nearest_node(good, 0.0333, 0.0333, 0.0333)) = Eigen::Vector3d(0.09, 0.09, 0.09);
    CHECK(bad_cells(folded).size() >= 4);

    Mesh wild = good;
    wild.nodes_m(1, 5) = std::numeric_limits<double>::quiet_NaN();
    CHECK(!bad_cells(wild).empty());
    Mesh beyond = good;
    beyond.cells(3, 9) = 64;
    CHECK(bad_cells(beyond) == std::vector<int>{9});
    CHECK_THROWS_AS(check_mesh(Mesh{}), MeshError);
}

TEST_CASE("hard case 13: sliver sweep, the answer stays within 1e-4 until the cell is refused") {
    // a node inside a tet mesh slides towards a face of one of its tets: flatter and flatter, then without
    // volume
    const Mesh hexes = hex_box({{0.04, 0.04, 0.04}, {4, 4, 4}, std::nullopt});
    Problem problem = slab_problem(hexes, Element::tet4, {2500.0, 0.3});
    const Faces outer = boundary_faces(problem.mesh);
    const Eigen::Matrix3Xd load =
        traction_load(problem.mesh, faces_on(problem.mesh, outer, Side::zmax), {0.0, 0.0, -20.0});
    const int moved = nearest_node(problem.mesh, 0.02, 0.02, 0.02);
    const int probe = nearest_node(problem.mesh, 0.02, 0.02, 0.04);
    Eigen::Index cell = 0;
    while ((problem.mesh.cells.col(cell).array() != moved).all()) ++cell;
    Eigen::Vector3d target = Eigen::Vector3d::Zero();  // centroid of the face opposite to the node
    for (int k = 0; k < 4; ++k) {
        if (problem.mesh.cells(k, cell) != moved) target += problem.mesh.nodes_m.col(problem.mesh.cells(k, cell)) / 3.0;
    }
    const Eigen::Vector3d from = problem.mesh.nodes_m.col(moved);
    double before = 0.0;
    int refused = 0;
    int slivers = 0;
    for (const double left : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-14}) {
        CAPTURE(left);
        problem.mesh.nodes_m.col(moved) = target + left * (from - target);
        if (!bad_cells(problem.mesh).empty()) {
            ++refused;
            continue;
        }
        CHECK(refused == 0);
        const Factored factored = factorise(problem, best_solver());
        slivers += factored.report.slivers.empty() ? 0 : 1;
        const double u = solve(factored, load).u_m(2, probe);
        if (before != 0.0) CHECK(u == close_to(before).epsilon(1e-4));
        before = u;
    }
    CHECK(slivers >= 3);  // reported while still usable
    CHECK(refused >= 1);  // and refused in the end
}

TEST_CASE("cell quality: a brick and a regular tetrahedron are the best") {
    const Mesh brick = hex_box({{0.1, 0.2, 0.3}, {1, 1, 1}, std::nullopt});
    CHECK(cell_quality(brick, 0).relative_det == close_to(1.0).epsilon(1e-12));
    Mesh tet{Eigen::Matrix3Xd(3, 4), Eigen::MatrixXi(4, 1), Eigen::VectorXi::Zero(1)};
    tet.nodes_m << 1, -1, -1, 1, 1, -1, 1, -1, 1, 1, -1, -1;
    tet.cells << 0, 1, 2, 3;
    const CellQuality q = cell_quality(tet, 0);
    CHECK(std::abs(q.relative_det) == close_to(0.70710678).epsilon(1e-7));
    CHECK(q.min_dihedral_deg == close_to(70.528779).epsilon(1e-7));
    CHECK(std::abs(q.radius_ratio) == close_to(1.0).epsilon(1e-12));
}

TEST_CASE("parts: cells that share faces, loose nodes are reported") {
    Mesh mesh = hex_box({{0.3, 0.1, 0.1}, {3, 1, 1}, std::nullopt});
    CHECK(parts_of(mesh).count == 1);
    mesh.cells.col(1) = mesh.cells.col(2);
    mesh.cells.conservativeResize(8, 2);
    mesh.region.conservativeResize(2);
    const Parts parts = parts_of(mesh);
    CHECK(parts.count == 2);
    CHECK(describe_part(mesh, parts, 1).find("part 2 of 2 (1 cells from cell 1") == 0);
    mesh.cell_number = {70, 90};
    CHECK(describe_part(mesh, parts, 1) == "part 2 of 2 (1 cells from cell 90, x 200..300, y 0..100, z 0..100 mm)");
    mesh.cells.conservativeResize(8, 1);
    mesh.region.conservativeResize(1);
    CHECK(check_mesh(mesh).loose_nodes.size() == 8);
}
