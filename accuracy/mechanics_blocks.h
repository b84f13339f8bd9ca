#pragma once
// The blocks that the measurements of mechanics press on, and the path of a tool over them; only those measurements use
// this header.

#include <string>

#include "accuracy/accuracy.h"
#include "accuracy/timing.h"
#include "mechanics/contact.h"

namespace palpa::accuracy {

inline constexpr mechanics::Material kBenchTissue{2500.0, 0.45};                           // Pa, Poisson's ratio
inline constexpr mechanics::Indenter kBenchBall{mechanics::IndenterShape::sphere, 0.008};  // radius 8 mm

// Returns a block of one material with its bottom clamped; tetrahedra come from splitting the hexahedra.
mechanics::Problem block(const mechanics::Mesh& hexes, mechanics::Element element, const mechanics::Material& material);
// Returns the quarter x >= 0, y >= 0 of such a block that is symmetric about both planes.
mechanics::Problem quarter_block(const mechanics::Mesh& hexes, mechanics::Element element,
                                 const mechanics::Material& material);

// Returns a slab of 100 x 100 x 50 mm with cells of `finest_m` under the middle of the surface.
mechanics::Mesh graded_slab(const std::array<int, 3>& cells, double finest_m);

// Returns n + 1 coordinates from 0 to length, finest at 0: x = length (exp(2.5 i/n) - 1)/(exp(2.5) - 1). Doubling n
// divides every cell into two, so that the meshes of a series are nested.
Eigen::VectorXd nested_coordinates_m(double length_m, int n);

// Returns the tool at sample i of a hand's path over a patch of +-2 mm about (x, y), at 1 kHz and at a depth of 2 mm +-
// 10 %.
mechanics::Tool tool_on_path(int i, double x_m, double y_m);

// Fill a row: nodes and equations; the least time of the preparation; median and 99th percentile of the steps.
void set_size(const mechanics::Problem& problem, const mechanics::Factored& factored, AccuracyRow& row);
void set_offline(const Timing& timing, AccuracyRow& row);
void set_steps(const Timing& timing, AccuracyRow& row);

// Sums for the root mean square and the greatest size of errors, which set_error() writes in per cent.
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
