#include "tangible/linearised.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tangible/actuators.h"
#include "tangible/bearings.h"

namespace palpa::tangible {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::VectorXd;
using mechanics::Tangent;

Places places(const DeviceModel& model, const DeviceState& state) { return {model.body.mesh.nodes_m, state.u_m}; }

bool held_in_motion(const DeviceModel& model, int actuator) {
    for (const auto& pair : model.equal_motion) {
        if (pair[0] == actuator || pair[1] == actuator) return true;
    }
    return false;
}

// The springs of the actuators that are tied in motion, one per channel.
SmallColumn springs(const DeviceModel& model) {
    SmallColumn out = SmallColumn::Zero(channels_of(model));
    for (int j = 0; j < model.n_actuators(); ++j) out(1 + j) = held_in_motion(model, j) ? model.hold_N_per_m : 0.0;
    return out;
}

// T: one column per condition of equal motion.
Small ties_of(const DeviceModel& model) {
    Small T = Small::Zero(channels_of(model), static_cast<Index>(model.equal_motion.size()));
    for (std::size_t k = 0; k < model.equal_motion.size(); ++k) {
        T(1 + model.equal_motion[k][0], static_cast<Index>(k)) = 1.0;
        T(1 + model.equal_motion[k][1], static_cast<Index>(k)) = -1.0;
    }
    return T;
}

void add_bearings(const DeviceModel& model, DeviceState& state, mechanics::BandMatrix* K) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < model.bearings.size(); ++i) {
        const auto& points = model.bearings[i];
        add_bearing(model.device.bearings[i], points,
                    std::span<const double>(state.shift_m).subspan(first, points.size()), places(model, state),
                    state.gradient_N, K);
        first += points.size();
    }
}

// Writes B, dv/du of all channels, to state.loads.
void write_loads(const DeviceModel& model, DeviceState& state) {
    state.loads.setZero();
    state.loads.col(0) = model.observed.col(0);
    for (int j = 0; j < model.n_actuators(); ++j)
        add_gradient(model.actuators[static_cast<std::size_t>(j)], places(model, state), model.free_nodes, -1.0,
                     state.loads.col(1 + j));
    for (const int equation : model.held) state.loads.row(equation).setZero();
}

// The forces of the channels, ties included, as they are.
SmallColumn channel_forces(const DeviceModel& model, const DeviceState& state) {
    SmallColumn p(channels_of(model));
    p(0) = state.finger_N;
    for (int j = 0; j < model.n_actuators(); ++j)
        p(1 + j) = state.actuation[static_cast<std::size_t>(j)] + state.tie_part[static_cast<std::size_t>(j)];
    return p;
}

// What is out of balance without the channels, to the last column of `answers`. With a factor of earlier the channels are
// taken to work along its B, and what that leaves out is added here, so that repeated steps end at the true equilibrium.
void write_imbalance(const DeviceModel& model, DeviceState& state) {
    auto r = state.answers.col(channels_of(model));
    r = model.weight_N - Eigen::Map<const VectorXd>(state.gradient_N.data(), model.equations());
    if (state.age > 0) {
        const SmallColumn p = channel_forces(model, state);
        r.noalias() += state.loads * p;
        r.noalias() -= state.factor_loads * p;
    }
    for (const int equation : model.held) r(equation) = 0.0;
}

// Sums K and the gradient; false if the energy is infinite.
bool sum_tangent(const DeviceModel& model, DeviceState& state, Tangent kind) {
    state.gradient_N.setZero();
    state.K.values.setZero();
    const double energy = mechanics::add_energy_tangent_N_per_m(model.body, state.u_m, kind, state.gradient_N, state.K);
    if (!std::isfinite(energy)) return false;
    add_bearings(model, state, &state.K);
    for (int j = 0; j < model.n_actuators(); ++j) {
        const SoftActuator& actuator = model.actuators[static_cast<std::size_t>(j)];
        const auto at = static_cast<std::size_t>(j);
        add_hessian(actuator, places(model, state), state.actuation[at] + state.tie_part[at], state.K);
        if (held_in_motion(model, j)) add_squared_gradient(actuator, places(model, state), model.hold_N_per_m, state.K);
    }
    for (const int equation : model.held) mechanics::hold_equation(equation, model.hold_N_per_m, state.K);
    return true;
}

