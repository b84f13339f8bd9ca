#include "mechanics/steady_sliding.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mechanics/contact_geometry.h"
#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

void gather(const Compliance& c, const SteadySlide& slide, SteadyWork& w) {
    const std::vector<int>& touch = w.contact.candidate;
    const auto n = static_cast<Index>(touch.size());
    const double along_x = slide.coefficient * slide.direction.x();
    const double along_y = slide.coefficient * slide.direction.y();
    w.A.resize(n, n);
    for (Index j = 0; j < n; ++j) {
        const int to = touch[at(j)];
        for (Index i = 0; i < n; ++i) {
            const int from = touch[at(i)];
            w.A(i, j) = c.normal_m_per_N(from, to) + along_x * c.along_x_m_per_N(to, from) +
                        along_y * c.along_y_m_per_N(to, from);
        }
    }
    w.delta_m = Eigen::Map<const Eigen::VectorXd>(w.contact.delta_m.data(), n);
}

void list_active(SteadyWork& w) {
    w.active.clear();
    for (std::size_t i = 0; i < w.contact.in_contact.size(); ++i) {
        if (w.contact.in_contact[i]) w.active.push_back(static_cast<int>(i));
    }
}

// Solves A_AA p = delta_A on the active nodes; p is 0 elsewhere. Computes g at every candidate.
void solve_active(SteadyWork& w) {
    w.p_N.setZero(w.delta_m.size());
    if (!w.active.empty()) {
        const Eigen::MatrixXd block = w.A(w.active, w.active);
        const Eigen::VectorXd rhs = w.delta_m(w.active);
        const Eigen::VectorXd p_N = block.partialPivLu().solve(rhs);
        w.p_N(w.active) = p_N;
    }
    w.gap_m.noalias() = w.A * w.p_N - w.delta_m;
}

// Releases nodes that pull and adds nodes that are penetrated until the set settles. Returns false if it does not.
bool settle(int max_changes, SteadyWork& w, int& changes) {
    const double tolerance_m = kGapTolerance * w.delta_m.maxCoeff();
    for (int k = 0; k < max_changes; ++k) {
        list_active(w);
        solve_active(w);
        bool changed = false;
        for (Index i = 0; i < w.delta_m.size(); ++i) {
            char& in_contact = w.contact.in_contact[at(i)];
            const bool wanted = in_contact ? w.p_N(i) >= 0.0 : w.gap_m(i) < -tolerance_m;
            changed = changed || wanted != (in_contact != 0);
            in_contact = wanted ? 1 : 0;
        }
        if (!changed) return true;
        ++changes;
    }
    return false;
}

// Projected Gauss-Seidel: p_i <- max(0, p_i - g_i / A_ii), then one direct solve on the nodes that it left pressing. If
// that does not settle, the answer is that of the sweeps. Returns whether it settled.
bool settle_by_sweeps(int sweeps, SteadyWork& w, int& changes) {
    w.p_N.setZero(w.delta_m.size());
    w.gap_m = -w.delta_m;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (Index i = 0; i < w.p_N.size(); ++i) {
            const double p = std::max(0.0, w.p_N(i) - w.gap_m(i) / w.A(i, i));
            if (p == w.p_N(i)) continue;
            w.gap_m += (p - w.p_N(i)) * w.A.col(i);
            w.p_N(i) = p;
        }
    }
    const Eigen::VectorXd swept_N = w.p_N;
    const auto take = [&] {
        for (Index i = 0; i < w.p_N.size(); ++i) w.contact.in_contact[at(i)] = swept_N(i) > 0.0 ? 1 : 0;
    };
    take();
    if (settle(1, w, changes)) return true;
    take();
    list_active(w);
    w.p_N = swept_N;
    w.gap_m.noalias() = w.A * w.p_N - w.delta_m;
    return false;
}

