#include <doctest/doctest.h>
#include <string>

#include "mechanics/error.h"
#include "mechanics/supports.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;

namespace {

std::string refusal(const Mesh& mesh, const Supports& supports, int* part = nullptr) {
    try {
        check_supported(mesh, supports);
    } catch (const SupportError& error) {
        if (part != nullptr) *part = error.part;
        return error.what();
    }
    return "";
}

// Two boxes, the second shifted; shared nodes only where merge says so.
Mesh two_boxes(double shift_x_m, double shift_y_m) {
    const Mesh one = hex_box({{0.1, 0.1, 0.1}, {2, 2, 2}, std::nullopt});
    Mesh both{Eigen::Matrix3Xd(3, 54), Eigen::MatrixXi(8, 16), Eigen::VectorXi::Zero(16)};
    both.nodes_m << one.nodes_m, one.nodes_m.colwise() + Eigen::Vector3d(shift_x_m, shift_y_m, 0.0);
    both.cells << one.cells, one.cells.array() + 27;
    return both;
}

void merge_nodes(Mesh& mesh) {
    for (Eigen::Index i = 0; i < mesh.cells.size(); ++i) {
        int& node = mesh.cells.data()[i];
        for (int other = 0; other < node; ++other) {
            if ((mesh.nodes_m.col(other) - mesh.nodes_m.col(node)).norm() < 1e-12) {
                node = other;
                break;
            }
        }
    }
}

Supports clamp_first(const Mesh& mesh) {
    std::vector<int> bottom;
    for (int node = 0; node < 27; ++node) {
        if (mesh.nodes_m(2, node) == 0.0) bottom.push_back(node);
    }
    Supports supports;
    fix(bottom, "xyz", 0.0, supports);
    return supports;
}

}  // namespace

TEST_CASE("hard case 14: a floating part is named, with its free motions") {
    const Mesh apart = two_boxes(0.3, 0.0);
    int part = -1;
    const std::string message = refusal(apart, clamp_first(apart), &part);
    CAPTURE(message);
    CHECK(part == 1);
    CHECK(message.find("part 2 of 2 (8 cells from cell 8") != std::string::npos);
    CHECK(message.find("6 ways") != std::string::npos);

    Problem problem;
    problem.mesh = apart;
    problem.materials.assign(16, {2500.0, 0.45});
    problem.supports = clamp_first(apart);
    CHECK_THROWS_AS(factorise(problem, best_solver()), SupportError);
}

TEST_CASE("hard case 14: missing and partial supports, hinges") {
    const Mesh mesh = hex_box({{0.1, 0.1, 0.1}, {2, 2, 2}, std::nullopt});
    const Faces outer = boundary_faces(mesh);
    CHECK(refusal(mesh, {}).find("6 ways") != std::string::npos);

    Supports sliding;
    fix(nodes_of(faces_on(mesh, outer, Side::zmin)), "z", 0.0, sliding);
    const std::string slides = refusal(mesh, sliding);
    CAPTURE(slides);
    CHECK(slides.find("3 ways") != std::string::npos);
    CHECK(slides.find("rotation about z") != std::string::npos);
    fix(nodes_of(faces_on(mesh, outer, Side::xmin)), "x", 0.0, sliding);
    CHECK(refusal(mesh, sliding).find("translation y") != std::string::npos);
    fix(nodes_of(faces_on(mesh, outer, Side::ymin)), "y", 0.0, sliding);
    CHECK(refusal(mesh, sliding).empty());

    Supports corner;  // one clamped node: turns about it
    fix({0}, "xyz", 0.0, corner);
    CHECK(refusal(mesh, corner).find("3 ways") != std::string::npos);

    Mesh hinged = two_boxes(0.1, 0.1);  // they share one edge
    merge_nodes(hinged);
    CHECK(parts_of(hinged).count == 2);
    const std::string hinge = refusal(hinged, clamp_first(hinged));
    CAPTURE(hinge);
    CHECK(hinge.find("part 2 of 2") != std::string::npos);
    CHECK(hinge.find("1 ways (") != std::string::npos);

    Mesh joined = two_boxes(0.1, 0.0);  // they share a side
    merge_nodes(joined);
    CHECK(refusal(joined, clamp_first(joined)).empty());
}

TEST_CASE("supports: contradictions and unknown axes") {
    const Mesh mesh = hex_box({{0.1, 0.1, 0.1}, {1, 1, 1}, std::nullopt});
    Supports supports;
    CHECK_THROWS_AS(fix({0}, "xq", 0.0, supports), SupportError);
    supports = {};
    fix({0, 1, 2, 3}, "xyz", 0.0, supports);
    fix({3}, "z", 0.0, supports);  // twice the same is fine
    CHECK_NOTHROW(make_reduction(mesh, supports, {}));
    fix({3}, "z", 0.001, supports);
    CHECK_THROWS_AS(make_reduction(mesh, supports, {}), SupportError);
}

TEST_CASE("rigid bodies: six unknowns each, held completely or not at all") {
    const Mesh mesh = hex_box({{0.04, 0.04, 0.04}, {4, 4, 4}, std::nullopt});
    const Faces outer = boundary_faces(mesh);
    Supports bottom;
    fix(nodes_of(faces_on(mesh, outer, Side::zmin)), "xyz", 0.0, bottom);
    std::vector<bool> rigid(64, false);
    rigid[static_cast<std::size_t>(16 + 5)] = rigid[static_cast<std::size_t>(32 + 5)] = true;  // two cells, inside
    const Reduction inside = make_reduction(mesh, bottom, rigid);
    CHECK(inside.equations == 3 * (125 - 25 - 12) + 6);
    std::vector<bool> held(64, false);
    held[5] = true;  // on the clamped bottom: its other nodes are held too
    CHECK(make_reduction(mesh, bottom, held).equations == 3 * (125 - 25 - 4));
    Supports rollers;
    fix(nodes_of(faces_on(mesh, outer, Side::zmin)), "z", 0.0, rollers);
    CHECK_THROWS_AS(make_reduction(mesh, rollers, held), SupportError);
    std::string message;
    try {
        make_reduction(mesh, rollers, held);
    } catch (const SupportError& error) {
        message = error.what();
    }
    CAPTURE(message);
    CHECK(message.find("a rigid inclusion of 8 nodes around 15, 15, 5 mm") != std::string::npos);
    CHECK(message.find("node 6 (10, 10, 0 mm)") != std::string::npos);
    CHECK(message.find("free to move in 3 ways (") != std::string::npos);
}

TEST_CASE("supports: messages speak in mm and in the file's numbers") {
    Mesh mesh = hex_box({{0.1, 0.1, 0.1}, {1, 1, 1}, std::nullopt});
    mesh.node_number = {11, 12, 13, 14, 15, 16, 17, 18};
    Supports supports;
    fix({1}, "z", 0.0, supports);
    fix({1}, "z", 0.001, supports);
    std::string message;
    try {
        make_reduction(mesh, supports, {});
    } catch (const SupportError& error) {
        message = error.what();
    }
    CHECK(message == "node 12 (100, 0, 0 mm) is given two displacements along z: 0 mm and 1 mm");
}