// Solves for dv and m for each right-hand side: columns of y_r and G.
void eliminate(const DeviceModel& model, const Small& G, const SmallColumn& y_r, const SmallColumn& v, Response& out) {
    const Index m = G.rows();
    const Small T = ties_of(model);
    const Index n_ties = T.cols();
    const SmallColumn h = springs(model);
    Small left = Small::Zero(m + n_ties, m + n_ties);
    left.topLeftCorner(m, m) = Small(Small::Identity(m, m)) - Small(G * h.asDiagonal());
    left.topRightCorner(m, n_ties) = -G * T;
    left.bottomLeftCorner(n_ties, m) = T.transpose();
    Small right = Small::Zero(m + n_ties, m + 1);
    right.topLeftCorner(m, m) = G;
    right.col(m).head(m) = y_r;
    right.col(m).tail(n_ties) = -(T.transpose() * v);
    const Eigen::PartialPivLU<Small> lu(left);
    const Small solved = lu.solve(right);
    out.moved = solved.col(m).head(m);
    out.compliance = solved.topLeftCorner(m, m);
    out.tied = T * solved.col(m).tail(n_ties);
    out.tying = T * solved.bottomLeftCorner(n_ties, m);
    out.forced = h.asDiagonal() * out.moved + out.tied;
    out.forcing = Small(Small::Identity(m, m)) + Small(h.asDiagonal() * out.compliance) + out.tying;
}

constexpr double kSmallMove = 2e-3;   // that needs no search, over the body's size
constexpr double kLeastShare = 0.01;  // of a step

double merit_J(const DeviceModel& model, const DeviceState& state, const Goal& goal, const SmallColumn& forces) {
    double sum = device_energy_J(model, state);
    if (!std::isfinite(sum)) return sum;
    const SmallColumn v = coordinates(model, state);
    sum -= forces.dot(v);
    for (Index k = 0; k < v.size(); ++k) {
        const double gap_m = goal.by_position[static_cast<std::size_t>(k)] ? v(k) - goal.value(k) : 0.0;
        sum += 0.5 * model.hold_N_per_m * gap_m * gap_m;
    }
    for (const auto& pair : model.equal_motion) {
        const double gap_m = v(1 + pair[0]) - v(1 + pair[1]);
        sum += 0.5 * model.hold_N_per_m * gap_m * gap_m;
    }
    return sum;
}

}  // namespace

double device_energy_J(const DeviceModel& model, const DeviceState& state) noexcept {
    double sum = mechanics::energy_J(model.body, state.u_m);
    if (!std::isfinite(sum)) return sum;
    std::size_t first = 0;
    for (std::size_t i = 0; i < model.bearings.size(); ++i) {
        const auto& points = model.bearings[i];
        sum += bearing_energy_J(model.device.bearings[i], points,
                                std::span<const double>(state.shift_m).subspan(first, points.size()),
                                places(model, state));
        first += points.size();
    }
    return sum - model.weight_N.dot(Eigen::Map<const VectorXd>(state.u_m.data(), model.equations()));
}

bool sum_forces(const DeviceModel& model, DeviceState& state) noexcept {
    state.gradient_N.setZero();
    if (!std::isfinite(mechanics::add_energy_gradient_N(model.body, state.u_m, state.gradient_N))) return false;
    add_bearings(model, state, nullptr);
    write_loads(model, state);
    ++state.age;
    return true;
}

bool factor_tangent(const DeviceModel& model, DeviceState& state) noexcept {
    state.factored = false;
    state.repaired = false;
    state.age = 0;
    ++state.factorisations;
    if (!sum_tangent(model, state, Tangent::exact)) return false;
    bool good = mechanics::factor_in_place(state.K) == 0;
    if (!good) {
        // the tangent without negative eigenvalues of cells, whose finding costs most of a repair, and then with a stiffness
        // of its own
        state.repaired = true;
        if (!sum_tangent(model, state, Tangent::positive)) return false;
        state.summed = state.K.values;
    }
    for (const double share : {0.0, 1e-4, 1e-3, 1e-2, 1e-1}) {
        if (good) break;
        state.K.values = state.summed;
        state.K.values.row(0).array() += share * model.hold_N_per_m;
        good = mechanics::factor_in_place(state.K) == 0;
    }
    if (!good) return false;
    state.repairs += state.repaired ? 1 : 0;
    state.factored = true;
    write_loads(model, state);
    const int m = channels_of(model);
    state.factor_loads = state.loads;
    state.answers.leftCols(m) = state.loads;
    mechanics::solve_in_place(state.K, state.answers.leftCols(m));
    return true;
}

