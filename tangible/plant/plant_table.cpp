#include "tangible/plant/plant_table.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace palpa::tangible {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostAxes = 5;
constexpr double kDifferShare = 0.02;  // of an actuator's range, for the slope of a difference

bool has_equilibrium(DeviceStatus status) { return status == DeviceStatus::good || status == DeviceStatus::unstable; }

int nodes_per_axis(int wanted, std::size_t axes) {
    return axes == 1 ? wanted
                     : std::max(3, static_cast<int>(std::lround(std::pow(wanted, 1.2 / static_cast<double>(axes)))));
}

void add_axis(const DeviceModel& model, std::vector<int> members, bool differ, PlantTable& table) {
    PlantTable::Axis axis;
    axis.members = std::move(members);
    axis.differ = differ;
    const SoftActuator& first = model.actuators[static_cast<std::size_t>(axis.members.front())];
    axis.lower = first.lower;
    axis.upper = first.upper;
    table.axes.push_back(axis);
}

std::vector<PlantTable::Axis> axes_of(const DeviceModel& model) {
    PlantTable table;
    std::vector<bool> taken(model.actuators.size(), false);
    for (const SoftTie& tie : model.device.ties) {
        if (!tie.force) continue;
        add_axis(model, tie.actuators, false, table);
        for (const int actuator : tie.actuators) taken[static_cast<std::size_t>(actuator)] = true;
    }
    std::vector<int> cables;
    for (std::size_t j = 0; j < taken.size(); ++j) {
        if (taken[j]) continue;
        if (model.actuators[j].kind == ActuatorKind::cable) {
            cables.push_back(static_cast<int>(j));
        } else {
            add_axis(model, {static_cast<int>(j)}, false, table);
        }
    }
    if (!cables.empty()) add_axis(model, cables, cables.size() > 1, table);
    return table.axes;
}

std::size_t node_count(const PlantTable& table) {
    std::size_t count = 1;
    for (const PlantTable::Axis& axis : table.axes) count *= static_cast<std::size_t>(axis.nodes);
    return count;
}

Actuation actuation_of(const PlantTable& table, std::size_t node) {
    Actuation actuation{};
    for (const PlantTable::Axis& axis : table.axes) {
        const auto n = static_cast<std::size_t>(axis.nodes);
        const double share = static_cast<double>(node % n) / static_cast<double>(n - 1);
        for (const int member : axis.members)
            actuation[static_cast<std::size_t>(member)] = axis.lower + share * (axis.upper - axis.lower);
        node /= n;
    }
    return actuation;
}

// The force on a finger held at a depth from the shape at rest; NaN without an equilibrium.
double held_N(const DeviceModel& model, const DeviceLoad& load, DeviceState& state, Lengths* length) {
    const ForwardAnswer answer = equilibrium(model, state, load);
    if (!has_equilibrium(answer.status)) return kNothing;
    if (length != nullptr) *length = answer.length;
    return answer.force_N;
}

// dF/da of each actuator by itself, the finger held where it is.
void fill_slopes(const DeviceModel& model, const DeviceLoad& load, double force_N, const DeviceState& at,
                 DeviceState& work, std::size_t place, PlantTable& table) {
    for (const PlantTable::Axis& axis : table.axes) {
        if (!axis.differ) continue;
        for (const int member : axis.members) {
            const auto j = static_cast<std::size_t>(member);
            const double step =
                kDifferShare * (axis.upper - axis.lower) * (load.actuation[j] < axis.upper ? 1.0 : -1.0);
            DeviceLoad moved = load;
            moved.actuation[j] += step;
            work = at;
            const double slope = (held_N(model, moved, work, nullptr) - force_N) / step;
            table.slope[place * static_cast<std::size_t>(table.actuators) + j] = std::isfinite(slope) ? slope : 0.0;
        }
    }
}

// From the state of a node before; where that lies too far away, from rest.
ForwardAnswer without_finger(const DeviceModel& model, const DeviceState& rest, const DeviceLoad& load,
                             DeviceState& state) {
    const ForwardAnswer answer = equilibrium(model, state, load);
    if (has_equilibrium(answer.status)) return answer;
    state = rest;
    return equilibrium(model, state, load);
}

