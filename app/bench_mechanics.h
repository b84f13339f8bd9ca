#pragma once
// The choices of the mechanics library, each with its error and its cost.

#include <array>
#include <vector>

#include "app/bench_accuracy.h"
#include "mechanics/statics.h"

namespace palpa {

// The paper's slab, 100 x 100 x 50 mm, E = 2.5 kPa, bottom clamped, under 25 mN spread as a parabola of
// 16 mm. Its answer is the mean depression, weighted by the pressure: the work of the load.
struct SlabReference {
    double mean_m = 0.0;
    double uncertainty_percent = 0.0;
};

// Richardson's limit of B-bar on three nested quarter meshes, the finest `n` cells along each edge (a
// multiple of 4), refined towards the load; uncertain by how much it moved from the limit of the two coarser
// ones.
SlabReference slab_reference(double poisson, int n);

// One element on one uniform mesh.
AccuracyRow slab_row(mechanics::Element element, const std::array<int, 3>& cells, double poisson,
                     const SlabReference& reference, const Effort& effort);

std::vector<Measurement> slab_measurements(const Effort& effort);
std::vector<Measurement> contact_measurements(const Effort& effort);
std::vector<Measurement> step_measurements(const Effort& effort);

}  // namespace palpa
