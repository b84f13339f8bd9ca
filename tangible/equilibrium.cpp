#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tangible/linearised.h"

namespace palpa::tangible {
namespace {

constexpr int kMostNewton = 40;
constexpr double kFastFall = 0.1;   // of corrections with one factor
constexpr double kNear = 2e-3;      // corrections from which on one factor may serve, over the body's size
constexpr int kPatience = 10;       // Newton steps without a smaller correction before a load is given up
constexpr int kMostHalvings = 8;    // of a step of the load
constexpr double kBalanced = 1e-9;  // greatest last correction, over the body's size

Goal goal_of(const DeviceModel& model, const DeviceState& state, const DeviceLoad& load) {
    Goal goal;
    goal.value.resize(channels_of(model));
    goal.value(0) = load.finger_by_position ? load.finger + state.rest_depth_m : load.finger;
    goal.by_position[0] = load.finger_by_position;
    for (int j = 0; j < model.n_actuators(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        goal.by_position[at + 1] = load.by_position[at];
        goal.value(1 + j) = load.by_position[at] ? model.rest[at] - load.length[at] : load.actuation[at];
    }
    return goal;
}

// Where the state stands in the terms of a goal.
SmallColumn present(const DeviceModel& model, const DeviceState& state, const Goal& goal) {
    SmallColumn out = coordinates(model, state);
    for (int k = 0; k < out.size(); ++k) {
        if (goal.by_position[static_cast<std::size_t>(k)]) continue;
        out(k) = k == 0 ? state.finger_N : state.actuation[static_cast<std::size_t>(k - 1)];
    }
    return out;
}

// The channels' forces with which those that are led by position come where they shall.
SmallColumn forces_for(const Goal& goal, const SmallColumn& value, const SmallColumn& v, const Response& response) {
    SmallColumn p = value;
    std::array<Eigen::Index, kMostChannels> led{};
    Eigen::Index count = 0;
    for (Eigen::Index k = 0; k < value.size(); ++k) {
        if (!goal.by_position[static_cast<std::size_t>(k)]) continue;
        p(k) = 0.0;
        led[static_cast<std::size_t>(count++)] = k;
    }
    if (count == 0) return p;
    const SmallColumn there = v + response.moved + response.compliance * p;
    Small left(count, count);
    SmallColumn right(count);
    for (Eigen::Index a = 0; a < count; ++a) {
        const Eigen::Index row = led[static_cast<std::size_t>(a)];
        right(a) = value(row) - there(row);
        for (Eigen::Index b = 0; b < count; ++b)
            left(a, b) = response.compliance(row, led[static_cast<std::size_t>(b)]);
    }
    // scaled, since newtons and pascals differ; singular where a tie of motion says what two positions say as well
    const SmallColumn scale = left.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    Eigen::ColPivHouseholderQR<Small> qr(count, count);
    qr.setThreshold(1e-9);
    qr.compute(scale.asDiagonal() * left * scale.asDiagonal());
    const SmallColumn found = scale.cwiseProduct(SmallColumn(qr.solve(SmallColumn(scale.cwiseProduct(right)))));
    for (Eigen::Index a = 0; a < count; ++a) p(led[static_cast<std::size_t>(a)]) = found(a);
    return p;
}

// Newton's method at one value of the goal. The factor of a step serves those after it as long as each is much smaller than
// the one before.
DeviceStatus newton(const DeviceModel& model, DeviceState& state, const Goal& goal, const SmallColumn& value,
                    ForwardAnswer& answer) {
    bool factor = true;
    int vain = 0;
    double least_m = std::numeric_limits<double>::infinity();
    double last_m = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMostNewton; ++i) {
        if (!(factor ? factor_tangent(model, state) : sum_forces(model, state))) return DeviceStatus::no_equilibrium;
        const Response response = respond(model, state);
        const SmallColumn p = forces_for(goal, value, coordinates(model, state), response);
        const double most_m = solve_displacement(model, state, response, p);
        ++answer.iterations;
        if (!std::isfinite(most_m) || !p.allFinite()) return DeviceStatus::no_equilibrium;
        search(model, state, response, {value, goal.by_position}, p, most_m);
        answer.residual_m = std::max(most_m, move_all_shifts(model, state));
        if (answer.residual_m <= kBalanced * model.size_m)
            return state.repaired ? DeviceStatus::unstable : DeviceStatus::good;
        factor = state.repaired || answer.residual_m > kFastFall * last_m || answer.residual_m > kNear * model.size_m;
        last_m = answer.residual_m;
        vain = last_m < least_m ? 0 : vain + 1;
        least_m = std::min(least_m, last_m);
        if (vain > kPatience) return DeviceStatus::slow;
    }
    return DeviceStatus::slow;
}

struct Snapshot {
    Actuation actuation, tie_part;
    double finger_N;
};

Snapshot keep(DeviceState& state) {
    state.good_u_m = state.u_m;
    state.good_shift_m = state.shift_m;
    return {state.actuation, state.tie_part, state.finger_N};
}

void go_back(DeviceState& state, const Snapshot& kept) {
    state.u_m = state.good_u_m;
    state.shift_m = state.good_shift_m;
    state.actuation = kept.actuation;
    state.tie_part = kept.tie_part;
    state.finger_N = kept.finger_N;
    state.factored = false;
}

bool finite(const DeviceLoad& load) {
    const auto all = [](const auto& values) {
        return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    };
    return all(load.actuation) && all(load.length) && std::isfinite(load.finger);
}

void describe(const DeviceModel& model, const DeviceState& state, ForwardAnswer& answer) {
    answer.depth_m = depth_m(model, state);
    answer.tilt = tilts(model, state);
    answer.force_N = state.finger_N;
    for (std::size_t j = 0; j < answer.actuation.size(); ++j)
        answer.actuation[j] = state.actuation[j] + state.tie_part[j];
    answer.length = lengths(model, state.u_m);
}

}  // namespace

ForwardAnswer equilibrium(const DeviceModel& model, DeviceState& state, const DeviceLoad& load) noexcept {
    ForwardAnswer answer;
    if (!finite(load)) {
        describe(model, state, answer);
        return answer;
    }
    const Goal goal = goal_of(model, state, load);
    const SmallColumn from = present(model, state, goal);
    double reached = 0.0;
    double step = 1.0;
    Snapshot kept = keep(state);
    for (int halvings = 0; reached < 1.0;) {
        const double share = std::min(1.0, reached + step);
        answer.status = newton(model, state, goal, from + share * (goal.value - from), answer);
        if (answer.status == DeviceStatus::good || answer.status == DeviceStatus::unstable) {
            reached = share;
            if (reached < 1.0) kept = keep(state);
            continue;
        }
        go_back(state, kept);
        if (++halvings > kMostHalvings) break;
        step *= 0.5;
    }
    describe(model, state, answer);
    return answer;
}

ForwardAnswer press_to_depth(const DeviceModel& model, DeviceState& state, const Actuation& actuation,
                             double depth) noexcept {
    DeviceLoad load;
    load.actuation = actuation;
    load.finger = depth;
    load.finger_by_position = true;
    return equilibrium(model, state, load);
}

ForwardAnswer prepare_press(const DeviceModel& model, DeviceState& state, double force_at_floor_N) noexcept {
    Actuation at_lower{};
    for (int j = 0; j < model.n_actuators(); ++j)
        at_lower[static_cast<std::size_t>(j)] = model.actuators[static_cast<std::size_t>(j)].lower;
    const auto rest_at = [&](double tension) {
        DeviceLoad load;
        load.actuation = at_lower;
        for (int j = 0; model.device.pretension && j < model.n_actuators(); ++j) {
            const auto at = static_cast<std::size_t>(j);
            if (model.driver[at] == model.driver[static_cast<std::size_t>(*model.device.pretension)])
                load.actuation[at] = tension;
        }
        const ForwardAnswer rest = equilibrium(model, state, load);
        state.rest_depth_m += depth_m(model, state);
        state.pretension = load.actuation;
        state.has_linear = false;
        return rest;
    };
    const double floor_m = model.device.depth_floor_m;
    if (!std::isfinite(force_at_floor_N)) return {};
    if (!model.device.pretension) return rest_at(0.0);
    const SoftActuator& tight = model.actuators[static_cast<std::size_t>(*model.device.pretension)];
    // how much too stiff the device is, as a force at the floor
    const auto excess_N = [&](double tension) {
        rest_at(tension);
        return press_to_depth(model, state, state.pretension, floor_m).force_N - force_at_floor_N;
    };
    double low = tight.lower, high = tight.upper;
    double below = excess_N(low);
    const DeviceState at_low = state;
    double above = below < 0.0 ? excess_N(high) : 0.0;
    if (below < 0.0 && !(above > 0.0)) {
        // More tension is not always stiffer, since a device may buckle on the way: the first tension that is stiff enough, or
        // the one that is stiffest, is looked for step by step.
        constexpr int kSteps = 16;
        const double first = low, step = (high - low) / kSteps;
        double stiffest_N = below;
        int best = 0;
        state = at_low;
        for (int k = 1; k <= kSteps && !(above > 0.0); ++k) {
            const double tension = first + step * k;
            const double there_N = excess_N(tension);
            if (there_N > stiffest_N) stiffest_N = there_N, best = k;
            if (there_N < 0.0) low = tension, below = there_N;
            if (there_N > 0.0) high = tension, above = there_N;
        }
        if (!(above > 0.0)) {
            state = at_low;
            for (int k = 1; k <= best; ++k) rest_at(first + step * k);
            low = high = first + step * best;
            above = 0.0;
        }
    }
    DeviceStatus status = below >= 0.0 || above <= 0.0 ? DeviceStatus::slow : DeviceStatus::good;
    if (below >= 0.0) high = low;
    if (below < 0.0 && above <= 0.0) low = high;
    // false position with halved ends (Illinois; Dowell & Jarratt, BIT 11, 1971)
    for (int i = 0, side = 0; i < 40 && high - low > 1e-9 * (tight.upper - tight.lower); ++i) {
        const double middle = (low * above - high * below) / (above - below);
        const double there = excess_N(middle);
        if (there == 0.0 || std::abs(there) < 1e-9 * std::abs(force_at_floor_N)) {
            low = high = middle;
        } else if (there < 0.0) {
            low = middle, below = there;
            if (side < 0) above *= 0.5;
            side = -1;
        } else {
            high = middle, above = there;
            if (side > 0) below *= 0.5;
            side = 1;
        }
    }
    ForwardAnswer answer = rest_at(0.5 * (low + high));
    answer.depth_m = depth_m(model, state);
    if (answer.status == DeviceStatus::good) answer.status = status;
    return answer;
}

}  // namespace palpa::tangible