void fill_node(const DeviceModel& model, const DeviceState& rest, std::size_t node, DeviceState& state,
               DeviceState& work, PlantTable& table) {
    DeviceLoad load;
    load.actuation = actuation_of(table, node);
    const ForwardAnswer free = without_finger(model, rest, load, state);
    if (!has_equilibrium(free.status)) {
        state = rest;
        return;
    }
    table.surface_m[node] = free.depth_m;
    load.finger_by_position = true;
    work = state;
    DeviceState pressed = state;
    for (int k = 0; k < table.depths; ++k) {
        const std::size_t place = node * static_cast<std::size_t>(table.depths) + static_cast<std::size_t>(k);
        load.finger = free.depth_m + k * table.step_m;
        Lengths length{};
        const double force_N = held_N(model, load, pressed, &length);
        if (!std::isfinite(force_N)) return;  // pulled through: what is deeper has no equilibrium either
        table.force_N[place] = std::max(0.0, force_N);
        std::copy_n(length.begin(), table.actuators,
                    table.length_m.begin() + static_cast<std::ptrdiff_t>(place) * table.actuators);
        if (!table.slope.empty()) fill_slopes(model, load, force_N, pressed, work, place, table);
    }
}

// Beyond the last equilibrium the force stays what it was: a device that gives way.
void fill_missing(PlantTable& table) {
    const auto depths = static_cast<std::size_t>(table.depths), n = static_cast<std::size_t>(table.actuators);
    std::size_t good = table.surface_m.size();
    for (std::size_t node = table.surface_m.size(); node-- > 0;) {
        if (std::isfinite(table.surface_m[node]) && std::isfinite(table.force_N[node * depths])) good = node;
    }
    if (good == table.surface_m.size()) throw std::runtime_error("the plant has no equilibrium at any actuation");
    const auto copy_place = [&](std::size_t from, std::size_t to) {
        table.force_N[to] = table.force_N[from];
        std::copy_n(table.length_m.begin() + static_cast<std::ptrdiff_t>(from * n), n,
                    table.length_m.begin() + static_cast<std::ptrdiff_t>(to * n));
        ++table.missing;
    };
    for (std::size_t node = 0; node < table.surface_m.size(); ++node) {
        if (!std::isfinite(table.surface_m[node])) table.surface_m[node] = table.surface_m[good];
        if (!std::isfinite(table.force_N[node * depths])) copy_place(good * depths, node * depths);
        for (std::size_t k = 1; k < depths; ++k) {
            const std::size_t place = node * depths + k;
            if (!std::isfinite(table.force_N[place])) copy_place(place - 1, place);
        }
        good = node;
    }
}

}  // namespace

PlantTable make_plant_table(const DeviceModel& model, const TableSize& size, const std::function<void(double)>& told) {
    PlantTable table;
    table.axes = axes_of(model);
    if (table.axes.size() > kMostAxes) throw std::runtime_error("the plant has more than five drives of its own");
    table.actuators = model.n_actuators();
    table.depths = size.depth;
    table.step_m = size.deepest_m / (size.depth - 1);
    bool differ = false;
    for (PlantTable::Axis& axis : table.axes) {
        axis.nodes = nodes_per_axis(size.actuation, table.axes.size());
        differ = differ || axis.differ;
    }
    const std::size_t nodes = node_count(table), places = nodes * static_cast<std::size_t>(table.depths);
    table.surface_m.assign(nodes, kNothing);
    table.force_N.assign(places, kNothing);
    table.length_m.assign(places * static_cast<std::size_t>(table.actuators), 0.0);
    if (differ) table.slope.assign(places * static_cast<std::size_t>(table.actuators), 0.0);
    std::atomic<std::size_t> next{0};
    std::mutex telling;
    const DeviceState rest = rest_state(model);
    const auto work_on = [&] {
        DeviceState state = rest, work = rest;
        for (std::size_t node = next++; node < nodes; node = next++) {
            fill_node(model, rest, node, state, work, table);
            if (!told) continue;
            const std::lock_guard<std::mutex> guard(telling);
            told(static_cast<double>(node + 1) / static_cast<double>(nodes));
        }
    };
    std::vector<std::thread> helpers;
    for (unsigned i = 1; i < std::clamp(std::thread::hardware_concurrency(), 1u, 8u); ++i)
        helpers.emplace_back(work_on);
    work_on();
    for (std::thread& helper : helpers) helper.join();
    fill_missing(table);
    return table;
}

