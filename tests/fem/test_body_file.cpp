#include <doctest/doctest.h>

#include "fem/body_file.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::mechanics;
using namespace palpa::fem;
using namespace palpa::test;

namespace {

// Two cells, the upper one of steel.
const Json kColumn = Json::parse(R"({
  "mesh": {"box": {"size_mm": [10, 10, 20], "elements": [1, 1, 2]}}, "element": "hex8",
  "materials": {"gel": {"young_Pa": 2500, "poisson": 0.45}, "steel": {"young_Pa": 2e11, "poisson": 0.3}},
  "regions": [{"all": true, "material": "gel"},
              {"box": {"min_mm": [0, 0, 10], "max_mm": [10, 10, 20]}, "material": "steel"}],
  "supports": [{"face": "zmin", "fix": "xyz"}]})");

}  // namespace

TEST_CASE("body file: mesh, element and the material of each cell") {
    JsonReader reader(kColumn, "column.json");
    const BodyFile file = read_body(reader, {});
    CHECK(file.element == Element::hex8);
    CHECK(file.materials == std::vector<std::string>{"gel", "steel"});
    REQUIRE(file.body.mesh.cells.cols() == 2);
    REQUIRE(file.body.materials.size() == 2);
    CHECK(file.body.materials[0].young_Pa == 2500.0);
    CHECK(file.body.materials[1].young_Pa == 2e11);
    CHECK(file.body.mesh.region(1) == 1);
    CHECK(file.body.mesh.nodes_m.row(2).maxCoeff() == close_to(0.02));
}

TEST_CASE("body file: a modulus at which displacements would overflow is refused") {
    Json soft = kColumn;
    soft["materials"]["gel"]["young_Pa"] = 1e-300;
    JsonReader reader(soft, "soft.json");
    CHECK(contains(message_of([&] { read_body(reader, {}); }), "young_Pa: found 1e-300, expected"));
}

TEST_CASE("body file: supports are added to the problem of the body, and must hold all of it") {
    JsonReader reader(kColumn, "column.json");
    BodyFile file = read_body(reader, {});
    Problem problem = problem_of(std::move(file.body), file.element);
    CHECK(problem.element == Element::hex8);
    CHECK(problem.materials.size() == 2);
    const std::vector<CaseSupport> supports = read_supports(reader, file.mesh, problem.supports);
    REQUIRE(supports.size() == 1);
    CHECK(supports[0].nodes.size() == 4);

    Json loose = kColumn;
    loose["supports"] = Json::array();
    JsonReader other(loose, "loose.json");
    Supports none;
    CHECK(contains(message_of([&] { read_supports(other, file.mesh, none); }), "loose.json: supports"));
}
