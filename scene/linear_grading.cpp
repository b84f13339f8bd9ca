// Blocks whose surface nodes are finer around a place.

#include <algorithm>
#include <cmath>

#include "files/input_error.h"
#include "files/text.h"
#include "scene/linear_tissue.h"

namespace palpa::scene {
namespace {

constexpr double kMostDrawn = 96.0;  // nodes along an axis

}  // namespace

void check_grading(const LinearOptions& options, const stiffnessmaps::Phantom& phantom) {
    if (!options.grading) return;
    for (const std::size_t axis : {0u, 1u}) {
        const double centre_m = options.grading->centre_m[axis];
        if (centre_m <= phantom.size_m[axis]) continue;
        throw files::bad_input(
            options.phantom.string(), "",
            std::string("grading around ") + (axis == 0 ? "x = " : "y = ") + files::short_number(1e3 * centre_m) +
                " mm",
            "a place on the block, up to " + files::short_number(1e3 * phantom.size_m[axis]) + " mm");
    }
}

void take_grid(LinearTissue& tissue) {
    tissue.graded = mechanics::surface_grid(tissue.compliance);
    const auto least_m = [](const mechanics::GridAxis& axis) {
        const Eigen::Index n = axis.at_m.size() - 1;
        return (axis.at_m.tail(n) - axis.at_m.head(n)).minCoeff();
    };
    tissue.spacing_m[0] = least_m(tissue.graded->x);
    tissue.spacing_m[1] = least_m(tissue.graded->y);
}

double spacing_at_m(const LinearTissue& tissue, const Eigen::Vector2d& p_m) {
    if (!tissue.graded || !p_m.allFinite()) return std::min(tissue.spacing_m[0], tissue.spacing_m[1]);
    const auto cell_m = [](const mechanics::GridAxis& axis, double place_m) {
        const int cell = mechanics::cell_of(axis, place_m);
        return axis.at_m(cell + 1) - axis.at_m(cell);
    };
    return std::min(cell_m(tissue.graded->x, p_m.x()), cell_m(tissue.graded->y, p_m.y()));
}

void spread_evenly(const LinearTissue& tissue, const Eigen::VectorXd& node_sink_m, SurfaceShape& shape) {
    const mechanics::SurfaceGrid& grid = *tissue.graded;
    const auto even = [](double length_m, double spacing_m) {
        return static_cast<Eigen::Index>(std::clamp(std::ceil(length_m / spacing_m) + 1.0, 2.0, kMostDrawn));
    };
    shape.n_x = even(tissue.phantom.size_m[0], tissue.spacing_m[0]);
    shape.n_y = even(tissue.phantom.size_m[1], tissue.spacing_m[1]);
    shape.spacing_m = {tissue.phantom.size_m[0] / static_cast<double>(shape.n_x - 1),
                       tissue.phantom.size_m[1] / static_cast<double>(shape.n_y - 1)};
    const auto rows = static_cast<Eigen::Index>(tissue.n_y);
    const Eigen::Map<const Eigen::MatrixXd> node_m(node_sink_m.data(), static_cast<Eigen::Index>(tissue.n_x), rows);
    Eigen::MatrixXd row_sink_m(shape.n_x, rows);
    for (Eigen::Index i = 0; i < shape.n_x; ++i) {
        const mechanics::Stencil at = mechanics::stencil_at(grid.x, static_cast<double>(i) * shape.spacing_m.x());
        row_sink_m.row(i).setZero();
        for (int k = 0; k < at.count; ++k) row_sink_m.row(i) += at.weight[k] * node_m.row(at.first + k);
    }
    shape.sink_m.setZero(shape.n_x * shape.n_y);
    for (Eigen::Index j = 0; j < shape.n_y; ++j) {
        const mechanics::Stencil at = mechanics::stencil_at(grid.y, static_cast<double>(j) * shape.spacing_m.y());
        for (int k = 0; k < at.count; ++k)
            shape.sink_m.segment(j * shape.n_x, shape.n_x) += at.weight[k] * row_sink_m.col(at.first + k);
    }
}

}  // namespace palpa::scene
