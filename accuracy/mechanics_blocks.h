#pragma once
// The blocks that the mechanics measurements press on, and how a tool moves over them; theirs alone.

#include <string>

#include "accuracy/accuracy.h"
#include "accuracy/timing.h"
#include "mechanics/contact.h"

namespace palpa::accuracy {

inline constexpr mechanics::Material kBenchTissue{2500.0, 0.45};
inline constexpr mechanics::Indenter kBenchBall{mechanics::IndenterShape::sphere, 0.008};

const char* name_of(mechanics::Element element);

// One material, bottom clamped; tetrahedra by splitting the hexahedra.
mechanics::Problem block(const mechanics::Mesh& hexes, mechanics::Element element, const mechanics::Material& material);
// The same as the quarter x >= 0, y >= 0 of a block that is symmetric about both planes.
mechanics::Problem quarter_block(const mechanics::Mesh& hexes, mechanics::Element element,
                                 const mechanics::Material& material);

// 100 x 100 x 50 mm with cells of `finest_m` under the middle of the surface.
mechanics::Mesh graded_slab(const std::array<int, 3>& cells, double finest_m);

// n + 1 coordinates 0..length, finest at 0: x = length (exp(2.5 i/n) - 1)/(exp(2.5) - 1). Doubling n halves
// every cell, so that the meshes of a series are nested.
Eigen::VectorXd nested_coordinates_m(double length_m, int n);

// A hand's path over a patch of +-2 mm about (x, y), sampled at 1 kHz, at depth 2 mm +- 10 %.
mechanics::Tool tool_on_path(int i, double x_m, double y_m);

// Fills nodes and equations, and the offline cost: the least of the repetitions of `prepare`.
void set_size(const mechanics::Problem& problem, const mechanics::Factored& factored, AccuracyRow& row);
void set_offline(const Timing& timing, AccuracyRow& row);
void set_steps(const Timing& timing, AccuracyRow& row);

// Root mean square and greatest magnitude, in per cent.
struct ErrorSum {
    double squares = 0.0;
    double worst = 0.0;
    int count = 0;
};
void add_error(double relative, ErrorSum& sum);
void set_error(const ErrorSum& sum, AccuracyRow& row);

inline double compliance_MB(const mechanics::Compliance& c) {
    return 8e-6 * static_cast<double>(c.normal_m_per_N.size() + c.full_m_per_N.size());
}

}  // namespace palpa::accuracy
