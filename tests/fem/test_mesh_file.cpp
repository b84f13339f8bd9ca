// What a .msh may hold that would be computed wrongly without a word.

#include <doctest/doctest.h>

#include "tests/error_message.h"
#include "tests/fem/fem_cases.h"
#include "tests/files/msh_writer.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

const std::string kTop = R"([{"traction_Pa": 10, "physical": "top"}])";

std::string case_on(const std::string& loads, const std::string& supports, const std::string& regions) {
    return case_text(R"({"file": "m.msh"})", "hex8-bbar", supports, loads,
                     R"({"gel": {"young_Pa": 2500, "poisson": 0.45}})", regions);
}

std::string said(const MshWritten& mesh, const std::string& loads = kTop,
                 const std::string& supports = R"([{"physical": "base", "fix": "xyz"}])",
                 const std::string& regions = R"([{"all": true, "material": "gel"}])") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "m.msh", msh_4(mesh, true));
    return message_of([&] { solved(case_on(loads, supports, regions), folder.path()); });
}

std::vector<std::string> warned(const MshWritten& mesh) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "m.msh", msh_2(mesh, true));
    return case_of(case_on(kTop, R"([{"physical": "base", "fix": "xyz"}])", R"([{"all": true, "material": "gel"}])"),
                   folder.path())
        .warnings;
}

// `other` stands beside `mesh`, moved and stretched; its groups are the same.
void add_beside(const MshWritten& other, double along_x, double along_y, double scale, MshWritten& mesh) {
    const int first = static_cast<int>(mesh.nodes.size());
    for (const auto& x : other.nodes)
        mesh.nodes.push_back({scale * x[0] + along_x, scale * x[1] + along_y, scale * x[2]});
    for (auto cell : other.cells) {
        for (int& node : cell.nodes) node += first;
        mesh.cells.push_back(cell);
    }
}

}  // namespace

TEST_CASE("fem mesh: a group that would load nothing is refused: empty, or of faces that no cell has") {
    MshWritten mesh = row_of_cubes(2);
    mesh.names.push_back({2, 8, "nothing"});
    mesh.names.push_back({3, 9, "hole"});
    CHECK(said(mesh).empty());
    CHECK(contains(said(mesh, R"([{"traction_Pa": 10, "physical": "nothing"}])"),
                   "loads[0].physical: found a group 'nothing' of 0 triangles and 0 quads"));
    CHECK(contains(said(mesh, kTop, R"([{"physical": "nothing", "fix": "xyz"}])"),
                   "supports[0].physical: found a group 'nothing' without faces"));
    CHECK(contains(said(mesh, kTop, R"([{"physical": "base", "fix": "xyz"}])",
                        R"([{"all": true, "material": "gel"}, {"physical": "hole", "material": "gel"}])"),
                   "regions[1].physical: found a group 'hole' without elements"));
    for (const bool all : {true, false}) {  // one triangle among quads would be left out as well
        MshWritten cut = row_of_cubes(2);
        for (auto& cell : cut.cells) {
            if (cell.type != 3 || cell.groups[0] != 2) continue;
            cell.type = 2;
            cell.nodes.pop_back();
            if (!all) break;
        }
        CHECK(contains(said(cut), all ? "of 2 triangles and 0 quads" : "of 1 triangles and 1 quads"));
        CHECK(contains(said(cut), "expected quads only"));
    }
}

TEST_CASE("fem mesh: a name that two groups of one dimension have is refused with their tags") {
    MshWritten mesh = row_of_cubes(2);
    mesh.names.push_back({2, 8, "top"});
    CHECK(contains(said(mesh), "found several groups of dimension 2 called 'top' in "));
    CHECK(contains(said(mesh), "(physical tags 2, 8)"));
    mesh.names.back() = {3, 8, "top"};  // of another dimension: no doubt which is meant
    CHECK(said(mesh).empty());
}

TEST_CASE("fem mesh: a face with a node of no cell cannot be held") {
    MshWritten mesh = row_of_cubes(1);
    mesh.nodes.push_back({0, 0, -5});
    mesh.cells.push_back({2, {1}, {0, 1, 8}});
    CHECK(contains(said(mesh), "with a node that no cell of the body has"));
}

TEST_CASE("fem mesh: hanging nodes are refused by number and place, doubled ones are warned of") {
    MshWritten mesh = row_of_cubes(1);
    add_beside(row_of_cubes(1), 10.0, 2.0, 0.5, mesh);  // half as large, against the first cube's side
    CHECK(contains(said(mesh), "m.msh: found node 87 (10, 2, 0 mm) in a face of element "));
    CHECK(contains(said(mesh), "without being its corner (4 such nodes)"));

    MshWritten equal = row_of_cubes(1);
    add_beside(row_of_cubes(1), 10.0, 0.0, 1.0, equal);
    CHECK(said(equal).empty());
    REQUIRE(warned(equal).size() == 1);
    CHECK(
        contains(warned(equal)[0], "8 nodes lie where another node is, the first is node 17 (10, 0, 0 mm) on node 87"));

    MshWritten apart = row_of_cubes(1);
    add_beside(row_of_cubes(1), 10.1, 2.0, 0.5, apart);
    CHECK(said(apart).empty());
    CHECK(warned(apart).empty());
}

TEST_CASE("fem mesh: messages give the file's numbers and mm, and say what a cut rigid inclusion needs") {
    const std::string twice =
        R"([{"physical": "base", "fix": "xyz"}, {"physical": "base", "fix": "x", "value_mm": 1}])";
    CHECK(contains(said(row_of_cubes(1), kTop, twice),
                   "c.json: supports: found node 7 (0, 0, 0 mm) is given two displacements along x: 0 mm and 1 mm"));
    const std::string symmetric = R"([{"face": "zmin", "fix": "xyz"}, {"face": "xmin", "fix": "x"}])";
    const std::string cut = case_text(
        R"({"box": {"size_mm": [30, 30, 10], "elements": [6, 6, 4]}})", "hex8-bbar", symmetric,
        R"([{"traction_Pa": 50, "face": "zmax"}])",
        R"({"gel": {"young_Pa": 2500, "poisson": 0.45}, "ball": {"young_Pa": 1e13, "poisson": 0.3}})",
        R"([{"all": true, "material": "gel"}, {"sphere": {"centre_mm": [0, 15, 5], "radius_mm": 4}, "material": "ball"}])");
    const std::string message = message_of([&] { solved(cut); });
    CHECK(contains(message, "c.json: supports: found a rigid inclusion of 18 nodes around 2.5, 15, 5 mm"));
    CHECK(contains(message, "free to move in 3 ways (translation y; translation z; rotation about x)"));
    CHECK(contains(message, "expected a rigid inclusion held completely"));
}