Response respond(const DeviceModel& model, DeviceState& state) noexcept {
    const int m = channels_of(model);
    write_imbalance(model, state);
    mechanics::solve_in_place(state.K, state.answers.rightCols(1));
    const auto X = state.answers.leftCols(m);
    const auto x_r = state.answers.col(m);
    const Small G = state.loads.transpose() * X;
    const SmallColumn y_r = state.loads.transpose() * x_r;
    Response out;
    out.depth_m = depth_m(model, state);
    out.tilt = tilts(model, state);
    eliminate(model, G, y_r, coordinates(model, state), out);
    out.tilting.setZero(2, m);
    for (Index t = 1; t < model.observed.cols(); ++t) {
        const SmallColumn row = X.transpose() * model.observed.col(t);
        out.tilted[static_cast<std::size_t>(t - 1)] = x_r.dot(model.observed.col(t)) + row.dot(out.forced);
        out.tilting.row(t - 1) = row.transpose() * out.forcing;
    }
    return out;
}

double solve_displacement(const DeviceModel& model, DeviceState& state, const Response& response,
                          const SmallColumn& p) noexcept {
    const int m = channels_of(model);
    const SmallColumn total = response.forced + response.forcing * p;
    state.answers.col(m).noalias() += state.answers.leftCols(m) * total;
    return state.answers.col(m).lpNorm<Eigen::Infinity>();
}

void move(const DeviceModel& model, DeviceState& state, const Response& response, const SmallColumn& p,
          double share) noexcept {
    Eigen::Map<VectorXd>(state.u_m.data(), model.equations()) += share * state.answers.col(channels_of(model));
    set_forces(model, state, response, p);
}

void search(const DeviceModel& model, DeviceState& state, const Response& response, const Goal& goal,
            const SmallColumn& p, double most_m) noexcept {
    const double whole = std::min(1.0, kMostMove * model.size_m / std::max(most_m, 1e-300));
    if (most_m < kSmallMove * model.size_m) {
        move(model, state, response, p, whole);
        return;
    }
    const SmallColumn forces = p + response.tied + response.tying * p;
    const double before_J = merit_J(model, state, goal, forces);
    double share = whole;
    move(model, state, response, p, share);
    while (share > kLeastShare * whole &&
           !(merit_J(model, state, goal, forces) <= before_J + 1e-12 * std::abs(before_J))) {
        move(model, state, response, p, -0.5 * share);
        share *= 0.5;
    }
}

void set_forces(const DeviceModel& model, DeviceState& state, const Response& response, const SmallColumn& p) noexcept {
    const SmallColumn tied = response.tied + response.tying * p;
    state.finger_N = p(0);
    for (int j = 0; j < model.n_actuators(); ++j) {
        state.actuation[static_cast<std::size_t>(j)] = p(1 + j);
        state.tie_part[static_cast<std::size_t>(j)] = tied(1 + j);
    }
}

bool make_linear(const DeviceModel& model, DeviceState& state) noexcept {
    if (!factor_tangent(model, state)) return false;
    state.linear = respond(model, state);
    const auto X = state.answers.leftCols(channels_of(model));
    state.linear_u_m =
        Eigen::Map<const VectorXd>(state.u_m.data(), model.equations()) + state.answers.col(channels_of(model));
    state.linear_u_m.noalias() += X * state.linear.forced;
    state.linear_moves_m.noalias() = X * state.linear.forcing;
    state.has_linear = true;
    return true;
}

double move_all_shifts(const DeviceModel& model, DeviceState& state) noexcept {
    if (!model.has_constraints) return 0.0;
    double most = 0.0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < model.bearings.size(); ++i) {
        const auto& points = model.bearings[i];
        most = std::max(most, move_shifts(model.device.bearings[i], points, places(model, state),
                                          std::span<double>(state.shift_m).subspan(first, points.size())));
        first += points.size();
    }
    return most;
}

SmallColumn coordinates(const DeviceModel& model, const DeviceState& state) noexcept {
    SmallColumn v(channels_of(model));
    v(0) = model.observed.col(0).dot(Eigen::Map<const VectorXd>(state.u_m.data(), model.equations()));
    const Lengths q = lengths(model, state.u_m);
    for (int j = 0; j < model.n_actuators(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        v(1 + j) = -(q[at] - model.rest[at]);
    }
    return v;
}

std::array<double, 2> tilts(const DeviceModel& model, const DeviceState& state) noexcept {
    std::array<double, 2> out{};
    const Eigen::Map<const VectorXd> u(state.u_m.data(), model.equations());
    for (Index t = 1; t < model.observed.cols(); ++t)
        out[static_cast<std::size_t>(t - 1)] = model.observed.col(t).dot(u);
    return out;
}

}  // namespace palpa::tangible
