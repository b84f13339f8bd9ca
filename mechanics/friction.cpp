#include "mechanics/friction.h"

#include <algorithm>
#include <cmath>

#include "mechanics/contact_geometry.h"
#include "mechanics/error.h"
#include "mechanics/index.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

void make_room(Index n, FrictionWork& w) {
    if (w.C.rows() >= 3 * n) return;
    const Index room = 3 * (n + n / 2);
    w.C.resize(room, room);
    w.f_N.resize(room);
    w.u_m.resize(room);
    w.u_before_m.resize(room);
}

// Gathers the compliance between the candidates, the forces that they carried before, and their displacements at the
// last step.
void gather(const Compliance& c, const FrictionState& state, FrictionWork& w) {
    const auto n = static_cast<Index>(w.contact.candidate.size());
    make_room(n, w);
    for (Index j = 0; j < n; ++j) {
        for (Index i = 0; i < n; ++i) {
            w.C.block<3, 3>(3 * i, 3 * j) =
                c.full_m_per_N.block<3, 3>(3 * w.contact.candidate[at(i)], 3 * w.contact.candidate[at(j)]);
        }
    }
    w.f_N.head(3 * n).setZero();
    w.u_before_m.head(3 * n).setZero();
    for (std::size_t k = 0; k < state.touch.size(); ++k) {
        const Eigen::Map<const Eigen::Vector3d> force(&state.force_N[3 * k]);
        for (Index i = 0; i < n; ++i) {
            const int touch = w.contact.candidate[at(i)];
            w.u_before_m.segment<3>(3 * i) += c.full_m_per_N.block<3, 3>(3 * touch, 3 * state.touch[k]) * force;
            if (touch == state.touch[k]) w.f_N.segment<3>(3 * i) = force;
        }
    }
    w.u_m.head(3 * n).noalias() = w.C.topLeftCorner(3 * n, 3 * n) * w.f_N.head(3 * n);
}

// Returns the force of candidate i after one step of block Gauss-Seidel: pressing, x, y.
Eigen::Vector3d updated_force_N(const FrictionWork& w, Index i, const Eigen::Vector2d& move_m, double friction) {
    const Eigen::Vector3d f = w.f_N.segment<3>(3 * i);
    const Eigen::Vector3d u = w.u_m.segment<3>(3 * i);
    const auto Cii = w.C.block<3, 3>(3 * i, 3 * i);
    Eigen::Vector3d next;
    next(0) = std::max(0.0, f(0) - (u(0) - w.contact.delta_m[at(i)]) / Cii(0, 0));
    const double half = 0.5 * (Cii(1, 1) - Cii(2, 2));
    const double rho = 0.5 * (Cii(1, 1) + Cii(2, 2)) + std::hypot(half, Cii(1, 2));
    const Eigen::Vector2d slip = u.tail<2>() - w.u_before_m.segment<2>(3 * i + 1) - move_m;
    const Eigen::Vector2d t = f.tail<2>() - slip / rho;
    const double limit = friction * next(0);
    const double size = t.norm();
    next.tail<2>() = size > limit ? Eigen::Vector2d(t * (limit / size)) : t;
    return next;
}

// Returns whether the forces settled.
bool sweep_until_settled(const Eigen::Vector2d& move_m, const FrictionOptions& options, FrictionWork& w) {
    const auto n = static_cast<Index>(w.contact.candidate.size());
    for (int sweep = 0; sweep < options.sweeps; ++sweep) {
        double change = 0.0;
        double largest = 0.0;
        for (Index i = 0; i < n; ++i) {
            const Eigen::Vector3d next = updated_force_N(w, i, move_m, options.coefficient);
            const Eigen::Vector3d df = next - w.f_N.segment<3>(3 * i);
            largest = std::max(largest, next(0));
            if (df.isZero(0.0)) continue;
            change = std::max(change, df.cwiseAbs().maxCoeff());
            w.f_N.segment<3>(3 * i) = next;
            for (int c = 0; c < 3; ++c) w.u_m.head(3 * n) += df(c) * w.C.col(3 * i + c).head(3 * n);
        }
        if (change <= options.tolerance * largest) return true;
    }
    return false;
}

