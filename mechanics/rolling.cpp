#include "mechanics/rolling.h"

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/rolling_mesh.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

constexpr double kWorstViolation = 1e-6;  // of the depth: accepted from a slide that does not settle

// The four sample lines around a point, or the outermost four at the ends, with Lagrange's weights on them.
struct RollingStencil {
    int first = 0;
    double weight[4] = {0.0, 0.0, 0.0, 0.0};
    bool inside = false;
};
RollingStencil stencil_at(const std::vector<double>& lines_m, double x_m) {
    RollingStencil out;
    constexpr double kRounding = 1e-12;
    if (x_m < lines_m.front() - kRounding || x_m > lines_m.back() + kRounding) return out;
    const auto above = std::upper_bound(lines_m.begin(), lines_m.end(), x_m) - lines_m.begin();
    out.inside = true;
    out.first = std::clamp(static_cast<int>(above) - 2, 0, static_cast<int>(lines_m.size()) - 4);
    for (int k = 0; k < 4; ++k) {
        double w = 1.0;
        for (int l = 0; l < 4; ++l) {
            if (l == k) continue;
            const double from_m = lines_m[at(out.first + l)];
            w *= (x_m - from_m) / (lines_m[at(out.first + k)] - from_m);
        }
        out.weight[k] = w;
    }
    return out;
}

// The stencils of the patch's nodes in one table, and the window of sample lines that they use.
struct Window {
    std::vector<RollingStencil> sx, sy;
    int low_x = 1 << 20, high_x = -1, low_y = 1 << 20, high_y = -1;
};
Window window_of(const PairTable& table, const RollingWork& work) {
    Window out;
    for (std::size_t p = 0; p < work.lattice_x.size(); ++p) {
        out.sx.push_back(stencil_at(table.x_m, work.lattice_x[p]));
        out.sy.push_back(stencil_at(table.y_m, work.lattice_y[p]));
        if (!out.sx.back().inside || !out.sy.back().inside) continue;
        out.low_x = std::min(out.low_x, out.sx.back().first);
        out.high_x = std::max(out.high_x, out.sx.back().first + 3);
        out.low_y = std::min(out.low_y, out.sy.back().first);
        out.high_y = std::max(out.high_y, out.sy.back().first + 3);
    }
    return out;
}

// Adds one list of a smooth part to a matrix of the patch, as P D P^T: D holds the values between the sample nodes
// around the patch, P interpolates from them to the patch's nodes. The first point of the list is the row of the
// matrix; of a symmetric matrix only the lower triangle is filled.
void add_part(const PairTable& table, const std::vector<double>& values, const Window& window, bool symmetric,
              RollingWork& work, Eigen::MatrixXd& out) {
    const auto n = static_cast<int>(work.lattice_x.size());
    const int low_x = window.low_x;
    const int low_y = window.low_y;
    const int n_x = window.high_x - low_x + 1;
    const int n_y = window.high_y - low_y + 1;
    const int w_x = 2 * table.reach_x + 1;
    const int w_y = 2 * table.reach_y + 1;
    work.local.setZero(n_x * n_y, n_x * n_y);
    for (int jy = 0; jy < n_y; ++jy) {
        for (int jx = 0; jx < n_x; ++jx) {
            const int node = (low_y + jy) * static_cast<int>(table.x_m.size()) + low_x + jx;
            for (int iy = 0; iy < n_y; ++iy) {
                for (int ix = 0; ix < n_x; ++ix) {
                    const int dx = ix - jx + table.reach_x;
                    const int dy = iy - jy + table.reach_y;
                    if (dx < 0 || dx >= w_x || dy < 0 || dy >= w_y) continue;
                    work.local(iy * n_x + ix, jy * n_x + jx) = values[at(node) * at(w_x * w_y) + at(dy * w_x + dx)];
                }
            }
        }
    }
    // first D P^T, column by column, then P times that; P has 16 entries per row
    work.half.setZero(n_x * n_y, n);
    const auto for_entries = [&](int p, auto&& f) {
        const RollingStencil& x = window.sx[at(p)];
        const RollingStencil& y = window.sy[at(p)];
        if (!x.inside || !y.inside) return;
        for (int l = 0; l < 4; ++l) {
            for (int k = 0; k < 4; ++k) f((y.first + l - low_y) * n_x + x.first + k - low_x, x.weight[k] * y.weight[l]);
        }
    };
    for (int p = 0; p < n; ++p) {
        for_entries(p, [&](int node, double w) { work.half.col(p) += w * work.local.col(node); });
    }
    for (int p = 0; p < n; ++p) {
        for (int q = symmetric ? p : 0; q < n; ++q) {
            double sum = 0.0;
            for_entries(q, [&](int node, double w) { sum += w * work.half(node, p); });
            (symmetric ? out(q, p) : out(p, q)) += sum;
        }
    }
}

