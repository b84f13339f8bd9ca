#pragma once
// The choices of the mechanics library, each with its error and its cost.

#include <array>
#include <span>
#include <vector>

#include "accuracy/accuracy.h"
#include "mechanics/statics.h"

namespace palpa::accuracy {

// A slab of 100 x 100 x 50 mm, E = 2.5 kPa, bottom clamped, under 25 mN spread as a parabola of 16 mm diameter. Its
// answer is the mean depression, weighted by the pressure: the work of the load.
struct SlabReference {
    double mean_m = 0.0;  // mean depression
    double uncertainty_percent = 0.0;
};

// Returns Richardson's limit of B-bar elements on a quarter mesh, refined towards the load, and on the nested mesh of
// half as many cells. `finest`: cells along each edge, even. The first entry gives the limit; the differences of the
// other limits from it give the uncertainty.
SlabReference slab_reference(double poisson, std::span<const int> finest);

// Measures one element type on one mesh: uniform, or graded to cells 0.4 times as wide under the load.
AccuracyRow slab_row(mechanics::Element element, const std::array<int, 3>& cells, bool graded, double poisson,
                     const SlabReference& reference, const Effort& effort);

std::vector<Measurement> slab_measurements(const Effort& effort);
std::vector<Measurement> contact_measurements(const Effort& effort);
std::vector<Measurement> step_measurements(const Effort& effort);

}  // namespace palpa::accuracy
