#include "mechanics/sphere_press.h"

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/supports.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr double kQuarters = 4.0;

Mesh quarter_of(const SpherePressBlock& block) {
    const auto from_origin = [&](double length_m) {
        return graded_coordinates_m(length_m, block.cells, 0.0, block.finest_m);
    };
    const double height_m = block.size_m[2];
    return hex_box(from_origin(0.5 * block.size_m[0]), from_origin(0.5 * block.size_m[1]),
                   graded_coordinates_m(height_m, block.cells, height_m, block.finest_m));
}

Supports supports_of(const Mesh& mesh) {
    const Faces outer = boundary_faces(mesh);
    Supports supports;
    fix(nodes_of(faces_on(mesh, outer, Side::zmin)), "xyz", 0.0, supports);
    fix(nodes_of(faces_on(mesh, outer, Side::xmin)), "x", 0.0, supports);
    fix(nodes_of(faces_on(mesh, outer, Side::ymin)), "y", 0.0, supports);
    return supports;
}

// The pattern of the free equations, and where each of its values stands in the whole tangent.
void take_equations(const Mesh& mesh, SpherePress& press) {
    const Reduction reduction = make_reduction(mesh, supports_of(mesh), {});
    press.equation = reduction.equation;
    LowerMatrix K = tangent_pattern(press.body);
    for (Index i = 0; i < K.nonZeros(); ++i) K.valuePtr()[i] = static_cast<double>(i);
    press.reduced = reduce(K, reduction);
    press.source.resize(static_cast<std::size_t>(press.reduced.nonZeros()));
    for (std::size_t i = 0; i < press.source.size(); ++i)
        press.source[i] = static_cast<int>(std::lround(press.reduced.valuePtr()[i]));
    analyse(press.reduced, press.factor);
}

void take_touch_nodes(const Mesh& mesh, SpherePress& press) {
    const double reach_m = 1.3 * press.block.radius_m;
    for (Index i = 0; i < mesh.nodes_m.cols(); ++i) {
        const Vector3d x = mesh.nodes_m.col(i);
        if (x.z() > press.block.size_m[2] * (1.0 - 1e-9) && x.head<2>().norm() <= reach_m)
            press.touch.push_back(static_cast<int>(i));
    }
}

void check_block(const SpherePressBlock& block, double greatest_depth_m) {
    const double most_m = std::min(0.6 * block.size_m[2], block.radius_m);
    if (!(greatest_depth_m > 0.0) || !(greatest_depth_m < most_m))
        throw LoadError(text("a sphere at a depth of ", greatest_depth_m, " m; wanted more than 0 and less than ",
                             most_m, " m (the radius, and 0.6 of the block's height)"));
    const double half_m = 0.5 * std::min(block.size_m[0], block.size_m[1]);
    if (block.radius_m > half_m)
        throw LoadError(
            text("a sphere of radius ", block.radius_m, " m; wanted at most half the block's width, ", half_m, " m"));
}

// Gaps and normals of the touch nodes with the sphere at a depth.
void place_sphere(const SpherePress& press, double depth_m, SpherePressWork& work) {
    const Vector3d centre_m(0.0, 0.0, press.block.size_m[2] + press.block.radius_m - depth_m);
    for (std::size_t k = 0; k < press.touch.size(); ++k) {
        const Index node = press.touch[k];
        const Vector3d away_m = press.body.mesh.nodes_m.col(node) + work.u_m.col(node) - centre_m;
        const double distance_m = std::max(away_m.norm(), 1e-12);
        work.normal.col(static_cast<Index>(k)) = away_m / distance_m;
        work.gap_m(static_cast<Index>(k)) = distance_m - press.block.radius_m;
    }
}

