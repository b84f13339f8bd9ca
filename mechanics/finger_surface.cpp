// The surface under the last press of a finger.

#include <algorithm>

#include "mechanics/finger.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

// Nodes i0 <= i < i1, j0 <= j < j1 of the grid.
struct NodeBox {
    int i0 = 0;
    int i1 = 0;
    int j0 = 0;
    int j1 = 0;
};

// Fills the stencils of the points. Returns the nodes that they need.
NodeBox find_stencils(const Eigen::Ref<const Eigen::Matrix2Xd>& points_m, FingerWork& w) {
    w.stencil.clear();
    NodeBox box{static_cast<int>(w.grid.x.at_m.size()), 0, static_cast<int>(w.grid.y.at_m.size()), 0};
    for (Index k = 0; k < points_m.cols(); ++k) {
        const Stencil x = stencil_at(w.grid.x, points_m(0, k));
        const Stencil y = stencil_at(w.grid.y, points_m(1, k));
        box = {std::min(box.i0, x.first), std::max(box.i1, x.first + x.count), std::min(box.j0, y.first),
               std::max(box.j1, y.first + y.count)};
        w.stencil.push_back(x);
        w.stencil.push_back(y);
    }
    return box;
}

// Computes u = C f on the nodes of a box.
void depress(const Compliance& c, const NodeBox& box, FingerWork& w) {
    const int n_x = static_cast<int>(w.grid.x.at_m.size());
    const int width = box.i1 - box.i0;
    for (int j = box.j0; j < box.j1; ++j) w.u_m.segment(box.i0 + n_x * j, width).setZero();
    for (const NodeRun& run : w.run) {
        for (int k = 0; k < run.count; ++k) {
            const double force_N = w.surface_scale * w.force_N(run.offset + k);
            if (force_N == 0.0) continue;
            const auto C = c.normal_m_per_N.col(run.first + k);
            for (int j = box.j0; j < box.j1; ++j)
                w.u_m.segment(box.i0 + n_x * j, width) += force_N * C.segment(box.i0 + n_x * j, width);
        }
    }
}

}  // namespace

void finger_surface_m(const Compliance& c, FingerWork& w, const Eigen::Ref<const Eigen::Matrix2Xd>& points_m,
                      Eigen::Ref<Eigen::VectorXd> out_m) {
    out_m.setZero();
    if (!(w.surface_scale > 0.0) || points_m.cols() == 0 || !points_m.allFinite()) return;
    const NodeBox box = find_stencils(points_m, w);
    depress(c, box, w);
    const int n_x = static_cast<int>(w.grid.x.at_m.size());
    const int width = box.i1 - box.i0;
    auto row_m = w.row_m.segment(box.i0, width);  // the surface along x at the points' y, which neighbours share
    for (Index k = 0; k < points_m.cols(); ++k) {
        const Stencil& x = w.stencil[static_cast<std::size_t>(2 * k)];
        const Stencil& y = w.stencil[static_cast<std::size_t>(2 * k + 1)];
        if (k == 0 || points_m(1, k) != points_m(1, k - 1)) {
            row_m.setZero();
            for (int b = 0; b < y.count; ++b) row_m += y.weight[b] * w.u_m.segment(box.i0 + n_x * (y.first + b), width);
        }
        for (int a = 0; a < x.count; ++a) out_m(k) += x.weight[a] * w.row_m(x.first + a);
    }
}

void finger_pressure_Pa(const Compliance& c, FingerWork& w, const Eigen::Ref<const Eigen::Matrix2Xd>& points_m,
                        Eigen::Ref<Eigen::VectorXd> out_Pa) {
    out_Pa.setZero();
    if (!(w.surface_scale > 0.0) || !points_m.allFinite()) return;
    w.u_m.setZero();  // for a moment: the pressure of each node
    for (const NodeRun& run : w.run) {
        w.u_m.segment(run.first, run.count) = w.surface_scale * w.force_N.segment(run.offset, run.count).array() /
                                              c.area_m2.segment(run.first, run.count).array();
    }
    const auto n_x = w.grid.x.at_m.size();
    for (Index k = 0; k < points_m.cols(); ++k) {
        const int i = cell_of(w.grid.x, points_m(0, k));
        const int j = cell_of(w.grid.y, points_m(1, k));
        const double r = (points_m(0, k) - w.grid.x.at_m(i)) / (w.grid.x.at_m(i + 1) - w.grid.x.at_m(i));
        const double s = (points_m(1, k) - w.grid.y.at_m(j)) / (w.grid.y.at_m(j + 1) - w.grid.y.at_m(j));
        if (r < 0.0 || r > 1.0 || s < 0.0 || s > 1.0) continue;
        const Index node = i + n_x * j;
        out_Pa(k) = (1.0 - s) * ((1.0 - r) * w.u_m(node) + r * w.u_m(node + 1)) +
                    s * ((1.0 - r) * w.u_m(node + n_x) + r * w.u_m(node + n_x + 1));
    }
}

}  // namespace palpa::mechanics
