#pragma once
// The converged answers of a soft device in a table, so that a simulated device answers within a millisecond what its finite
// elements take tens of milliseconds for: the finger's force and the cables' lengths, over the actuation and how deep the
// finger is.
//
// Actuators that are tied by force are one axis; cables that are not tied share one, on which their mean counts, and what they
// differ by adds to first order. Between the nodes everything is linear. The depth counts from the surface that the device
// has under that actuation, so that the beginning of contact is no kink between two nodes.

#include <functional>
#include <vector>

#include "tangible/device_model.h"

namespace palpa::tangible {

struct TableSize {
    int actuation = 16;  // nodes on an axis of a single drive; a device with several drives gets fewer on each
    int depth = 17;
    double deepest_m = 8e-3;  // beyond the surface
};

struct PlantTable {
    struct Axis {
        std::vector<int> members;  // actuators
        double lower = 0.0, upper = 0.0;
        int nodes = 2;
        bool differ = false;  // the members may differ
    };
    std::vector<Axis> axes;
    int actuators = 0;
    int depths = 0;
    double step_m = 0.0;            // between depths
    std::vector<double> surface_m;  // one per node of the actuation: from the shape at rest, positive downwards
    std::vector<double> force_N;    // one per node and depth
    std::vector<double> length_m;   // one per node, depth and actuator
    std::vector<double>
        slope;        // one per node, depth and actuator: N per N or Pa that the actuator differs; empty without
    int missing = 0;  // nodes without an equilibrium, filled from their neighbours
};

// Over the ranges of the device's actuators, led by force and pressure. `told` hears the share that is done, from several
// threads. Throws std::runtime_error if no node has an equilibrium.
PlantTable make_plant_table(const DeviceModel& model, const TableSize& size,
                            const std::function<void(double)>& told = {});

struct PlantTouch {
    double surface_m = 0.0;  // of the device without the finger
    double force_N = 0.0;    // on the finger, >= 0
    Lengths length{};        // of the cables, with the finger
};
// The finger at depth_m (from the shape at rest). Actuations outside the table are limited to it; below the lowest tension, as
// on relaxed cables, the force falls with it to zero. Neither allocates nor throws.
PlantTouch touch(const PlantTable& table, const Actuation& actuation, double depth_m) noexcept;

}  // namespace palpa::tangible