// Takes the curvature of the contact out of the tangent's diagonal blocks.
void subtract_curvature(const SpherePress& press, SpherePressWork& work) {
    for (std::size_t k = 0; k < press.touch.size(); ++k) {
        const auto column = static_cast<Index>(k);
        const double distance_m = work.gap_m(column) + press.block.radius_m;
        const double p = work.p_N(column) / distance_m;
        if (!(p > 0.0)) continue;
        const Vector3d n = work.normal.col(column);
        for (int c = 0; c < 3; ++c) {
            double* value = work.K_N_per_m.valuePtr() + work.K_N_per_m.outerIndexPtr()[3 * press.touch[k] + c];
            for (int r = c; r < 3; ++r) value[r - c] -= p * ((r == c ? 1.0 : 0.0) - n(r) * n(c));
        }
    }
}

bool factor_free(const SpherePress& press, SpherePressWork& work) {
    for (std::size_t i = 0; i < press.source.size(); ++i)
        work.A.valuePtr()[i] = work.K_N_per_m.valuePtr()[press.source[i]];
    return try_factor(work.A, work.factor) == 0;
}

// The tangent with the curvature of the contact; without it, and then without negative eigenvalues of cells, where it has
// no factor.
bool factor_tangent_of(const SpherePress& press, SpherePressWork& work) {
    if (!std::isfinite(energy_tangent_N_per_m(press.body, work.u_m, Tangent::exact, work.gradient_N, work.K_N_per_m)))
        return false;
    subtract_curvature(press, work);
    if (factor_free(press, work)) return true;
    for (const Tangent kind : {Tangent::exact, Tangent::positive}) {
        energy_tangent_N_per_m(press.body, work.u_m, kind, work.gradient_N, work.K_N_per_m);
        if (factor_free(press, work)) return true;
    }
    return false;
}

// Column 0: the forces of the body at free dofs; then the normal of each touch node.
void fill_right_hand_sides(const SpherePress& press, SpherePressWork& work) {
    work.block.setZero();
    for (std::size_t dof = 0; dof < press.equation.size(); ++dof) {
        if (press.equation[dof] >= 0) work.block(press.equation[dof], 0) = -work.gradient_N.data()[dof];
    }
    for (std::size_t k = 0; k < press.touch.size(); ++k) {
        for (int c = 0; c < 3; ++c) {
            const int equation = press.equation[at(3 * press.touch[k] + c)];
            if (equation >= 0) work.block(equation, static_cast<Index>(k) + 1) = work.normal(c, static_cast<Index>(k));
        }
    }
}

double along_normal_m(const SpherePress& press, const SpherePressWork& work, Index k, Index column) {
    double sum_m = 0.0;
    for (int c = 0; c < 3; ++c) {
        const int equation = press.equation[at(3 * press.touch[at(k)] + c)];
        if (equation >= 0) sum_m += work.normal(c, k) * work.block(equation, column);
    }
    return sum_m;
}

double out_of_balance_N(const SpherePress& press, const SpherePressWork& work) {
    double most_N = 0.0;
    for (Index dof = 0; dof < static_cast<Index>(press.equation.size()); ++dof) {
        const int equation = press.equation[at(dof)];
        if (equation < 0) continue;
        double left_N = work.block(equation, 0);
        for (Index k = 0; k < work.p_N.size(); ++k) left_N += work.p_N(k) * work.block(equation, k + 1);
        most_N = std::max(most_N, std::abs(left_N));
    }
    return most_N;
}

// Moves by the step, or by a part of it where the law is not defined at its end.
bool move_by_step(const SpherePress& press, SpherePressWork& work) {
    double share = 1.0;
    for (int i = 0; i < 12; ++i, share *= 0.5) {
        work.trial_m = work.u_m;
        for (std::size_t dof = 0; dof < press.equation.size(); ++dof) {
            const int equation = press.equation[dof];
            if (equation < 0) continue;
            double step_m = work.block(equation, 0);
            for (const int k : work.lcp.set) step_m += work.p_N(k) * work.block(equation, k + 1);
            work.trial_m.data()[dof] += share * step_m;
        }
        if (!std::isfinite(energy_J(press.body, work.trial_m))) continue;
        work.u_m.swap(work.trial_m);
        return true;
    }
    return false;
}

}  // namespace