void place_node(const RollingModel& model, double x_m, double y_m, int i, int j, RollingWork& work) {
    if (x_m < 0.0 || x_m > model.size_m[0] || y_m < 0.0 || y_m > model.size_m[1]) return;
    work.lattice_x.push_back(x_m);
    work.lattice_y.push_back(y_m);
    work.lattice_i.push_back(i);
    work.lattice_j.push_back(j);
}

// Lists the nodes of the lattice under the tool that lie on the block. Along a cylinder they stand in the middle of
// equal cells, so that their areas end where the cylinder ends.
void place_lattice(const RollingModel& model, double h, double x_m, double y_m, RollingWork& work) {
    for (auto* list : {&work.lattice_x, &work.lattice_y}) list->clear();
    for (auto* list : {&work.lattice_i, &work.lattice_j}) list->clear();
    const int most = static_cast<int>(footprint_m(model)[0] / h);
    if (model.shape == IndenterShape::cylinder) {
        const auto rows = static_cast<int>(std::lround(model.length_m / h));
        for (int j = 0; j < rows; ++j) {
            for (int i = -most; i <= most; ++i) {
                if (h * std::abs(i) >= model.radius_m) continue;
                place_node(model, x_m + h * i, y_m + h * (j - 0.5 * (rows - 1)), i, j, work);
            }
        }
        return;
    }
    for (int j = -most; j <= most; ++j) {
        for (int i = -most; i <= most; ++i) {
            if (h * h * (i * i + j * j) >= model.radius_m * model.radius_m) continue;
            place_node(model, x_m + h * i, y_m + h * j, i, j, work);
        }
    }
}

// Fills in how pressing one node of the lattice moves the others sideways on the plain layer, an odd function of the
// offset.
void fill_along(const LayerKernel& kernel, RollingWork& work) {
    const auto n = static_cast<int>(work.lattice_x.size());
    Compliance& patch = work.patch;
    patch.along_x_m_per_N.resize(n, n);
    patch.along_y_m_per_N.resize(n, n);
    for (int p = 0; p < n; ++p) {
        for (int q = 0; q < n; ++q) {
            const int i = work.lattice_i[at(q)] - work.lattice_i[at(p)];
            const int j = work.lattice_j[at(q)] - work.lattice_j[at(p)];
            const std::size_t offset = at(std::abs(j) * kernel.n_x + std::abs(i));
            patch.along_x_m_per_N(q, p) = i < 0 ? -kernel.along_x[offset] : kernel.along_x[offset];
            patch.along_y_m_per_N(q, p) = j < 0 ? -kernel.along_y[offset] : kernel.along_y[offset];
        }
    }
}

