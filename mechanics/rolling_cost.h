#pragma once
// What the tables of rolling.h need, told from the meshes' lines before anything of the size of a mesh is allocated.

#include "mechanics/rolling.h"

namespace palpa::mechanics {

struct RollingCost {
    double unknowns = 0.0;      // of the largest mesh
    double memory_bytes = 0.0;  // of one process
    double time_s = 0.0;        // on one core
};

// Above these a table is not attempted. The shipped phantom's need an eighth of the memory, refined for a check 3/5.
inline constexpr double kMostTableMemory_bytes = 6e9;
inline constexpr double kMostTableTime_s = 4.0 * 3600.0;
inline bool affordable(const RollingCost& cost) {
    return cost.memory_bytes <= kMostTableMemory_bytes && cost.time_s <= kMostTableTime_s;
}

// The mesh under the tool, and the contact that is solved on it at every place.
RollingCost contact_cost(const RollingModel& model, const RollingMesh& mesh);
RollingCost side_cost(const RollingModel& model, const RollingMesh& mesh);
RollingCost inclusion_cost(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group);

}  // namespace palpa::mechanics