SpherePress make_sphere_press(const SpherePressBlock& block, double greatest_depth_m) {
    if (!banded_built_in()) throw SolverError("a soft block is computed on the desk: this build is without LAPACK", 0);
    check_block(block, greatest_depth_m);
    SpherePress press;
    press.block = block;
    press.greatest_depth_m = greatest_depth_m;
    const Mesh mesh = quarter_of(block);
    press.body =
        make_large_body(mesh, Element::hex8_bbar,
                        std::vector<LargeMaterial>(static_cast<std::size_t>(mesh.cells.cols()), block.material));
    take_equations(mesh, press);
    take_touch_nodes(mesh, press);
    return press;
}

SpherePressWork make_work(const SpherePress& press) {
    SpherePressWork work;
    const Index nodes = press.body.mesh.nodes_m.cols();
    const auto touch = static_cast<Index>(press.touch.size());
    for (Eigen::Matrix3Xd* values : {&work.u_m, &work.gradient_N, &work.trial_m}) values->setZero(3, nodes);
    work.p_N.setZero(touch);
    work.normal.setZero(3, touch);
    work.gap_m.setZero(touch);
    work.K_N_per_m = tangent_pattern(press.body);
    work.A = press.reduced;
    work.factor = press.factor;
    work.block.setZero(press.reduced.cols(), touch + 1);
    work.compliance_m_per_N.setZero(touch, touch);
    work.b_m.setZero(touch);
    work.slope.setZero(touch);
    work.lcp = make_lcp_work(static_cast<int>(touch));
    step_to(press, 0.0, work);  // the solver takes its scratch memory
    work.u_m.setZero();
    work.p_N.setZero();
    return work;
}

SpherePressAnswer step_to(const SpherePress& press, double depth_m, SpherePressWork& work) noexcept {
    SpherePressAnswer out;
    out.valid = false;
    if (!std::isfinite(depth_m)) return out;
    const double depth = std::clamp(depth_m, 0.0, press.greatest_depth_m);
    place_sphere(press, depth, work);
    if (!factor_tangent_of(press, work)) return out;
    fill_right_hand_sides(press, work);
    out.residual_N = out_of_balance_N(press, work);
    solve_in_place(work.factor, work.block);
    const Index m = work.p_N.size();
    for (Index k = 0; k < m; ++k) {
        work.b_m(k) = work.gap_m(k) + along_normal_m(press, work, k, 0);
        for (Index j = 0; j <= k; ++j)
            work.compliance_m_per_N(k, j) = work.compliance_m_per_N(j, k) = along_normal_m(press, work, k, j + 1);
    }
    if (solve_lcp(work.compliance_m_per_N, work.b_m, work.lcp, work.p_N) != LcpStatus::solved ||
        !move_by_step(press, work)) {
        work.p_N.setZero();
        return out;
    }
    work.depth_m = depth;
    out.force_N = -kQuarters * work.normal.row(2).dot(work.p_N);
    work.b_m = work.normal.row(2).transpose();
    solve_on_set(work.lcp, work.b_m, work.slope);
    out.slope_N_per_m = kQuarters * work.b_m.dot(work.slope);
    out.valid = std::isfinite(out.force_N) && std::isfinite(out.slope_N_per_m);
    return out;
}

SpherePressAnswer converge_at(const SpherePress& press, double depth_m, SpherePressWork& work) noexcept {
    SpherePressAnswer out;
    for (int i = 0; i < 60; ++i) {
        const double before_N = out.force_N;
        out = step_to(press, depth_m, work);
        if (!out.valid) return out;
        const double size_N = std::max(work.p_N.maxCoeff(), 1e-9);
        if (i > 0 && out.residual_N <= 1e-9 * size_N && std::abs(out.force_N - before_N) <= 1e-9 * out.force_N + 1e-12)
            return out;
    }
    out.valid = false;
    return out;
}

}  // namespace palpa::mechanics