namespace {

struct Corner {
    std::size_t node = 0;
    double weight = 1.0;
};

// The nodes around an actuation, and how far below the lowest tension it is: 1 on it and above.
struct Corners {
    static constexpr std::size_t kMost = 1u << kMostAxes;
    std::array<Corner, kMost> corner{};
    std::size_t count = 1;
    double slack = 1.0;
};

Corners corners_of(const PlantTable& table, const Actuation& actuation) noexcept {
    Corners out;
    std::size_t stride = 1;
    for (const PlantTable::Axis& axis : table.axes) {
        double mean = 0.0;
        for (const int member : axis.members) mean += actuation[static_cast<std::size_t>(member)];
        mean = std::isfinite(mean) ? mean / static_cast<double>(axis.members.size()) : axis.lower;
        if (axis.lower > 0.0) out.slack *= std::clamp(mean / axis.lower, 0.0, 1.0);
        const double at =
            (std::clamp(mean, axis.lower, axis.upper) - axis.lower) / (axis.upper - axis.lower) * (axis.nodes - 1);
        const int low = std::min(static_cast<int>(at), axis.nodes - 2);
        const double share = at - low;
        const std::size_t before = out.count;
        for (std::size_t i = 0; i < before; ++i) {
            out.corner[before + i] = out.corner[i];
            out.corner[before + i].node += stride * static_cast<std::size_t>(low + 1);
            out.corner[before + i].weight *= share;
            out.corner[i].node += stride * static_cast<std::size_t>(low);
            out.corner[i].weight *= 1.0 - share;
        }
        out.count = 2 * before;
        stride *= static_cast<std::size_t>(axis.nodes);
    }
    return out;
}

// What each cable differs by from the mean of its axis, times its slope.
double difference_N(const PlantTable& table, const Actuation& actuation, std::size_t place) noexcept {
    double sum_N = 0.0;
    for (const PlantTable::Axis& axis : table.axes) {
        if (!axis.differ) continue;
        double mean = 0.0;
        for (const int member : axis.members) mean += actuation[static_cast<std::size_t>(member)];
        mean /= static_cast<double>(axis.members.size());
        for (const int member : axis.members) {
            const auto j = static_cast<std::size_t>(member);
            sum_N += (actuation[j] - mean) * table.slope[place * static_cast<std::size_t>(table.actuators) + j];
        }
    }
    return sum_N;
}

}  // namespace

PlantTouch touch(const PlantTable& table, const Actuation& actuation, double depth_m) noexcept {
    const Corners corners = corners_of(table, actuation);
    PlantTouch out;
    for (std::size_t i = 0; i < corners.count; ++i)
        out.surface_m += corners.corner[i].weight * table.surface_m[corners.corner[i].node];
    const double pressed_m = std::max(depth_m - out.surface_m, 0.0);
    const double at = std::min(pressed_m / table.step_m, static_cast<double>(table.depths - 1));
    const int low = std::min(static_cast<int>(at), table.depths - 2);
    const auto n = static_cast<std::size_t>(table.actuators);
    for (std::size_t i = 0; i < corners.count; ++i) {
        for (const int k : {low, low + 1}) {
            const double weight = corners.corner[i].weight * (k == low ? 1.0 - (at - low) : at - low);
            const std::size_t place =
                corners.corner[i].node * static_cast<std::size_t>(table.depths) + static_cast<std::size_t>(k);
            out.force_N += weight * table.force_N[place];
            if (!table.slope.empty() && pressed_m > 0.0) out.force_N += weight * difference_N(table, actuation, place);
            for (std::size_t j = 0; j < n; ++j) out.length[j] += weight * table.length_m[place * n + j];
        }
    }
    out.force_N = depth_m > out.surface_m ? std::max(0.0, corners.slack * out.force_N) : 0.0;
    return out;
}

}  // namespace palpa::tangible
