#pragma once
// Estimates what the tables of rolling.h need from the lines of their meshes, before anything of a mesh's size is
// allocated.

#include "mechanics/rolling.h"

namespace palpa::mechanics {

struct RollingCost {
    double unknowns = 0.0;      // of the largest mesh
    double memory_bytes = 0.0;  // of one process
    double time_s = 0.0;        // on one core
};

// A table that needs more is not attempted. The tables of the shipped phantom need an eighth of this memory, and three
// fifths of it when they are refined for a check.
inline constexpr double kMostTableMemory_bytes = 6e9;
inline constexpr double kMostTableTime_s = 4.0 * 3600.0;
inline bool affordable(const RollingCost& cost) {
    return cost.memory_bytes <= kMostTableMemory_bytes && cost.time_s <= kMostTableTime_s;
}

// Cost of the tables of the same names in rolling.h; contact_cost() includes the contact that is solved at every place.
RollingCost contact_cost(const RollingModel& model, const RollingMesh& mesh);
RollingCost side_cost(const RollingModel& model, const RollingMesh& mesh);
RollingCost inclusion_cost(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group);

}  // namespace palpa::mechanics