void collect(const Compliance& c, const Tool& tool, const SteadySlide& slide, const SteadyWork& w, Contact& out) {
    for (auto* list : {&out.touch, &out.by_tool}) list->clear();
    out.force_N.clear();
    out.energy_J = std::numeric_limits<double>::quiet_NaN();
    out.violation_m = 0.0;
    for (Index i = 0; i < w.gap_m.size(); ++i) {
        out.violation_m = std::max(out.violation_m, std::abs(std::min(w.A(i, i) * w.p_N(i), w.gap_m(i))));
    }
    ToolForce& force = out.tool[0];
    for (const int i : w.active) {
        const int touch = w.contact.candidate[at(i)];
        const double p = w.p_N(i);
        out.touch.push_back(touch);
        out.by_tool.push_back(0);
        out.force_N.push_back(p);
        force.normal_N += p;
        force.tangential_x_N += p * (w.contact.slope_x[at(i)] + slide.coefficient * slide.direction.x());
        force.tangential_y_N += p * (w.contact.slope_y[at(i)] + slide.coefficient * slide.direction.y());
        force.moment_x_Nm += p * (c.position_m(1, touch) - tool.pose.y_m);
        force.moment_y_Nm -= p * (c.position_m(0, touch) - tool.pose.x_m);
        force.area_m2 += c.area_m2(touch);
    }
}

// Solves from Hertz's contact, as in contact.cpp: on a half-space it holds the nodes whose penetration exceeds half the
// depth.
bool solve_with(const Compliance& c, const SteadySlide& slide, double depth_m, SteadyWork& w, int& changes) {
    gather(c, slide, w);
    for (Index i = 0; i < w.delta_m.size(); ++i) {
        w.contact.in_contact[at(i)] = w.delta_m(i) > 0.5 * depth_m ? 1 : 0;
    }
    if (settle(slide.max_changes, w, changes)) return true;
    return settle_by_sweeps(slide.sweeps, w, changes);
}

}  // namespace

void slide_steadily(const Compliance& compliance, const Tool& tool, const SteadySlide& slide, SteadyWork& work,
                    Contact& contact) {
    if (compliance.along_x_m_per_N.rows() < compliance.n_touch || compliance.n_touch == 0) {
        throw LoadError(
            "sliding: the compliance does not know how pressing moves the surface sideways; ask for it "
            "with sideways = true");
    }
    if (!std::isfinite(tool.pose.x_m) || !std::isfinite(tool.pose.y_m) || !std::isfinite(tool.pose.depth_m)) {
        throw LoadError(text("sliding: tool at ", tool.pose.x_m, ", ", tool.pose.y_m, " m, depth ", tool.pose.depth_m,
                             " m: not finite"));
    }
    prepare(compliance, work.contact);
    work.contact.tools.assign(1, tool);
    Pose& pose = work.contact.tools[0].pose;
    contact.flags = {};
    contact.flags.capped = pose.depth_m > compliance.thickness_m;
    pose.depth_m = std::clamp(pose.depth_m, 0.0, compliance.thickness_m);
    contact.flags.over_edge = reaches_beyond(work.contact.tools[0], work.contact.touch_box_m);
    contact.tool.assign(1, {});
    contact.tool[0].depth_m = pose.depth_m;
    contact.changes = 0;
    work.active.clear();
    work.gap_m.resize(0);
    // nodes beyond the tool's geometric reach are candidates too, since the tissue bulges up in front of the tool
    for (double margin = 0.25;; margin *= 2.0) {
        find_candidates(compliance, work.contact.tools, margin, work.contact);
        if (work.contact.candidate.empty()) break;
        contact.flags.not_settled = !solve_with(compliance, slide, pose.depth_m, work, contact.changes);
        const bool at_rim = std::any_of(work.active.begin(), work.active.end(),
                                        [&](int i) { return work.delta_m(i) < -0.5 * margin * pose.depth_m; });
        if (!at_rim || margin > 8.0) break;
    }
    collect(compliance, work.contact.tools[0], slide, work, contact);
}

}  // namespace palpa::mechanics
