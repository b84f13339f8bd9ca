#include "mechanics/rolling.h"

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

// Four sample lines around a point and Lagrange's weights on them; the outermost four at the ends.
struct Stencil {
    int first = 0;
    double weight[4] = {0.0, 0.0, 0.0, 0.0};
    bool inside = false;
};
Stencil stencil_at(const std::vector<double>& lines_m, double x_m) {
    Stencil out;
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

// Adds one smooth part to the compliance of the patch: P D P^T, D between the sample nodes around the patch, P
// the interpolation from them to the patch's nodes.
void add_part(const PairTable& table, RollingWork& work) {
    const auto n = static_cast<int>(work.lattice_x.size());
    std::vector<Stencil> sx, sy;
    int low_x = 1 << 20, high_x = -1, low_y = 1 << 20, high_y = -1;
    for (int p = 0; p < n; ++p) {
        sx.push_back(stencil_at(table.x_m, work.lattice_x[at(p)]));
        sy.push_back(stencil_at(table.y_m, work.lattice_y[at(p)]));
        if (!sx.back().inside || !sy.back().inside) continue;
        low_x = std::min(low_x, sx.back().first);
        high_x = std::max(high_x, sx.back().first + 3);
        low_y = std::min(low_y, sy.back().first);
        high_y = std::max(high_y, sy.back().first + 3);
    }
    if (high_x < 0) return;
    const int n_x = high_x - low_x + 1;
    const int n_y = high_y - low_y + 1;
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
                    work.local(iy * n_x + ix, jy * n_x + jx) =
                        table.value[at(node) * at(w_x * w_y) + at(dy * w_x + dx)];
                }
            }
        }
    }
    // D P^T column by column, then P of that; P has 16 entries a row
    work.half.setZero(n_x * n_y, n);
    const auto for_entries = [&](int p, auto&& f) {
        const Stencil& x = sx[at(p)];
        const Stencil& y = sy[at(p)];
        if (!x.inside || !y.inside) return;
        for (int l = 0; l < 4; ++l) {
            for (int k = 0; k < 4; ++k) f((y.first + l - low_y) * n_x + x.first + k - low_x, x.weight[k] * y.weight[l]);
        }
    };
    for (int p = 0; p < n; ++p) {
        for_entries(p, [&](int node, double w) { work.half.col(p) += w * work.local.col(node); });
    }
    Eigen::MatrixXd& C = work.patch.normal_m_per_N;
    for (int p = 0; p < n; ++p) {
        for (int q = p; q < n; ++q) {
            double sum = 0.0;
            for_entries(q, [&](int node, double w) { sum += w * work.half(node, p); });
            C(q, p) += sum;
        }
    }
}

// Nodes of the lattice under the tool that lie on the block.
void place_lattice(const RollingModel& model, double h, double x_m, double y_m, RollingWork& work) {
    for (auto* list : {&work.lattice_x, &work.lattice_y}) list->clear();
    for (auto* list : {&work.lattice_i, &work.lattice_j}) list->clear();
    const int most = static_cast<int>(model.radius_m / h);
    for (int j = -most; j <= most; ++j) {
        for (int i = -most; i <= most; ++i) {
            const double x = x_m + h * i;
            const double y = y_m + h * j;
            if (h * h * (i * i + j * j) >= model.radius_m * model.radius_m) continue;
            if (x < 0.0 || x > model.size_m[0] || y < 0.0 || y > model.size_m[1]) continue;
            work.lattice_x.push_back(x);
            work.lattice_y.push_back(y);
            work.lattice_i.push_back(i);
            work.lattice_j.push_back(j);
        }
    }
}

void fill_patch(const RollingModel& model, const RollingMesh& mesh, const RollingTables& tables, RollingWork& work) {
    const auto n = static_cast<int>(work.lattice_x.size());
    Compliance& patch = work.patch;
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
            patch.normal_m_per_N(q, p) = tables.contact.value[at(j * tables.contact.n + i)];
        }
    }
    for (const PairTable& part : tables.parts) add_part(part, work);
    patch.normal_m_per_N.triangularView<Eigen::StrictlyUpper>() = patch.normal_m_per_N.transpose();
}

}  // namespace

void roll_to(const RollingModel& model, const RollingMesh& mesh, const RollingTables& tables, double x_m,
             double y_m, std::span<const double> depths_m, RollingWork& work, std::vector<RollingForce>& out) {
    place_lattice(model, mesh.contact_m, x_m, y_m, work);
    if (work.lattice_x.empty()) {
        throw LoadError(text("rolling: the indenter at ", x_m, ", ", y_m, " m is off the tissue, 0..", model.size_m[0],
                             " x 0..", model.size_m[1], " m"));
    }
    fill_patch(model, mesh, tables, work);
    work.contact.matrix = nullptr;  // another compliance: a cold start, so that the order of places cannot matter
    out.clear();
    for (const double depth_m : depths_m) {
        if (!(depth_m > 0.0 && depth_m < model.size_m[2])) {
            throw LoadError(text("rolling: depth ", depth_m, " m, but the tissue is ", model.size_m[2], " m thick"));
        }
        const Tool tool{{IndenterShape::sphere, model.radius_m}, {x_m, y_m, depth_m}};
        press_to_depth(work.patch, {&tool, 1}, {}, work.contact, work.answer);
        const ToolForce& f = work.answer.tool[0];
        out.push_back({f.normal_N, f.tangential_x_N, f.tangential_y_N, work.answer.energy_J, f.area_m2});
    }
}

}  // namespace palpa::mechanics
