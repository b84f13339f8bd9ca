#include <doctest/doctest.h>

#include "mechanics/rolling_cost.h"
#include "mechanics/rolling_mesh.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

// As assets/phantoms/silicone.json.
RollingModel silicone() {
    RollingModel model;
    model.tissue = {47000.0, 0.49};
    const auto add = [&](double x_m, double y_m, double z_m, double diameter_m) {
        model.inclusions.push_back({{{x_m, y_m, 0.025 - z_m}, 0.5 * diameter_m}, {2.3e6, 0.49}});
    };
    add(0.035, 0.035, 0.011, 0.010);
    add(0.085, 0.045, 0.010, 0.008);
    add(0.060, 0.088, 0.009, 0.006);
    return model;
}

}  // namespace

TEST_CASE("cost: the shipped phantom is affordable, refined once for its check too") {
    for (const double coarseness : {1.0, 0.5}) {
        CAPTURE(coarseness);
        const RollingModel model = silicone();
        const RollingMesh mesh = choose_rolling_mesh(model, coarseness);
        std::vector<RollingCost> costs{contact_cost(model, mesh), side_cost(model, mesh)};
        for (const auto& group : inclusion_groups(model, mesh)) costs.push_back(inclusion_cost(model, mesh, group));
        for (const RollingCost& cost : costs) {
            MESSAGE(cost.unknowns << " unknowns, " << 1e-9 * cost.memory_bytes << " GB, " << cost.time_s << " s");
            CHECK(affordable(cost));
        }
    }
}

// A deep press on a large block meets the bounds on nodes and cells; an estimate of the error needs meshes beyond them.
TEST_CASE("rolling meshes: coarser ones are coarser everywhere, also where the usual ones are as fine as they may be") {
    RollingModel deep = silicone();
    deep.size_m = {0.5, 0.9, 0.025};
    deep.radius_m = 0.03;
    deep.least_depth_m = 0.0002;
    RollingModel cylinder = deep;
    cylinder.shape = IndenterShape::cylinder;
    cylinder.length_m = 0.02;
    for (const RollingModel& model : {silicone(), deep, cylinder}) {
        const RollingMesh usual = choose_rolling_mesh(model), coarser = choose_rolling_mesh(model, 1.5);
        CHECK(coarser.contact_m / usual.contact_m == close_to(1.5).epsilon(0.12));
        for (const std::size_t c : {0U, 1U})
            CHECK(coarser.surface_m[c] / usual.surface_m[c] == close_to(1.5).epsilon(0.12));
        CHECK(usual.cells_across / coarser.cells_across == close_to(1.5));
    }
    for (const int rows : {2, 3, 5}) {  // short cylinders
        CAPTURE(rows);
        cylinder.length_m = 0.02;
        cylinder.length_m = rows * 0.99 * choose_rolling_mesh(cylinder).contact_m;
        const RollingMesh usual = choose_rolling_mesh(cylinder);
        CHECK(choose_rolling_mesh(cylinder, 1.5).contact_m > 1.3 * usual.contact_m);
    }
}

TEST_CASE("cost: the unknowns are those of the meshes that are built") {
    const RollingModel model = silicone();
    const RollingMesh mesh = choose_rolling_mesh(model, 4.0);
    const auto nodes = [&](const GridLines& lines) {
        return static_cast<double>(
            block_problem(lines.x_m, lines.y_m, lines.z_m, model.tissue, {}).mesh.nodes_m.cols());
    };
    CHECK(contact_cost(model, mesh).unknowns == 3.0 * nodes(contact_lines(model, mesh)));
    CHECK(inclusion_cost(model, mesh, {1}).unknowns == 3.0 * nodes(inclusion_lines(model, mesh, {1})));
}

TEST_CASE("cost: what is far too fine is told without allocating it") {
    RollingModel model = silicone();
    model.inclusions[2].sphere.radius_m = 5e-6;
    CHECK_FALSE(affordable(inclusion_cost(model, choose_rolling_mesh(model), {2})));

    RollingModel shallow = silicone();
    shallow.least_depth_m = shallow.greatest_depth_m = 1e-9;
    CHECK_FALSE(affordable(contact_cost(shallow, choose_rolling_mesh(shallow))));
}
