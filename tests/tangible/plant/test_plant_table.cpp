// The tabulated answers of a soft device against its converged equilibria.

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "tangible/plant/plant_table.h"
#include "tests/close_to.h"
#include "tests/scene/allocations.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;

namespace {

// A soft block on the table that two cables pull down, at one edge each: untied, or tied.
DeviceModel pulled_block(bool tied) {
    files::Json json = files::parse_json(R"({"name": "block",
        "mesh": {"box": {"size_mm": [20, 20, 12], "elements": [4, 4, 3], "origin_mm": [-10, -10, 0]}}, "element": "hex8-bbar",
        "materials": {"silicone": {"law": "neo-hookean", "mu_Pa": 20000, "kappa_Pa": 160000}},
        "supports": [{"face": "zmin", "fix": "xyz"}],
        "cables": [{"name": "a", "path": [{"at_mm": [-10, 0, 12]}, {"guide_mm": [-10, 0, -20]}], "lower_N": 0.05, "upper_N": 0.35},
                   {"name": "b", "path": [{"at_mm": [10, 0, 12]}, {"guide_mm": [10, 0, -20]}], "lower_N": 0.05, "upper_N": 0.35}],
        "effector": {"face": "zmax", "centre_mm": [0, 0], "radius_mm": 6}})",
                                         "block.json");
    if (tied) json["ties"] = files::parse_json(R"([{"actuators": ["a", "b"], "force": true}])", "ties");
    return make_device_model(parse_soft_device(json, "block.json", "."));
}

TableSize small_table() {
    TableSize size;
    size.actuation = 4;
    size.depth = 5;
    size.deepest_m = 2e-3;
    return size;
}

// The equilibrium with the finger held at a depth from the shape at rest.
ForwardAnswer solved(const DeviceModel& model, double a_N, double b_N, double depth_m) {
    DeviceState state = rest_state(model);
    DeviceLoad load;
    load.actuation = {a_N, b_N};
    load.finger_by_position = true;
    load.finger = depth_m;
    return equilibrium(model, state, load);
}

}  // namespace

TEST_CASE("plant table: at its nodes it is the converged equilibrium, between them close to it") {
    const DeviceModel model = pulled_block(true);
    const PlantTable table = make_plant_table(model, small_table());
    CHECK(table.axes.size() == 1);
    CHECK(table.missing == 0);
    const double step_N = (0.35 - 0.05) / 3.0;
    for (const double tension_N : {0.05, 0.05 + step_N, 0.35}) {
        const double surface_m = touch(table, {tension_N, tension_N}, 0.0).surface_m;
        DeviceState state = rest_state(model);
        DeviceLoad load;
        load.actuation = {tension_N, tension_N};
        CHECK(std::abs(surface_m - equilibrium(model, state, load).depth_m) < 1e-9);
        for (const double pressed_m : {0.5e-3, 2e-3}) {
            const ForwardAnswer wanted = solved(model, tension_N, tension_N, surface_m + pressed_m);
            const PlantTouch found = touch(table, {tension_N, tension_N}, surface_m + pressed_m);
            CHECK(found.force_N == close_to(wanted.force_N).epsilon(1e-5));
            CHECK(std::abs(found.length[0] - wanted.length[0]) < 1e-7);
        }
    }
    for (const double tension_N : {0.1, 0.3}) {
        const double depth_m = touch(table, {tension_N, tension_N}, 0.0).surface_m + 1.3e-3;
        const double wanted_N = solved(model, tension_N, tension_N, depth_m).force_N;
        CHECK(touch(table, {tension_N, tension_N}, depth_m).force_N == close_to(wanted_N).epsilon(0.02));
    }
}

TEST_CASE("plant table: cables that are not tied count by their mean, and to first order by what they differ") {
    const DeviceModel model = pulled_block(false);
    const PlantTable table = make_plant_table(model, small_table());
    CHECK(table.axes.size() == 1);
    CHECK(table.axes[0].differ);
    const double surface_m = touch(table, {0.25, 0.25}, 0.0).surface_m;
    const double depth_m = surface_m + 1.2e-3;
    const double wanted_N = solved(model, 0.28, 0.22, depth_m).force_N;
    CHECK(touch(table, {0.28, 0.22}, depth_m).force_N == close_to(wanted_N).epsilon(0.03));
}

TEST_CASE(
    "plant table: no force above the surface, none on slack cables, none that is no number; nothing is allocated") {
    const DeviceModel model = pulled_block(true);
    const PlantTable table = make_plant_table(model, small_table());
    const std::int64_t before = test::allocations();
    const double surface_m = touch(table, {0.3, 0.3}, 0.0).surface_m;
    CHECK(touch(table, {0.3, 0.3}, surface_m - 1e-6).force_N == 0.0);
    CHECK(touch(table, {0.3, 0.3}, surface_m + 1e-6).force_N > 0.0);
    CHECK(touch(table, {0.0, 0.0}, surface_m + 1e-3).force_N == 0.0);
    CHECK(touch(table, {9.0, 9.0}, 1e-3).force_N == touch(table, {0.35, 0.35}, 1e-3).force_N);
    const double none = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isfinite(touch(table, {none, none}, 1e-3).force_N));
    CHECK(test::allocations() == before);
}
