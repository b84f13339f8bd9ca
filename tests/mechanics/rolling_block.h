#pragma once
// The small block that the rolling and the sliding tests press on, and its tables.

#include "mechanics/rolling.h"

namespace palpa::mechanics {

// A small block, a sphere of 3 mm that goes 1 and 2 mm deep, and coarse tables.
inline RollingModel rolling_block(std::vector<Inclusion> inclusions) {
    RollingModel model;
    model.size_m = {0.05, 0.05, 0.0125};
    model.tissue = {40e3, 0.45};
    model.inclusions = std::move(inclusions);
    model.radius_m = 0.003;
    model.least_depth_m = 0.001;
    model.greatest_depth_m = 0.002;
    return model;
}

inline Inclusion ball(double x_m, double y_m, double diameter_m) {
    return {{{x_m, y_m, 0.0125 - 0.003 - 0.5 * diameter_m}, 0.5 * diameter_m}, {2e6, 0.45}};  // top 3 mm deep
}

inline const std::vector<double> kDepths_m{0.001, 0.002};

struct Roller {
    explicit Roller(RollingModel m, double contact_m = 0.0)
        : model(std::move(m)), mesh(choose_rolling_mesh(model, 2.0)) {
        if (contact_m > 0.0) mesh.contact_m = contact_m;
        tables.contact = contact_kernel(model, mesh);
        tables.parts.push_back(side_table(model, mesh));
        for (const auto& group : inclusion_groups(model, mesh))
            tables.parts.push_back(inclusion_table(model, mesh, group));
    }
    RollingForce at(double x_m, double y_m, std::size_t depth = 1) {
        roll_to(model, mesh, tables, x_m, y_m, kDepths_m, work, forces);
        return forces[depth];
    }
    RollingModel model;
    RollingMesh mesh;
    RollingTables tables;
    RollingWork work;
    std::vector<RollingForce> forces;
};

}  // namespace palpa::mechanics
