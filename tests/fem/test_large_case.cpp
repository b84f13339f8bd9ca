// Large strains through the case file: the shipped cases, laws and elements.

#include <cmath>
#include <doctest/doctest.h>

#include "tests/close_to.h"
#include "tests/fem/fem_cases.h"

using namespace palpa;
using namespace palpa::fem;
using namespace palpa::test;

namespace {

FemCase shipped(const char* name, mechanics::Element element, mechanics::Law law) {
    FemCase model = read_case(std::string(PALPA_SOURCE_DIR "/assets/cases/") + name);
    model.problem.element = element;
    for (mechanics::Law& each : model.laws) each = law;
    return model;
}

struct Reference {
    mechanics::Element element;
    mechanics::Law law;
    double strip_mm, strip_N, block_N;
};

// The rows hex8 of the split form are CalculiX 2.20 (C3D8) on the same mesh, to all digits that it prints; the others
// are those of a prototype.
constexpr Reference kReferences[] = {
    {mechanics::Element::hex8, mechanics::Law::neo_hookean_split, 3.955691, 1.802998, -29.21510},
    {mechanics::Element::hex8, mechanics::Law::neo_hookean, 3.8987457, 1.832584, -28.83458},
    {mechanics::Element::hex8, mechanics::Law::stable_neo_hookean, 3.8396278, 1.857905, -27.62678},
    {mechanics::Element::hex8_bbar, mechanics::Law::neo_hookean_split, 4.0582916, 1.790808, -27.17305},
    {mechanics::Element::hex8_bbar, mechanics::Law::neo_hookean, 3.9909821, 1.821931, -26.09298},
    {mechanics::Element::hex8_bbar, mechanics::Law::stable_neo_hookean, 3.9400589, 1.845366, -26.04459}};

}  // namespace

TEST_CASE("large case: strip-pull and block-press give the reference numbers, to the digits they are known to") {
    for (const Reference& row : kReferences) {
        if (kSlow && row.element == mechanics::Element::hex8) continue;
        CAPTURE(mechanics::name_of(row.law));
        CAPTURE(static_cast<int>(row.element));
        const FemResult strip = solved(shipped("strip-pull.json", row.element, row.law));
        REQUIRE(strip.large);
        CHECK(strip.converged);
        CHECK(strip.large->stable);
        CHECK(1e3 * *strip.centre_m == close_to(row.strip_mm).epsilon(1.5e-7));
        CHECK(strip.reaction_N[2].x() == close_to(row.strip_N).epsilon(3e-7));
        const FemResult block = solved(shipped("block-press.json", row.element, row.law));
        CHECK(block.converged);
        CHECK(block.reaction_N[2].z() == close_to(row.block_N).epsilon(2e-7));
        CHECK(block.reaction_N[0].z() == close_to(-block.reaction_N[2].z()).epsilon(1e-8));
    }
}

TEST_CASE("large case: a pulled bar has the stress of its law, with every element") {
    const std::string mesh = R"({"box": {"size_mm": [20, 30, 10], "elements": [3, 3, 2]}})";
    const std::string rollers =
        R"([{"face": "xmin", "fix": "x"}, {"face": "ymin", "fix": "y"}, {"face": "zmin", "fix": "z"},
            {"face": "zmax", "fix": "z", "value_mm": 5}])";
    for (const char* element : {"hex8-bbar", "hex8", "tet4"}) {
        CAPTURE(element);
        const FemResult r =
            solved(case_text(mesh, element, rollers, "[]",
                             R"({"gel": {"law": "neo-hookean-split", "mu_Pa": 45000, "kappa_Pa": 430000}})"));
        REQUIRE(r.converged);
        // the closed form of 1.5 times the length, on 20 x 30 mm
        CHECK(r.reaction_N[3].z() == close_to(45018.503793 * 6e-4).epsilon(1e-8));
        const double wide = r.fields.strain(0, 0);
        for (Eigen::Index cell = 0; cell < r.fields.strain.cols(); ++cell) {
            CHECK(r.fields.strain(2, cell) == close_to(0.5 * (2.25 - 1.0)).epsilon(1e-9));
            CHECK(r.fields.strain(0, cell) == close_to(wide).epsilon(1e-9));
            CHECK(r.fields.stress_Pa(2, cell) == close_to(45018.503793 / (1.0 + 2.0 * wide)).epsilon(1e-8));
            CHECK(std::abs(r.fields.stress_Pa(0, cell)) < 1e-3);
        }
    }
}

TEST_CASE("large case: two materials with laws of their own, and what stops short says so") {
    const std::string mesh = R"({"box": {"size_mm": [20, 20, 20], "elements": [2, 2, 2]}})";
    const std::string materials = R"({"gel": {"law": "neo-hookean", "mu_Pa": 900, "kappa_Pa": 9000},
                                      "rim": {"law": "corotational", "mu_Pa": 9000, "kappa_Pa": 90000}})";
    const std::string regions = R"([{"all": true, "material": "gel"},
        {"box": {"min_mm": [0, 0, 10], "max_mm": [20, 20, 20]}, "material": "rim"}])";
    const auto pressed = [&](const char* value_mm) {
        return solved(case_text(mesh, "hex8-bbar",
                                R"([{"face": "zmin", "fix": "xyz"}, {"face": "zmax", "fix": "xy"},
                                    {"face": "zmax", "fix": "z", "value_mm": )" +
                                    std::string(value_mm) + "}]",
                                "[]", materials, regions));
    };
    const FemResult some = pressed("-3");
    CHECK(some.converged);
    CHECK(some.reaction_N[2].z() < 0.0);
    const FemResult through = pressed("-60");
    REQUIRE(through.large);
    CHECK_FALSE(through.converged);
    CHECK(through.large->load_share < 1.0);
    CHECK(through.solution.u_m.allFinite());
}
