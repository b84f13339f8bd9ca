#include <cmath>
#include <doctest/doctest.h>

#include "files/text.h"
#include "scene/advance.h"
#include "scene/tissue.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/scene/allocations.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

Scene curve_scene(const std::string& curve) {
    const TemporaryFolder folder;
    files::write_text_atomically(folder / "s.json", R"({"name": "n", "tissue": {"force_curve": )" + curve + "}}");
    return read_scene(folder / "s.json", kAssets);
}

std::string curve_refused(const std::string& curve) {
    return message_of([&] { curve_scene(curve); });
}

ForceCurve stiffening() { return {20.0, 3e-3, {}, {}, 8e-3}; }

}  // namespace

TEST_CASE("force curve: F = k d exp(d / g), its slope by differences, and its inverse") {
    const ForceCurve curve = stiffening();
    CHECK(force_at_N(curve, 6e-3) == close_to(0.12 * std::exp(2.0)).epsilon(1e-14));
    for (const double d : {0.0, 1e-6, 0.5e-3, 3e-3, 7.9e-3}) {
        const double h = 1e-8;
        CHECK(slope_at_N_per_m(curve, d + h) ==
              close_to((force_at_N(curve, d + 2.0 * h) - force_at_N(curve, d)) / (2.0 * h)).epsilon(1e-6));
        CHECK(std::abs(depth_of_m(curve, force_at_N(curve, d)) - d) < 1e-14);
    }
    CHECK(depth_of_m(curve, 1e9) == 8e-3);
    CHECK(depth_of_m(curve, -1.0) == 0.0);
    CHECK(depth_of_m(curve, NAN) == 0.0);
    CHECK(force_at_N(curve, 1.0) == force_at_N(curve, 8e-3));
}

TEST_CASE("force curve: points, at, between and beyond them") {
    ForceCurve curve;
    curve.depth_m = {0.0, 2e-3, 4e-3};
    curve.force_N = {0.0, 0.1, 0.5};
    curve.greatest_depth_m = 4e-3;
    CHECK(force_at_N(curve, 1e-3) == close_to(0.05));
    CHECK(force_at_N(curve, 2e-3) == close_to(0.1));
    CHECK(force_at_N(curve, 3e-3) == close_to(0.3));
    CHECK(force_at_N(curve, 9e-3) == close_to(0.5));
    CHECK(depth_of_m(curve, 0.3) == close_to(3e-3));
    CHECK(depth_of_m(curve, 0.6) == 4e-3);
    CHECK(slope_at_N_per_m(curve, 1e-3) == close_to(50.0));
    CHECK(slope_at_N_per_m(curve, 3e-3) == close_to(200.0));
}

TEST_CASE("force curve: a touch sinks to the depth of its force, at any stiffness of the scene, and saturates") {
    const Scene scene = curve_scene(R"({"stiffness_N_per_mm": 0.02, "growth_mm": 3, "greatest_depth_mm": 8})");
    const Plan plan = make_plan(scene);
    CHECK(plan.greatest_depth_m == 8e-3);
    TissueWork work = make_work(plan.tissue);
    Press press{{0.06, 0.06}, 0.2, {1.0, 0.0}, true, 2.0};
    Contact contact;
    answer(plan.tissue, StageId::depth, press, work, contact);
    CHECK(2.0 * force_at_N(stiffening(), contact.depth_m) == close_to(0.2));
    CHECK_FALSE(contact.saturated);
    press.force_N = 100.0;
    const auto before = allocations();
    answer(plan.tissue, StageId::depth, press, work, contact);
    CHECK(contact.saturated);
    CHECK(rise_N(plan.tissue, {}, work) == 0.0);
    const Push push = push_to(plan.tissue, {0.06, 0.06}, 6e-3, work);
    CHECK(allocations() == before);
    CHECK(push.force_N == close_to(force_at_N(stiffening(), 6e-3)));
    CHECK(push.slope_N_per_m == close_to(slope_at_N_per_m(stiffening(), 6e-3)));
    CHECK(push_to(plan.tissue, {}, -1e-3, work).force_N == 0.0);
    CHECK(push_to(plan.tissue, {}, 9e-3, work).saturated);
}

TEST_CASE("force curve: bad input names the key, what was found and what was expected") {
    CHECK(contains(curve_refused("{}"), "neither a law nor points"));
    CHECK(contains(curve_refused(R"({"stiffness_N_per_mm": 1, "depth_mm": [1], "force_N": [1]})"), "a law and points"));
    CHECK(contains(curve_refused(R"({"stiffness_N_per_mm": -1})"), "stiffness_N_per_mm"));
    CHECK(contains(curve_refused(R"({"depth_mm": [1, 1], "force_N": [1, 2]})"), "depths that rise"));
    CHECK(contains(curve_refused(R"({"depth_mm": [1, 2], "force_N": [2, 2]})"), "forces that rise"));
    CHECK(contains(curve_refused(R"({"depth_mm": [1, 2], "force_N": [2]})"), "force_N"));
    CHECK(contains(curve_refused(R"({"stiffness_N_per_mm": 1, "growth_mm": 0.1, "greatest_depth_mm": 20})"),
                   "growth_mm"));
    CHECK(contains(curve_refused(R"({"stifness_N_per_mm": 1})"), "stifness_N_per_mm"));
}
