#include "mechanics/contact.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "mechanics/contact_geometry.h"
#include "mechanics/index.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

constexpr double kRegularisation = 1e-12;  // of the mean diagonal; factors C also if two nodes are at one place
constexpr double kForceTolerance = 1e-9;   // of the force
constexpr double kDepthRoundOff = 1e-15;   // of the depth: a narrower bracket cannot be halved
constexpr int kMostSearchSteps = 60;

// The compliance of tissue and tool together, between touch nodes.
struct Both {
    const Eigen::MatrixXd& tissue;
    const Eigen::MatrixXd* tool = nullptr;
    double factor = 0.0;
};
Both both_of(const Compliance& c, const ContactOptions& options) {
    const bool rigid = options.tool_compliance == nullptr || options.tool_factor == 0.0;
    return {c.normal_m_per_N, rigid ? nullptr : options.tool_compliance, rigid ? 0.0 : options.tool_factor};
}

double compliance_of(const Both& c, const ContactWork& w, int i, int j) {
    const int row = w.candidate[at(i)];
    const int column = w.candidate[at(j)];
    return c.tissue(row, column) + (c.tool ? c.factor * (*c.tool)(row, column) : 0.0);
}

// Starts from the last active set, which w.active still lists, if at least half of it is within reach. Otherwise starts
// from Hertz's contact: on a half-space it holds the nodes whose penetration exceeds half the depth.
void first_guess(std::span<const Tool> tools, ContactWork& w) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < w.candidate.size(); ++i) {
        w.in_contact[i] = w.was_in_contact[at(w.candidate[i])];
        kept += w.in_contact[i] ? 1u : 0u;
    }
    if (kept > 0 && 2 * kept >= w.active.size()) return;
    for (std::size_t i = 0; i < w.candidate.size(); ++i) {
        w.in_contact[i] = w.delta_m[i] > 0.5 * tools[at(w.tool_of[i])].pose.depth_m ? char{1} : char{0};
    }
}

void list_active(ContactWork& w) {
    w.active.clear();
    for (int i = 0; i < static_cast<int>(w.candidate.size()); ++i) {
        if (w.in_contact[at(i)]) w.active.push_back(i);
    }
}

// Factors C on the active nodes (Cholesky), unless w.factor is of these nodes already. Returns false if C is not
// positive definite there.
bool factor_active(const Both& c, ContactWork& w) {
    const bool same = w.factored.size() == w.active.size() && w.factored_tool == c.factor &&
                      std::equal(w.active.begin(), w.active.end(), w.factored.begin(),
                                 [&](int i, int touch) { return w.candidate[at(i)] == touch; });
    if (same) return true;
    const auto n = static_cast<Index>(w.active.size());
    if (w.factor.rows() < n) {
        w.factor.resize(n + n / 2, n + n / 2);
        w.rhs.resize(n + n / 2);
    }
    double trace = 0.0;
    for (Index j = 0; j < n; ++j) {
        const int touch = w.candidate[at(w.active[static_cast<std::size_t>(j)])];
        const double* column = c.tissue.col(touch).data();
        for (Index i = j; i < n; ++i) w.factor(i, j) = column[w.candidate[at(w.active[static_cast<std::size_t>(i)])]];
        if (c.tool) {
            const double* tool = c.tool->col(touch).data();
            for (Index i = j; i < n; ++i)
                w.factor(i, j) += c.factor * tool[w.candidate[at(w.active[static_cast<std::size_t>(i)])]];
        }
        trace += w.factor(j, j);
    }
    w.factor.topLeftCorner(n, n).diagonal().array() +=
        kRegularisation * trace / static_cast<double>(std::max<Index>(n, 1));
    Eigen::Ref<Eigen::MatrixXd> block = w.factor.topLeftCorner(n, n);
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(block);
    w.factored.clear();
    // the factorisation does not report a NaN
    if (in_place.info() != Eigen::Success || !block.diagonal().allFinite()) return false;
    for (const int i : w.active) w.factored.push_back(w.candidate[at(i)]);
    w.factored_tool = c.factor;
    return true;
}