// Does a node carry force that lies more than this below the undeformed tool?
bool touches_beyond(double below_m, const FrictionWork& w) {
    for (std::size_t i = 0; i < w.contact.candidate.size(); ++i) {
        if (w.f_N(3 * static_cast<Index>(i)) > 0.0 && w.contact.delta_m[i] < -below_m) return true;
    }
    return false;
}

void collect(const Compliance& c, const Pose& pose, const FrictionWork& w, FrictionState& state, Contact& out) {
    out.touch.clear();
    out.by_tool.clear();
    out.force_N.clear();
    out.energy_J = 0.0;
    out.violation_m = 0.0;
    state.touch.clear();
    state.force_N.clear();
    ToolForce& force = out.tool[0];
    for (Index i = 0; i < static_cast<Index>(w.contact.candidate.size()); ++i) {
        const Eigen::Vector3d f = w.f_N.segment<3>(3 * i);
        out.violation_m = std::max(out.violation_m, w.contact.delta_m[at(i)] - w.u_m(3 * i));
        if (!(f(0) > 0.0)) continue;
        const int touch = w.contact.candidate[at(i)];
        out.touch.push_back(touch);
        out.by_tool.push_back(0);
        out.force_N.push_back(f(0));
        out.energy_J += 0.5 * f.dot(w.u_m.segment<3>(3 * i));
        force.normal_N += f(0);
        force.tangential_x_N += f(0) * w.contact.slope_x[at(i)] + f(1);
        force.tangential_y_N += f(0) * w.contact.slope_y[at(i)] + f(2);
        force.moment_x_Nm += f(0) * (c.position_m(1, touch) - pose.y_m);
        force.moment_y_Nm -= f(0) * (c.position_m(0, touch) - pose.x_m);
        force.area_m2 += c.area_m2(touch);
        state.touch.push_back(touch);
        state.force_N.insert(state.force_N.end(), f.data(), f.data() + 3);
    }
}

}  // namespace

FrictionWork make_friction_work(const Compliance& compliance, int most_in_reach) {
    FrictionWork work;
    prepare(compliance, work.contact);
    make_room(most_in_reach, work);
    return work;
}

void slide_to(const Compliance& compliance, const Tool& tool, const FrictionOptions& options, FrictionWork& work,
              FrictionState& state, Contact& contact) {
    if (compliance.full_m_per_N.rows() != 3 * compliance.n_touch) {
        throw LoadError("friction: the compliance has no tangential part; ask for it with tangential = true");
    }
    Pose pose = tool.pose;
    if (!std::isfinite(pose.x_m) || !std::isfinite(pose.y_m) || !std::isfinite(pose.depth_m)) {
        hold(1, contact);
        return;
    }
    prepare(compliance, work.contact);
    const double limit_m = std::min(options.max_depth_m, compliance.thickness_m);
    contact.flags = {};
    contact.flags.capped = pose.depth_m > limit_m;
    pose.depth_m = std::clamp(pose.depth_m, 0.0, limit_m);
    work.contact.tools.assign(1, {tool.indenter, pose});
    contact.flags.over_edge = reaches_beyond(work.contact.tools[0], work.contact.touch_box_m);
    contact.tool.assign(1, {});
    contact.tool[0].depth_m = pose.depth_m;

    const Eigen::Vector2d move_m = state.touching
                                       ? Eigen::Vector2d(pose.x_m - state.pose.x_m, pose.y_m - state.pose.y_m)
                                       : Eigen::Vector2d(0.0, 0.0);
    // the tissue may bulge up to the tool: the margin grows until no node in contact lies near the rim of the candidates
    for (double margin = 0.25;; margin *= 2.0) {
        find_candidates(compliance, work.contact.tools, margin, work.contact);
        gather(compliance, state, work);
        contact.flags.not_settled = !sweep_until_settled(move_m, options, work);
        if (!touches_beyond(0.5 * margin * pose.depth_m, work) || margin > 8.0) break;
    }
    collect(compliance, pose, work, state, contact);
    state.pose = pose;
    state.touching = !state.touch.empty();
}

}  // namespace palpa::mechanics
