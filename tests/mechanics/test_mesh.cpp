#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <numbers>

#include "mechanics/error.h"
#include "mechanics/mesh.h"
#include "mechanics/mesh_check.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

TEST_CASE("box: every cell has its corners in VTK order") {
    // also guards against a compiler that swaps the last two: see cmake/warnings.cmake
    const Mesh mesh = hex_box({{0.3, 0.2, 0.1}, {3, 2, 4}, std::nullopt});
    REQUIRE(mesh.nodes_m.cols() == 4 * 3 * 5);
    REQUIRE(mesh.cells.cols() == 24);
    const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    for (Eigen::Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        for (int k = 0; k < 8; ++k) {
            const Eigen::Vector3d step(0.1 * corner[k][0], 0.1 * corner[k][1], 0.025 * corner[k][2]);
            const Eigen::Vector3d offset =
                mesh.nodes_m.col(mesh.cells(k, cell)) - mesh.nodes_m.col(mesh.cells(0, cell));
            CHECK((offset - step).norm() < 1e-15);
        }
    }
}

TEST_CASE("graded coordinates: node at the centre, finest beside it, one ratio per side") {
    const Eigen::VectorXd x = graded_coordinates_m(0.4, 40, 0.2, 0.0015);
    REQUIRE(x.size() == 41);
    CHECK(x(0) == 0.0);
    CHECK(x(40) == 0.4);
    CHECK(x(20) == close_to(0.2).epsilon(1e-15));
    CHECK(x(21) - x(20) == close_to(0.0015).epsilon(1e-9));
    const double ratio = (x(22) - x(21)) / (x(21) - x(20));
    for (int i = 21; i < 39; ++i) CHECK((x(i + 2) - x(i + 1)) / (x(i + 1) - x(i)) == close_to(ratio).epsilon(1e-9));
    for (int i = 0; i <= 40; ++i) CHECK(x(i) + x(40 - i) == close_to(0.4).epsilon(1e-14));  // mirrored
}

TEST_CASE("graded coordinates: off-centre, at an edge, too coarse, one cell") {
    const Eigen::VectorXd off = graded_coordinates_m(1.0, 30, 0.25, 0.005);
    CHECK(((off.tail(30) - off.head(30)).array() > 0.0).all());
    CHECK((off.array() - 0.25).abs().minCoeff() < 1e-15);
    CHECK((off.tail(30) - off.head(30)).minCoeff() == close_to(0.005).epsilon(1e-6));
    const Eigen::VectorXd edge = graded_coordinates_m(0.05, 12, 0.05, 0.001);  // as z: finest at the top
    CHECK(edge(12) - edge(11) == close_to(0.001).epsilon(1e-9));
    const Eigen::VectorXd coarse = graded_coordinates_m(1.0, 4, 0.5, 0.9);
    CHECK((coarse - Eigen::VectorXd::LinSpaced(5, 0.0, 1.0)).norm() < 1e-15);
    CHECK(graded_coordinates_m(0.3, 1, 0.1, 0.01)(1) == 0.3);
    CHECK_THROWS_AS(graded_coordinates_m(0.3, 10, 0.4, 0.01), MeshError);
    CHECK_THROWS_AS(graded_coordinates_m(0.3, 10, 0.1, 0.0), MeshError);
    CHECK_THROWS_AS(hex_box({{0.1, -0.1, 0.1}, {1, 1, 1}, std::nullopt}), MeshError);
}

TEST_CASE("tets: six per hexahedron fill it, faces match") {
    const Mesh hexes = hex_box({{0.1, 0.1, 0.05}, {4, 3, 2}, Grading{{0.03, 0.05}, 0.01}});
    const Mesh tets = split_to_tets(hexes);
    REQUIRE(tets.cells.cols() == 6 * hexes.cells.cols());
    CHECK(check_mesh(tets).volume_m3 == close_to(5e-4).epsilon(1e-12));
    CHECK(check_mesh(hexes).volume_m3 == close_to(5e-4).epsilon(1e-12));
    CHECK(boundary_faces(tets).cell.size() == 2 * boundary_faces(hexes).cell.size());  // none left open inside
}

TEST_CASE("faces: outward, closed, and their shares add up") {
    const Mesh hexes = hex_box({{0.1, 0.2, 0.05}, {3, 2, 2}, std::nullopt});
    const Mesh tets = split_to_tets(hexes);
    for (const Mesh* mesh : {&hexes, &tets}) {
        const Faces outer = boundary_faces(*mesh);
        Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();
        for (Eigen::Index f = 0; f < outer.cell.size(); ++f) {
            const auto x = [&](int k) -> Eigen::Vector3d { return mesh->nodes_m.col(outer.corners(k, f)); };
            const Eigen::Vector3d normal = (x(1) - x(0)).cross(x(2) - x(0));
            const Eigen::Vector3d from_centre = x(0) - Eigen::Vector3d(0.05, 0.1, 0.025);
            CHECK(normal.dot(from_centre) > 0.0);
            area_vector += normal;
        }
        CHECK(area_vector.norm() < 1e-16);
        const Faces top = faces_on(*mesh, outer, Side::zmax);
        CHECK(tributary_area_m2(*mesh, top).sum() == close_to(0.02).epsilon(1e-13));
        CHECK(nodes_of(top).size() == 12);
        CHECK(nodes_of(faces_on(*mesh, outer, Side::xmin)).size() == 9);
    }
}

TEST_CASE("sphere: shares converge to its volume, centroids decide the region") {
    Mesh mesh = hex_box({{0.04, 0.04, 0.04}, {10, 10, 10}, std::nullopt});
    const Sphere sphere{{0.021, 0.02, 0.019}, 0.01};
    const double exact = 4.0 / 3.0 * std::numbers::pi * 1e-6;
    const double cell = 6.4e-8;
    CHECK(sphere_share(mesh, sphere, 8).sum() * cell == close_to(exact).epsilon(0.005));
    CHECK(sphere_share(split_to_tets(mesh), sphere, 6).sum() * cell / 6.0 == close_to(exact).epsilon(0.01));
    const int inside = assign_sphere(sphere, 3, mesh);
    CHECK(inside * cell == close_to(exact).epsilon(0.1));
    CHECK((mesh.region.array() == 3).count() == inside);
    CHECK(assign_sphere({{1.0, 1.0, 1.0}, 0.01}, 5, mesh) == 0);
}
