#include <cmath>
#include <doctest/doctest.h>

#include "fem/locking.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/fem/fem_cases.h"

using namespace palpa;
using namespace palpa::fem;
using namespace palpa::test;

namespace {

const std::string kCoarse = R"({"box": {"size_mm": [100, 100, 50], "elements": [8, 8, 4]}})";

FemCase slab(const char* element, double poisson) {
    return case_of(case_text(kCoarse, element, kClamped, press_at(50, 50, 16), gel(2500, poisson)));
}

}  // namespace

TEST_CASE("locking: tet4 and hex8 near 0.5 are told of, with a figure; hex8-bbar and the default tissue never") {
    const auto said = [](const char* element, double poisson) {
        return locking_warning(slab(element, poisson).problem);
    };
    CHECK(contains(said("tet4", 0.499), "tet4 locks at poisson 0.499"));
    CHECK(contains(said("tet4", 0.499), "3.39 times too stiff"));
    CHECK(contains(said("hex8", 0.4995), "1.87 times too stiff at 0.499; hex8-bbar does not lock"));
    CHECK(contains(said("hex8", 0.47), "1.07 times"));
    CHECK(
        contains(said("hex8i", 0.4999), "hex8i locks at poisson 0.4999: on the slab of docs/fem.md it is 1.13 times"));
    CHECK(contains(said("hex8i", 0.49999), "1.47 times too stiff at 0.49999; hex8-bbar"));
    CHECK(contains(said("hex8i", 0.4999999), "at 0.49999, and more here"));
    CHECK(said("hex8i", 0.495).empty());
    CHECK(said("tet4", 0.45).empty());
    CHECK(said("hex8", 0.3).empty());
    CHECK(said("hex8-bbar", 0.4999).empty());
}

TEST_CASE("locking: what is warned of is so, and grows with Poisson's ratio") {
    for (const char* element : {"tet4", "hex8"}) {
        CAPTURE(element);
        double before = 1.0;
        for (const double poisson : {0.3, 0.47, 0.499}) {
            const double ratio = *solved(slab("hex8-bbar", poisson)).skel_m / *solved(slab(element, poisson)).skel_m;
            CHECK(ratio > before);
            before = ratio;
        }
        CHECK(before > 1.5);
    }
}

TEST_CASE("bending: few cells across a bar that bends are told of, with what they give; what is held or hex8i never") {
    const auto bar = [](const char* element, const char* cells, const char* held) {
        const std::string box = std::string(R"({"box": {"size_mm": [80, 8, 8], "elements": )") + cells + "}}";
        return case_of(case_text(box, element, std::string(R"([{"face": ")") + held + R"(", "fix": "xyz"}])",
                                 R"([{"face": "xmax", "traction_Pa": [0, 0, -10]}])", gel(1e9, 0.3)));
    };
    CHECK(
        contains(bending_warning(bar("hex8-bbar", "[10, 1, 1]", "xmin")),
                 "1 cell across the body along y: bent that way, the bar of docs/fem.md has with hex8-bbar 1.21 of its "
                 "displacement on cubes, 0.5 on"));
    CHECK(contains(bending_warning(bar("hex8-bbar", "[60, 3, 1]", "xmin")), "1 cell across the body along z"));
    CHECK(contains(bending_warning(bar("tet4", "[20, 4, 2]", "xmin")), "2 cells across the body along z"));
    CHECK(contains(bending_warning(bar("hex8", "[30, 4, 3]", "xmin")),
                   "hex8 0.94 of its displacement on cubes, and on flat cells more"));
    CHECK(bending_warning(bar("hex8i", "[10, 1, 1]", "xmin")).empty());
    CHECK(bending_warning(bar("hex8-bbar", "[40, 4, 4]", "xmin")).empty());
    CHECK(bending_warning(bar("hex8-bbar", "[10, 4, 1]", "zmin")).empty());
    CHECK(bending_warning(slab("hex8-bbar", 0.3)).empty());
    // what is said is so: the tip over F L^3 / (3 E I)
    const double right_m = 10.0 * 64e-6 * std::pow(0.08, 3) / (3.0 * 1e9 * std::pow(0.008, 4) / 12.0);
    CHECK(*solved(bar("hex8-bbar", "[10, 1, 1]", "xmin")).skel_m / right_m == close_to(1.207).epsilon(2e-3));
    CHECK(*solved(bar("hex8-bbar", "[5, 1, 1]", "xmin")).skel_m / right_m == close_to(0.504).epsilon(3e-3));
    CHECK(*solved(bar("tet4", "[20, 2, 2]", "xmin")).skel_m / right_m == close_to(0.508).epsilon(3e-3));
}