// Solves C_AA p = delta_A on the active nodes; p is 0 elsewhere. Returns false if C_AA cannot be factored.
bool solve_active(const Both& c, ContactWork& w) {
    if (!factor_active(c, w)) return false;
    const auto n = static_cast<Index>(w.active.size());
    for (Index i = 0; i < n; ++i) w.rhs(i) = w.delta_m[at(w.active[static_cast<std::size_t>(i)])];
    const auto L = w.factor.topLeftCorner(n, n);
    L.triangularView<Eigen::Lower>().solveInPlace(w.rhs.head(n));
    L.triangularView<Eigen::Lower>().transpose().solveInPlace(w.rhs.head(n));
    std::fill(w.p_N.begin(), w.p_N.end(), 0.0);
    for (Index i = 0; i < n; ++i) w.p_N[at(w.active[static_cast<std::size_t>(i)])] = w.rhs(i);
    return true;
}

// Computes g = C p - delta at every candidate.
void compute_gaps(const Both& c, ContactWork& w) {
    const int n = static_cast<int>(w.candidate.size());
    for (int i = 0; i < n; ++i) w.gap_m[at(i)] = -w.delta_m[at(i)];
    for (const int j : w.active) {
        const double* column = c.tissue.col(w.candidate[at(j)]).data();
        const double p = w.p_N[at(j)];
        for (int i = 0; i < n; ++i) w.gap_m[at(i)] += column[w.candidate[at(i)]] * p;
        if (!c.tool) continue;
        const double* tool = c.tool->col(w.candidate[at(j)]).data();
        for (int i = 0; i < n; ++i) w.gap_m[at(i)] += tool[w.candidate[at(i)]] * (c.factor * p);
    }
}

double gap_tolerance(const ContactWork& w) {
    return w.delta_m.empty() ? 0.0 : kGapTolerance * *std::max_element(w.delta_m.begin(), w.delta_m.end());
}

// Releases nodes that pull and adds nodes that are penetrated. Returns whether the set changed.
bool change_set(double tolerance_m, ContactWork& w) {
    bool changed = false;
    for (std::size_t i = 0; i < w.candidate.size(); ++i) {
        const bool wanted = w.in_contact[i] ? w.p_N[i] >= 0.0 : w.gap_m[i] < -tolerance_m;
        if (wanted == (w.in_contact[i] != 0)) continue;
        w.in_contact[i] = wanted ? 1 : 0;
        changed = true;
    }
    return changed;
}

// Changes the active set until it settles. Returns false if it does not, or cannot be solved.
bool settle(const Both& c, int max_changes, ContactWork& w, int& changes) {
    const double tolerance_m = gap_tolerance(w);
    for (int k = 0; k < max_changes; ++k) {
        list_active(w);
        if (!solve_active(c, w)) return false;
        compute_gaps(c, w);
        if (!change_set(tolerance_m, w)) return true;
        ++changes;
    }
    return false;
}

// Projected Gauss-Seidel: p_i <- max(0, p_i - g_i / C_ii), then one direct solve on the nodes that it left pressing. If
// that does not settle, the answer is that of the sweeps. Returns whether it settled.
bool settle_by_sweeps(const Both& c, int sweeps, ContactWork& w, int& changes) {
    const int n = static_cast<int>(w.candidate.size());
    std::fill(w.p_N.begin(), w.p_N.end(), 0.0);
    for (int i = 0; i < n; ++i) w.gap_m[at(i)] = -w.delta_m[at(i)];
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (int i = 0; i < n; ++i) {
            const double own_m_per_N = compliance_of(c, w, i, i);
            if (!(own_m_per_N > 0.0)) continue;  // a damaged row stays free, so that the contact does not settle
            const double p = std::max(0.0, w.p_N[at(i)] - w.gap_m[at(i)] / own_m_per_N);
            const double dp = p - w.p_N[at(i)];
            if (dp == 0.0) continue;
            w.p_N[at(i)] = p;
            for (int j = 0; j < n; ++j) w.gap_m[at(j)] += compliance_of(c, w, j, i) * dp;
        }
    }
    for (int i = 0; i < n; ++i) w.in_contact[at(i)] = w.p_N[at(i)] > 0.0 ? 1 : 0;
    w.swept_N.assign(w.p_N.begin(), w.p_N.end());
    if (settle(c, 1, w, changes)) return true;
    w.p_N = w.swept_N;
    for (int i = 0; i < n; ++i) w.in_contact[at(i)] = w.p_N[at(i)] > 0.0 ? 1 : 0;
    list_active(w);
    compute_gaps(c, w);
    return false;
}

void remember(ContactWork& w) {
    std::fill(w.was_in_contact.begin(), w.was_in_contact.end(), char{0});
    for (const int i : w.active) w.was_in_contact[at(w.candidate[at(i)])] = 1;
}

