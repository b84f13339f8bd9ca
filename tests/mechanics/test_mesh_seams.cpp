// Two boxes that touch, meshed in different ways.

#include <doctest/doctest.h>

#include "mechanics/mesh_seams.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

// Both as one mesh, the second moved along x; no node is shared.
Mesh side_by_side(const Mesh& a, const Mesh& b, double along_x_m) {
    const Eigen::Index n = a.nodes_m.cols();
    Mesh out{Eigen::Matrix3Xd(3, n + b.nodes_m.cols()),
             Eigen::MatrixXi(a.cells.rows(), a.cells.cols() + b.cells.cols()),
             Eigen::VectorXi::Zero(a.cells.cols() + b.cells.cols())};
    out.nodes_m << a.nodes_m, b.nodes_m.colwise() + Eigen::Vector3d(along_x_m, 0.0, 0.0);
    out.cells << a.cells, b.cells.array() + static_cast<int>(n);
    return out;
}

Mesh cube(int cells) { return hex_box({{0.03, 0.03, 0.03}, {cells, cells, cells}, std::nullopt}); }

Seams seams_of(const Mesh& mesh) { return find_seams(mesh, boundary_faces(mesh)); }

}  // namespace

TEST_CASE("seams: a mesh of one piece has none, of bricks or tetrahedra, graded or not") {
    const Mesh graded = hex_box({{0.1, 0.1, 0.05}, {6, 6, 4}, Grading{{0.05, 0.05}, 0.002}});
    for (const Mesh& mesh : {cube(3), split_to_tets(cube(3)), graded, split_to_tets(graded)}) {
        const Seams seams = seams_of(mesh);
        CHECK(seams.hanging.empty());
        CHECK(seams.doubled.empty());
    }
}

TEST_CASE("seams: nodes inside faces and on edges of coarser cells hang, nodes on corners are doubled") {
    for (const bool tets : {false, true}) {
        CAPTURE(tets);
        const auto of = [&](const Mesh& mesh) { return tets ? split_to_tets(mesh) : mesh; };
        // 5 x 5 nodes against 3 x 3: 9 of them meet, 16 hang
        const Mesh halves = side_by_side(of(cube(2)), of(cube(4)), 0.03);
        const Seams seams = seams_of(halves);
        CHECK(seams.hanging.size() == 16);
        CHECK(seams.doubled.size() == 18);
        for (const Seam& seam : seams.hanging) {
            CHECK(halves.nodes_m(0, seam.node) == close_to(0.03));
            CHECK(seam.other == -1);
        }
        const Seams equal = seams_of(side_by_side(of(cube(3)), of(cube(3)), 0.03));
        CHECK(equal.hanging.empty());
        CHECK(equal.doubled.size() == 32);
    }
}

TEST_CASE("seams: a gap that is wider than the coordinates' rounding parts two bodies") {
    CHECK(seams_of(side_by_side(cube(2), cube(4), 0.03 + 1e-6)).hanging.empty());
    CHECK(seams_of(side_by_side(cube(2), cube(4), 0.03 + 1e-6)).doubled.empty());
    CHECK(seams_of(side_by_side(cube(2), cube(4), 0.03 + 1e-10)).hanging.size() == 16);
}