void fill_patch(const RollingModel& model, const RollingMesh& mesh, const RollingTables& tables, RollingWork& work) {
    const auto n = static_cast<int>(work.lattice_x.size());
    Compliance& patch = work.patch;
    patch.revision = new_revision();  // makes a cold start, so that results do not depend on the order of places
    patch.n_touch = n;
    patch.node.resize(at(n));
    patch.position_m.resize(3, n);
    patch.area_m2.setConstant(n, mesh.contact_m * mesh.contact_m);
    patch.surface_z_m = 0.0;
    patch.thickness_m = model.size_m[2];
    patch.normal_m_per_N.resize(n, n);
    for (int p = 0; p < n; ++p) {
        patch.node[at(p)] = p;
        patch.position_m.col(p) << work.lattice_x[at(p)], work.lattice_y[at(p)], 0.0;
        for (int q = p; q < n; ++q) {
            const int i = std::abs(work.lattice_i[at(p)] - work.lattice_i[at(q)]);
            const int j = std::abs(work.lattice_j[at(p)] - work.lattice_j[at(q)]);
            patch.normal_m_per_N(q, p) = tables.contact.value[at(j * tables.contact.n_x + i)];
        }
    }
    const bool rough = model.friction > 0.0;
    if (rough) fill_along(tables.contact, work);
    for (const PairTable& part : tables.parts) {
        const Window window = window_of(part, work);
        if (window.high_x < 0) continue;
        add_part(part, part.value, window, true, work, patch.normal_m_per_N);
        if (!rough) continue;
        add_part(part, part.along_x, window, false, work, patch.along_x_m_per_N);
        add_part(part, part.along_y, window, false, work, patch.along_y_m_per_N);
    }
    patch.normal_m_per_N.triangularView<Eigen::StrictlyUpper>() = patch.normal_m_per_N.transpose();
}

void check_settled(const RollingModel& model, const Tool& tool, const Contact& answer) {
    if (!answer.flags.not_settled || answer.violation_m <= kWorstViolation * tool.pose.depth_m) return;
    throw SolverError(text("with a friction coefficient of ", model.friction, " the contact at ", 1e3 * tool.pose.x_m,
                           ", ", 1e3 * tool.pose.y_m, " mm, ", 1e3 * tool.pose.depth_m,
                           " mm deep does not settle: ", 1e3 * answer.violation_m, " mm of error left"),
                      0);
}

}  // namespace

RollingForce force_at(const RollingModel& model, const Compliance& compliance, const Tool& tool, RollingWork& work) {
    if (!(model.friction > 0.0)) {
        press_to_depth(compliance, {&tool, 1}, {}, work.contact, work.answer);
        check_settled(model, tool, work.answer);
        const ToolForce& f = work.answer.tool[0];
        return {f.normal_N, f.tangential_x_N, f.tangential_y_N, work.answer.energy_J, f.area_m2};
    }
    RollingForce out;
    for (const bool along_y : {true, false}) {  // along x last, since the rest of the answer belongs to that slide
        const SteadySlide slide{along_y ? Eigen::Vector2d(0.0, 1.0) : Eigen::Vector2d(1.0, 0.0), model.friction};
        slide_steadily(compliance, tool, slide, work.slide, work.answer);
        check_settled(model, tool, work.answer);
        const ToolForce& f = work.answer.tool[0];
        (along_y ? out.tangential_y_N : out.tangential_x_N) = along_y ? f.tangential_y_N : f.tangential_x_N;
        out.normal_N = f.normal_N;
        out.area_m2 = f.area_m2;
    }
    out.energy_J = work.answer.energy_J;
    return out;
}

void roll_to(const RollingModel& model, const RollingMesh& mesh, const RollingTables& tables, double x_m, double y_m,
             std::span<const double> depths_m, RollingWork& work, std::vector<RollingForce>& out) {
    place_lattice(model, mesh.contact_m, x_m, y_m, work);
    if (work.lattice_x.empty()) {
        throw LoadError(text("rolling: the indenter at ", x_m, ", ", y_m, " m is off the tissue, 0..", model.size_m[0],
                             " x 0..", model.size_m[1], " m"));
    }
    fill_patch(model, mesh, tables, work);
    out.clear();
    for (const double depth_m : depths_m) {
        if (!(depth_m > 0.0 && depth_m < model.size_m[2])) {
            throw LoadError(text("rolling: depth ", depth_m, " m, but the tissue is ", model.size_m[2], " m thick"));
        }
        const Tool tool{indenter_of(model), {x_m, y_m, depth_m}};
        out.push_back(force_at(model, work.patch, tool, work));
    }
}

}  // namespace palpa::mechanics
