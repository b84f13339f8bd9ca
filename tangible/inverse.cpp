#include "tangible/inverse.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "mechanics/bounded_least_squares.h"
#include "tangible/linearised.h"

namespace palpa::tangible {
namespace {

using Eigen::Index;
using mechanics::BoundedProblem;
using mechanics::BoundedSolution;
using mechanics::BoundedStatus;

constexpr int kMostConverged = 30;     // Newton steps of a converged tick
constexpr int kMostStale = 3;          // corrections of a stale tick before its factor is made anew
constexpr double kSettled = 1e-9;      // greatest last correction, over the body's size
constexpr double kStaleEnough = 5e-4;  // the same for a stale tick: 0.05 of 100 mm, as far as a finger moves in one
constexpr double kStaleMiss = 1e-5;    // what a stale tick may leave of the gap, over the body's size

// What a tick begins with, and the unknowns that ties of force leave.
struct Tick {
    const DeviceModel& model;
    const Wanted& wanted;
    const InverseOptions& options;
    Actuation before{};
    std::array<int, kMostActuators> driver{};  // actuator that each unknown stands for
    int unknowns = 0;
};

Tick begin(const DeviceModel& model, const DeviceState& state, const Wanted& wanted, const InverseOptions& options) {
    Tick tick{model, wanted, options, state.actuation, {}, 0};
    for (int j = 0; j < model.n_actuators(); ++j) {
        if (model.driver[static_cast<std::size_t>(j)] == j) tick.driver[static_cast<std::size_t>(tick.unknowns++)] = j;
    }
    return tick;
}

bool at_floor(const Tick& tick) { return tick.wanted.depth_m < tick.model.device.depth_floor_m; }

// Bounds of one unknown: the limits of all that are tied to it, and how far it may go in this tick.
void bound(const Tick& tick, const DeviceState& state, int unknown, double& lower, double& upper) {
    const int driver = tick.driver[static_cast<std::size_t>(unknown)];
    lower = -1e300;
    upper = 1e300;
    double slew = 1e300;
    for (int j = 0; j < tick.model.n_actuators(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        if (tick.model.driver[at] != driver) continue;
        const SoftActuator& actuator = tick.model.actuators[at];
        lower = std::max(lower, actuator.lower);
        upper = std::min(upper, actuator.upper);
        if (tick.options.slew && actuator.rate_per_s > 0.0)
            slew = std::min(slew, tick.options.rate_share * actuator.rate_per_s * std::max(tick.options.dt_s, 0.0));
    }
    const double from = std::clamp(tick.before[static_cast<std::size_t>(driver)], lower, upper);
    lower = std::max(lower, from - slew);
    upper = std::min(upper, from + slew);
    if (!at_floor(tick)) return;
    lower = upper = std::clamp(state.pretension[static_cast<std::size_t>(driver)], lower, upper);
}

// Whether an actuator with this driver stands at a limit of its own, and not only as far as its rate lets it go.
bool at_limit(const Tick& tick, int driver, double value) {
    for (int j = 0; j < tick.model.n_actuators(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        const SoftActuator& actuator = tick.model.actuators[at];
        const double slack = 1e-9 * (actuator.upper - actuator.lower);
        if (tick.model.driver[at] == driver && (value <= actuator.lower + slack || value >= actuator.upper - slack))
            return true;
    }
    return false;
}

// Rows of what is observed against unknown forces of the actuators; tilts count by the radius of the effector.
BoundedProblem problem_of(const Tick& tick, const DeviceState& state, const Response& response, InverseAnswer& answer) {
    const DeviceModel& model = tick.model;
    const Index rows = model.n_observed();
    BoundedProblem problem;
    problem.W.setZero(rows, tick.unknowns);
    problem.d.resize(rows);
    problem.lower.resize(tick.unknowns);
    problem.upper.resize(tick.unknowns);
    problem.before.resize(tick.unknowns);
    problem.tikhonov = model.device.tikhonov;
    const double F = tick.wanted.force_N;
    problem.d(0) = response.depth_m + response.moved(0) + response.compliance(0, 0) * F - tick.wanted.depth_m;
    const double lever_m = model.device.effector.radius_m;
    for (Index t = 1; t < rows; ++t) {
        const auto at = static_cast<std::size_t>(t - 1);
        problem.d(t) =
            lever_m * (response.tilt[at] + response.tilted[at] + response.tilting(t - 1, 0) * F - tick.wanted.tilt[at]);
    }
    for (int j = 0; j < model.n_actuators(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        Index unknown = 0;
        while (tick.driver[static_cast<std::size_t>(unknown)] != model.driver[at]) ++unknown;
        answer.W(0, j) = response.compliance(0, 1 + j);
        for (Index t = 1; t < rows; ++t) answer.W(t, j) = response.tilting(t - 1, 1 + j);
        problem.W(0, unknown) += answer.W(0, j);
        for (Index t = 1; t < rows; ++t) problem.W(t, unknown) += lever_m * answer.W(t, j);
    }
    for (int k = 0; k < tick.unknowns; ++k) {
        bound(tick, state, k, problem.lower(k), problem.upper(k));
        problem.before(k) = tick.before[static_cast<std::size_t>(tick.driver[static_cast<std::size_t>(k)])];
    }
    return problem;
}

void add_rate_term(const Tick& tick, BoundedProblem& problem) {
    if (!tick.options.rate_term || !(tick.model.device.rate_term_m > 0.0)) return;
    problem.rate.resize(tick.unknowns);
    for (int k = 0; k < tick.unknowns; ++k) {
        const SoftActuator& actuator =
            tick.model.actuators[static_cast<std::size_t>(tick.driver[static_cast<std::size_t>(k)])];
        const double range = actuator.upper - actuator.lower;
        problem.rate(k) = range > 0.0 ? tick.model.device.rate_term_m / range : 0.0;
    }
}

// Solves for the actuation and writes what the answer says of it.
SmallColumn solve_for_forces(const Tick& tick, const DeviceState& state, const Response& response,
                             InverseAnswer& answer) {
    BoundedProblem problem = problem_of(tick, state, response, answer);
    add_rate_term(tick, problem);
    const BoundedSolution solved = mechanics::solve_bounded(problem);
    SmallColumn p = SmallColumn::Zero(channels_of(tick.model));
    p(0) = tick.wanted.force_N;
    answer.active = 0;
    for (int j = 0; j < tick.model.n_actuators(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        for (int k = 0; k < tick.unknowns; ++k) {
            if (tick.driver[static_cast<std::size_t>(k)] != tick.model.driver[at]) continue;
            p(1 + j) = solved.x(k);
            answer.active |= (solved.active >> k & 1U) << j;
        }
    }
    const double lever_m = tick.model.device.effector.radius_m;
    answer.residual_m = solved.residual(0);
    answer.gap = Eigen::Vector3d::Zero();
    for (Index row = 0; row < problem.d.size(); ++row) {
        answer.gap(row) = problem.d(row) / (row == 0 ? 1.0 : lever_m);
        if (row > 0) answer.tilt_residual[static_cast<std::size_t>(row - 1)] = solved.residual(row) / lever_m;
    }
    answer.rank = solved.rank;
    answer.limited_by = -1;
    answer.rate_limited = false;
    if (solved.limiting >= 0 && !at_floor(tick) && solved.residual.norm() > 1e-5 * tick.model.size_m) {
        const int driver = tick.driver[static_cast<std::size_t>(solved.limiting)];
        if (at_limit(tick, driver, solved.x(solved.limiting)))
            answer.limited_by = driver;
        else
            answer.rate_limited = true;
    }
    return p;
}

// One Newton step, or a correction with an old factor. Returns the greatest displacement (m), NaN where there is none.
double step_once(const Tick& tick, DeviceState& state, InverseAnswer& answer) {
    const Response response = respond(tick.model, state);
    const SmallColumn p = solve_for_forces(tick, state, response, answer);
    const double most_m = solve_displacement(tick.model, state, response, p);
    if (!std::isfinite(most_m) || !p.allFinite()) return std::nan("");
    search(tick.model, state, response, {p, {}}, p, most_m);
    ++answer.iterations;
    return most_m;
}

double newton_step(const Tick& tick, DeviceState& state, InverseAnswer& answer) {
    ++answer.factorisations;
    if (!factor_tangent(tick.model, state)) return std::nan("");
    const double most_m = step_once(tick, state, answer);
    return std::max(most_m, move_all_shifts(tick.model, state));
}

// Corrections with the factor that is there, as long as they fall fast enough and bring the effector where it shall be; else a
// Newton step. W changes its sign at small depths, so that an old one may lead away while each correction is small.
double stale_step(const Tick& tick, DeviceState& state, InverseAnswer& answer) {
    double last_m = 0.0;
    for (int i = 0; state.factored && i < kMostStale; ++i) {
        if (!sum_forces(tick.model, state)) return std::nan("");
        const double most_m = step_once(tick, state, answer);
        if (!(most_m < 1e300)) return most_m;
        if (i > 0 && most_m > 0.5 * last_m) break;
        last_m = most_m;
        const bool missed = answer.active == 0 && std::abs(answer.residual_m) > kStaleMiss * tick.model.size_m;
        if (missed) break;
        if (most_m <= kStaleEnough * tick.model.size_m) return std::max(most_m, move_all_shifts(tick.model, state));
    }
    return newton_step(tick, state, answer);
}

double linear_step(const Tick& tick, DeviceState& state, InverseAnswer& answer) {
    if (!state.has_linear) {
        ++answer.factorisations;
        if (!make_linear(tick.model, state)) return std::nan("");
    }
    const SmallColumn p = solve_for_forces(tick, state, state.linear, answer);
    Eigen::Map<Eigen::VectorXd> u(state.u_m.data(), tick.model.equations());
    u = state.linear_u_m;
    u.noalias() += state.linear_moves_m * p;
    set_forces(tick.model, state, state.linear, p);
    ++answer.iterations;
    return 0.0;
}

void finish(const Tick& tick, DeviceState& state, double most_m, InverseAnswer& answer) {
    answer.actuation = state.actuation;
    for (int j = 0; j < tick.model.n_actuators(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        const SoftActuator& actuator = tick.model.actuators[at];
        answer.actuation[at] = std::clamp(answer.actuation[at], actuator.lower, actuator.upper);
    }
    answer.command = lengths(tick.model, state.u_m);
    answer.converged = most_m <= kSettled * tick.model.size_m;
}

bool finite(const Wanted& wanted, const InverseOptions& options) {
    return std::isfinite(wanted.depth_m) && std::isfinite(wanted.force_N) && std::isfinite(wanted.tilt[0]) &&
           std::isfinite(wanted.tilt[1]) && std::isfinite(options.dt_s);
}

// Brings the state back to where the last tick that went well had left it.
void go_back(DeviceState& state, const Tick& tick) {
    state.u_m = state.good_u_m;
    state.actuation = tick.before;
    state.factored = false;
}

}  // namespace

Fidelity fidelity_named(std::string_view name) {
    const auto at = std::find(kFidelityNames.begin(), kFidelityNames.end(), name);
    assert(at != kFidelityNames.end());
    return static_cast<Fidelity>(at - kFidelityNames.begin());
}

InverseAnswer inverse_step(const DeviceModel& model, DeviceState& state, const Wanted& wanted,
                           const InverseOptions& options) noexcept {
    InverseAnswer answer;
    const Tick tick = begin(model, state, wanted, options);
    double most_m = std::nan("");
    if (!finite(wanted, options)) {
        finish(tick, state, most_m, answer);
        return answer;
    }
    state.good_u_m = state.u_m;
    switch (options.fidelity) {
        case Fidelity::step:
            most_m = newton_step(tick, state, answer);
            break;
        case Fidelity::stale:
            most_m = stale_step(tick, state, answer);
            break;
        case Fidelity::linear:
            most_m = linear_step(tick, state, answer);
            break;
        case Fidelity::converged:
            do most_m = newton_step(tick, state, answer);
            while (most_m > kSettled * model.size_m && answer.iterations < kMostConverged);
            break;
    }
    const bool settled = most_m <= kSettled * model.size_m;
    if (!std::isfinite(most_m)) {
        answer.status = DeviceStatus::no_equilibrium;
        go_back(state, tick);
    } else if (options.fidelity == Fidelity::converged && !settled) {
        answer.status = DeviceStatus::slow;
    } else {
        answer.status = state.repaired ? DeviceStatus::unstable : DeviceStatus::good;
    }
    finish(tick, state, most_m, answer);
    return answer;
}

}  // namespace palpa::tangible
