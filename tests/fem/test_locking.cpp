#include <doctest/doctest.h>

#include "fem/locking.h"
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
