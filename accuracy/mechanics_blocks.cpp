#include "accuracy/mechanics_blocks.h"

#include <cmath>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace palpa::accuracy {

using namespace mechanics;

double heap_MB() {
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const struct mallinfo2 info = ::mallinfo2();
    return 1e-6 * static_cast<double>(info.uordblks + info.hblkhd);
#else
    return kUnknown;
#endif
}

Problem block(const Mesh& hexes, Element element, const Material& material) {
    Problem problem;
    problem.mesh = element == Element::tet4 ? split_to_tets(hexes) : hexes;
    problem.element = element;
    problem.materials.assign(static_cast<std::size_t>(problem.mesh.cells.cols()), material);
    fix(nodes_of(faces_on(problem.mesh, boundary_faces(problem.mesh), Side::zmin)), "xyz", 0.0, problem.supports);
    return problem;
}

Problem quarter_block(const Mesh& hexes, Element element, const Material& material) {
    Problem problem = block(hexes, element, material);
    const Faces outer = boundary_faces(problem.mesh);
    fix(nodes_of(faces_on(problem.mesh, outer, Side::xmin)), "x", 0.0, problem.supports);
    fix(nodes_of(faces_on(problem.mesh, outer, Side::ymin)), "y", 0.0, problem.supports);
    return problem;
}

Mesh graded_slab(const std::array<int, 3>& cells, double finest_m) {
    return hex_box(Box{{0.1, 0.1, 0.05}, cells, Grading{{0.05, 0.05}, finest_m}});
}

Eigen::VectorXd nested_coordinates_m(double length_m, int n) {
    constexpr double kStretch = 2.5;
    Eigen::VectorXd x(n + 1);
    for (int i = 0; i <= n; ++i) x(i) = length_m * std::expm1(kStretch * i / n) / std::expm1(kStretch);
    return x;
}

Tool tool_on_path(int i, double x_m, double y_m) {
    const double t = 1e-3 * i;
    return {
        kBenchBall,
        {x_m + 0.002 * std::sin(3.0 * t), y_m + 0.002 * std::sin(4.1 * t), 0.002 * (1.0 + 0.1 * std::sin(7.0 * t))}};
}

void set_size(const Problem& problem, const Factored& factored, AccuracyRow& row) {
    row.nodes = static_cast<int>(problem.mesh.nodes_m.cols());
    row.dofs = factored.reduction.equations;
}

void set_offline(const Timing& timing, AccuracyRow& row) {
    row.offline_s = 1e-6 * quantile_us(timing, 0.0);
    row.offline_repetitions = static_cast<int>(timing.us.size());
}

void set_steps(const Timing& timing, AccuracyRow& row) {
    row.per_step_us = quantile_us(timing, 0.5);
    row.per_step_p99_us = quantile_us(timing, 0.99);
    row.steps = static_cast<int>(timing.us.size());
}

void add_error(double relative, ErrorSum& sum) {
    sum.squares += relative * relative;
    sum.worst = std::max(sum.worst, std::abs(relative));
    ++sum.count;
}

void set_error(const ErrorSum& sum, AccuracyRow& row) {
    row.error_percent = 100.0 * std::sqrt(sum.squares / sum.count);
    row.worst_error_percent = 100.0 * sum.worst;
}

}  // namespace palpa::accuracy