void collect(const Compliance& c, std::span<const Tool> tools, const ContactWork& w, Contact& out) {
    out.touch.clear();
    out.by_tool.clear();
    out.force_N.clear();
    out.energy_J = 0.0;
    for (const int i : w.active) {
        const int touch = w.candidate[at(i)];
        const int which = w.tool_of[at(i)];
        const double p = w.p_N[at(i)];
        out.touch.push_back(touch);
        out.by_tool.push_back(which);
        out.force_N.push_back(p);
        out.energy_J += 0.5 * p * (w.delta_m[at(i)] + w.gap_m[at(i)]);
        ToolForce& force = out.tool[at(which)];
        const Pose& pose = tools[at(which)].pose;
        force.normal_N += p;
        force.tangential_x_N += p * w.slope_x[at(i)];
        force.tangential_y_N += p * w.slope_y[at(i)];
        force.moment_x_Nm += p * (c.position_m(1, touch) - pose.y_m);
        force.moment_y_Nm -= p * (c.position_m(0, touch) - pose.x_m);
        force.area_m2 += c.area_m2(touch);
    }
    const double least = w.gap_m.empty() ? 0.0 : *std::min_element(w.gap_m.begin(), w.gap_m.end());
    out.violation_m = std::max(0.0, -least);
}

// Returns d(normal force)/d(depth) = 1^T C_AA^-1 1, which holds while the set stays as it is.
double stiffness_of_set(const Both& c, ContactWork& w) {
    const auto n = static_cast<Index>(w.active.size());
    if (n == 0 || !factor_active(c, w)) return 0.0;
    w.rhs.head(n).setOnes();
    w.factor.topLeftCorner(n, n).triangularView<Eigen::Lower>().solveInPlace(w.rhs.head(n));
    return w.rhs.head(n).squaredNorm();
}

double limited_depth_m(const Compliance& c, const ContactOptions& options) {
    return options.tool_compliance ? options.max_depth_m : std::min(options.max_depth_m, c.thickness_m);
}

bool all_finite(std::span<const Tool> tools) {
    return std::all_of(tools.begin(), tools.end(), [](const Tool& t) {
        return std::isfinite(t.pose.x_m) && std::isfinite(t.pose.y_m) && std::isfinite(t.pose.depth_m);
    });
}

// Solves for the tools in w.tools. Nodes beyond the tool's geometric reach are candidates too, since thin soft layers
// bulge up to the tool: the margin grows until no node in contact lies near the rim of the candidates.
void solve_contact(const Compliance& c, const ContactOptions& options, ContactWork& w, Contact& out) {
    out.changes = 0;
    const Both both = both_of(c, options);
    for (double margin = 0.25;; margin *= 2.0) {
        find_candidates(c, w.tools, margin, w);
        first_guess(w.tools, w);
        bool settled = settle(both, options.max_changes, w, out.changes);
        if (!settled) settled = settle_by_sweeps(both, options.sweeps, w, out.changes);
        out.flags.not_settled = !settled;
        remember(w);
        const bool at_rim = std::any_of(w.active.begin(), w.active.end(), [&](int i) {
            return w.delta_m[at(i)] < -0.5 * margin * w.tools[at(w.tool_of[at(i)])].pose.depth_m;
        });
        if (!at_rim || margin > 8.0) break;
    }
    collect(c, w.tools, w, out);
}

}  // namespace

void prepare(const Compliance& c, ContactWork& w) {
    if (c.revision != 0 && w.revision == c.revision) return;
    w.revision = c.revision;
    w.was_in_contact.assign(at(c.n_touch), 0);
    w.active.clear();
    w.factored.clear();
    for (auto* list : {&w.delta_m, &w.slope_x, &w.slope_y, &w.p_N, &w.swept_N, &w.gap_m}) list->reserve(at(c.n_touch));
    for (auto* list : {&w.candidate, &w.tool_of, &w.factored, &w.active}) list->reserve(at(c.n_touch));
    w.in_contact.reserve(at(c.n_touch));
    const auto box_m = [&](int first, int n) -> std::array<double, 4> {
        const auto touched = c.position_m.middleCols(first, n);
        return {touched.row(0).minCoeff(), touched.row(0).maxCoeff(), touched.row(1).minCoeff(),
                touched.row(1).maxCoeff()};
    };
    w.touch_box_m = box_m(0, c.n_touch);
    w.highest_m = std::max(0.0, c.position_m.row(2).head(c.n_touch).maxCoeff() - c.surface_z_m);
    w.run_box_m.clear();
    for (int first = 0; first < c.n_touch; first += kRunLength)
        w.run_box_m.push_back(box_m(first, std::min(kRunLength, c.n_touch - first)));
}

void hold(std::size_t n_tools, Contact& contact) {
    contact.flags.held = true;
    if (contact.tool.size() != n_tools) contact.tool.assign(n_tools, {});  // no force if there is no valid answer yet
}

ContactWork make_contact_work(const Compliance& compliance, int most_in_contact) {
    ContactWork work;
    prepare(compliance, work);
    work.tools.reserve(1);  // the loop has one tool
    work.factor.resize(most_in_contact, most_in_contact);
    work.rhs.resize(most_in_contact);
    return work;
}

void press_to_depth(const Compliance& compliance, std::span<const Tool> tools, const ContactOptions& options,
                    ContactWork& work, Contact& contact) {
    if (!all_finite(tools)) {
        hold(tools.size(), contact);
        return;
    }
    prepare(compliance, work);
    contact.flags = {};
    contact.tool.assign(tools.size(), {});
    work.tools.assign(tools.begin(), tools.end());
    const double limit_m = limited_depth_m(compliance, options);
    for (std::size_t i = 0; i < tools.size(); ++i) {
        Pose& pose = work.tools[i].pose;
        contact.flags.capped = contact.flags.capped || pose.depth_m > limit_m;
        pose.depth_m = std::clamp(pose.depth_m, 0.0, limit_m);
        contact.tool[i].depth_m = pose.depth_m;
        contact.flags.over_edge = contact.flags.over_edge || reaches_beyond(work.tools[i], work.touch_box_m);
    }
    solve_contact(compliance, options, work, contact);
}

void press_with_force(const Compliance& compliance, const Tool& tool, double force_N, const ContactOptions& options,
                      ContactWork& work, Contact& contact) {
    // F(d) is convex and rising, and linear while the set stays as it is: Newton's method reaches the root from above
    // in a few steps, and the bracket keeps it from leaving where nodes join and leave the contact.
    Tool trial = tool;
    const bool valid = std::isfinite(force_N) && all_finite({&trial, 1});
    if (!valid) {
        hold(1, contact);
        return;
    }
    const double limit_m = limited_depth_m(compliance, options);
    double low = 0.0;
    double high = limit_m;
    double depth = tool.pose.depth_m > 0.0 ? std::min(tool.pose.depth_m, limit_m)
                                           : std::min(1e-3 * tool.indenter.radius_m, limit_m);
    if (force_N <= 0.0) depth = 0.0;
    for (int i = 0; i < kMostSearchSteps; ++i) {
        trial.pose.depth_m = depth;
        press_to_depth(compliance, {&trial, 1}, options, work, contact);
        contact.stiffness_N_per_m = stiffness_of_set(both_of(compliance, options), work);
        const double miss = contact.tool[0].normal_N - force_N;
        if (std::abs(miss) <= kForceTolerance * std::abs(force_N) || force_N <= 0.0) return;
        if (miss < 0.0 && depth >= limit_m) {
            contact.flags.capped = true;
            return;
        }
        (miss < 0.0 ? low : high) = depth;
        contact.flags.force_missed = true;  // holds if no later step meets the force
        if (high - low <= kDepthRoundOff * high) return;
        double next = contact.stiffness_N_per_m > 0.0 ? depth - miss / contact.stiffness_N_per_m : 2.0 * depth + 1e-6;
        // Newton overshoots from a shallow start, since F rises faster than linearly: at most four times deeper at once
        if (miss < 0.0) next = std::min(next, std::max(4.0 * depth, 1e-6));
        if (!(next > low && next < high)) next = next >= high && high >= limit_m ? limit_m : 0.5 * (low + high);
        depth = next;
    }
}

void surface_depression_m(const Compliance& compliance, const Contact& contact, Eigen::VectorXd& out_m) {
    out_m.setZero(compliance.normal_m_per_N.rows());
    for (std::size_t i = 0; i < contact.touch.size(); ++i) {
        out_m.noalias() += contact.force_N[i] * compliance.normal_m_per_N.col(contact.touch[i]);
    }
}

double pressure_Pa(const Compliance& compliance, const Contact& contact, std::size_t i) {
    return contact.force_N[i] / compliance.area_m2(contact.touch[i]);
}

}  // namespace palpa::mechanics
