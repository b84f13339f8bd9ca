#include "tangible/plant_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/input_error.h"

namespace palpa::tangible {
namespace {

constexpr double kHandStep_s = 1e-3;
constexpr double kSlopeOver_m = 0.02e-3;

PlantSensor read_plant_sensor_options(files::JsonReader json) {
    json.only({"rate_Hz", "noise_mm", "delay_ms"});
    PlantSensor sensor;
    sensor.rate_Hz = json.number("rate_Hz", {0.0, 1e5}, sensor.rate_Hz);
    sensor.noise_m = 1e-3 * json.number("noise_mm", {0.0, 10.0}, 0.0);
    sensor.delay_s = 1e-3 * json.number("delay_ms", {0.0, 500.0}, 0.0);
    json.finish();
    return sensor;
}

PlantHand read_hand(files::JsonReader json) {
    json.only({"mass_kg", "damping_N_s_per_m"});
    PlantHand hand;
    hand.mass_kg = json.number("mass_kg", {0.001, 10.0});
    hand.damping_N_s_per_m = json.number("damping_N_s_per_m", {0.0, 1e3}, hand.damping_N_s_per_m);
    json.finish();
    return hand;
}

// SplitMix64 and the method of Box and Muller.
double uniform(std::uint64_t& state) {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}
double normal(std::uint64_t& state) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(state)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(state));
}

// Where the finger was.
double way_at_m(const PlantState& state, double time_s) {
    if (state.steps == 0) return state.depth_m;
    const std::int64_t oldest =
        std::max<std::int64_t>(0, state.steps - static_cast<std::int64_t>(PlantState::kHistory));
    for (std::int64_t k = state.steps - 1; k >= oldest; --k) {
        const auto i = static_cast<std::size_t>(k) % PlantState::kHistory;
        if (state.time_s[i] > time_s) continue;
        if (k == state.steps - 1) return state.way_m[i];
        const auto next = static_cast<std::size_t>(k + 1) % PlantState::kHistory;
        const double share = (time_s - state.time_s[i]) / (state.time_s[next] - state.time_s[i]);
        return state.way_m[i] + share * (state.way_m[next] - state.way_m[i]);
    }
    return state.way_m[static_cast<std::size_t>(oldest) % PlantState::kHistory];
}

// What the drives do with a command within a period.
void follow(const Plant& plant, const Actuation& wanted, const Lengths& wanted_length, PlantState& state) {
    const double left = plant.options.lag_s > 0.0 ? std::exp(-plant.period_s / plant.options.lag_s) : 0.0;
    for (std::size_t j = 0; j < plant.model->actuators.size(); ++j) {
        state.force[j] = wanted[j] + left * (state.force[j] - wanted[j]);
        state.length[j] = wanted_length[j] + left * (state.length[j] - wanted_length[j]);
    }
}

// Whether an actuator moves as one before it does: its length is given by that one's.
bool follows_another(const DeviceModel& model, std::size_t actuator) {
    for (const std::array<int, 2>& pair : model.equal_motion) {
        if (static_cast<std::size_t>(std::max(pair[0], pair[1])) == actuator) return true;
    }
    return false;
}

// The load on the body: drives, less what the guides take.
DeviceLoad load_of(const Plant& plant, const PlantState& state, bool friction) {
    DeviceLoad load;
    const DeviceModel& model = *plant.model;
    for (std::size_t j = 0; j < model.actuators.size(); ++j) {
        const bool cable = model.actuators[j].kind == ActuatorKind::cable;
        load.by_position[j] = plant.command == CommandKind::position && cable && !follows_another(model, j);
        load.actuation[j] = state.force[j];
        load.length[j] = state.length[j];
        if (cable && friction)
            load.actuation[j] *= 1.0 - plant.options.friction_share *
                                           friction_sense((state.body_length[j] - state.length[j]) / plant.period_s);
    }
    return load;
}

PlantAnswer answer_of(const ForwardAnswer& forward, double depth_m) {
    PlantAnswer out;
    out.status = forward.status;
    out.iterations = forward.iterations;
    out.depth_m = depth_m;
    out.force_N = std::max(0.0, forward.force_N);
    out.touching = forward.force_N > 0.0;
    return out;
}

bool found(DeviceStatus status) { return status == DeviceStatus::good || status == DeviceStatus::unstable; }

// The force on a finger at state.depth_m. A finger that would have to pull does not touch, and the body is where it is
// without it.
PlantAnswer finger_force(const Plant& plant, DeviceLoad load, PlantState& state) {
    load.finger_by_position = true;
    load.finger = state.depth_m;
    const ForwardAnswer held = equilibrium(*plant.model, state.device, load);
    if (!found(held.status) || held.force_N >= 0.0) return answer_of(held, state.depth_m);
    load.finger_by_position = false;
    load.finger = 0.0;
    return answer_of(equilibrium(*plant.model, state.device, load), state.depth_m);
}

double volume_m3(const mechanics::LargeBody& body, Eigen::Index cell) {
    const auto i = static_cast<std::size_t>(cell);
    double sum_m3 = 0.0;
    if (i < body.hexes.size()) {
        for (const double part_m3 : body.hexes[i].volume_m3) sum_m3 += part_m3;
    } else {
        sum_m3 = body.tets[i].volume_m3[0];
    }
    return sum_m3;
}

// The share of the body's mass that moves with the effector: sum of m_i |du_i / d depth|^2 over the nodes.
double moving_mass_kg(const DeviceModel& model, double density_kg_per_m3) {
    DeviceState state = rest_state(model);
    DeviceLoad load;
    load.finger_by_position = true;
    for (std::size_t j = 0; j < model.actuators.size(); ++j) load.actuation[j] = model.actuators[j].lower;
    const Eigen::Matrix3Xd before_m = state.u_m;
    constexpr double kStep_m = 1e-4;
    load.finger = kStep_m;
    if (!found(equilibrium(model, state, load).status)) return 0.0;
    const Eigen::Matrix3Xd moved = (state.u_m - before_m) / kStep_m;
    const mechanics::Mesh& mesh = model.body.mesh;
    const auto corners = static_cast<double>(mesh.cells.rows());
    double mass_kg = 0.0;
    for (Eigen::Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        const double share_kg = density_kg_per_m3 * volume_m3(model.body, cell) / corners;
        for (Eigen::Index k = 0; k < mesh.cells.rows(); ++k)
            mass_kg += share_kg * moved.col(mesh.cells(k, cell)).squaredNorm();
    }
    return mass_kg;
}

}  // namespace

PlantOptions read_plant(const std::string& exact_or_file) {
    PlantOptions options;
    options.as_fitted = exact_or_file == "exact";
    if (options.as_fitted) return options;
    const files::Json root = files::read_json(exact_or_file);
    files::JsonReader json(root, exact_or_file);
    json.only({"name", "device", "modulus_factor", "friction_share", "lag_ms", "inertia", "sensor", "hand"});
    options.name = json.text("name");
    if (json.has("device")) {
        options.device = json.any("device");
        if (!options.device.is_object())
            json.fail("device", files::described(options.device), "an object of keys to change");
    }
    options.modulus_factor = json.number("modulus_factor", {0.1, 10.0}, 1.0);
    options.friction_share = json.number("friction_share", {0.0, 0.5}, 0.0);
    options.lag_s = 1e-3 * json.number("lag_ms", {0.0, 1e4}, 0.0);
    options.inertia = json.boolean("inertia", false);
    if (auto sensor = json.optional_object("sensor")) options.sensor = read_plant_sensor_options(*sensor);
    if (auto hand = json.optional_object("hand")) options.hand = read_hand(*hand);
    json.finish();
    return options;
}

PlantOptions of_fit(PlantOptions options, const DeviceFit& fit) {
    if (!options.as_fitted) return options;
    options.as_fitted = false;
    options.modulus_factor = fit.modulus_factor;
    options.friction_share = fit.friction_share;
    options.sensor.zero_m = fit.zero_m;
    if (!(options.lag_s > 0.0)) options.lag_s = fit.lag_s;
    return options;
}

Plant make_plant(const std::shared_ptr<const DeviceModel>& model, const PlantOptions& options,
                 const LoopOptions& loop) {
    Plant plant;
    plant.command = loop.command;
    plant.period_s = 1.0 / loop.rate_Hz;
    plant.model = model;
    const SoftDevice& of_loop = model->device;
    plant.options = of_fit(options, of_loop.fit);
    if (!options.device.empty() || plant.options.modulus_factor != of_loop.fit.modulus_factor) {
        files::Json json = files::read_json(of_loop.file);
        json.merge_patch(options.device);
        SoftDevice device = parse_soft_device(json, of_loop.file, std::filesystem::path(of_loop.file).parent_path());
        device.fit = {};  // what was fitted says how the model is to follow the plant
        device.fit.modulus_factor = plant.options.modulus_factor;
        plant.model = std::make_shared<const DeviceModel>(make_device_model(device));
    }
    if (options.inertia) {
        const double density = of_loop.density_kg_per_m3;
        if (!(density > 0.0))
            throw files::bad_input(of_loop.file, "density_kg_per_m3", "no density", "one, for a plant with inertia");
        plant.moving_kg = moving_mass_kg(*plant.model, density);
    }
    return plant;
}

PlantState make_plant_state(const Plant& plant, const TangiblePlan& loop, std::uint64_t seed) {
    PlantState state;
    // the loop has found its own way to the pretension, also where the device buckles on it
    state.device = plant.model == loop.model ? loop.start : rest_state(*plant.model);
    state.force = loop.start.actuation;
    state.length = lengths(*loop.model, loop.start.u_m);
    state.body_length = state.length;
    state.random = seed;
    const DeviceLoad load = load_of(plant, state, false);
    const ForwardAnswer rest = equilibrium(*plant.model, state.device, load);
    if (!found(rest.status))
        throw std::runtime_error("the plant " + plant.options.name + " has no equilibrium at the device's pretension");
    state.device.rest_depth_m += rest.depth_m;
    return state;
}

void place_finger(double time_s, double depth_m, PlantState& state) noexcept {
    const auto i = static_cast<std::size_t>(state.steps) % PlantState::kHistory;
    state.time_s[i] = time_s;
    state.way_m[i] = depth_m;
    state.depth_m = depth_m;
    ++state.steps;
}

TangibleFeedback read_plant_sensor(const Plant& plant, double time_s, PlantState& state) noexcept {
    const PlantSensor& sensor = plant.options.sensor;
    constexpr double kRoundOff_s = 1e-9;
    double at_s = time_s - sensor.delay_s;
    if (sensor.rate_Hz > 0.0) at_s = std::floor(at_s * sensor.rate_Hz + kRoundOff_s) / sensor.rate_Hz;
    if (!state.begun || at_s > state.read_s + kRoundOff_s) {
        state.begun = true;
        state.read_s = at_s;
        state.reading_m = way_at_m(state, at_s);
        if (sensor.noise_m > 0.0) state.reading_m += sensor.noise_m * normal(state.random);
    }
    TangibleFeedback out;
    out.sensor_m = state.reading_m + sensor.zero_m;
    out.sensor_s = state.read_s + sensor.delay_s;  // the loop knows when it came
    out.has_sensor = 1.0;
    return out;
}

PlantAnswer step_plant(const Plant& plant, const TangibleCommand& command, PlantState& state) noexcept {
    follow(plant, command.actuation, command.length, state);
    const DeviceLoad load = load_of(plant, state, plant.options.friction_share > 0.0);
    state.body_length = state.length;
    PlantAnswer out = finger_force(plant, load, state);
    if (plant.moving_kg > 0.0 && state.steps >= 3 && out.touching) {
        const auto at = [&](std::int64_t back) {
            return state.way_m[static_cast<std::size_t>(state.steps - 1 - back) % PlantState::kHistory];
        };
        out.force_N += plant.moving_kg * (at(0) - 2.0 * at(1) + at(2)) / (plant.period_s * plant.period_s);
        out.force_N = std::max(0.0, out.force_N);
    }
    return out;
}

PlantAnswer push_plant(const Plant& plant, const TangibleCommand& command, double time_s, double hand_N,
                       PlantState& state) noexcept {
    follow(plant, command.actuation, command.length, state);
    DeviceLoad load = load_of(plant, state, plant.options.friction_share > 0.0);
    state.body_length = state.length;
    PlantAnswer out = finger_force(plant, load, state);
    if (!found(out.status)) return out;
    const double at_m = state.depth_m;
    state.depth_m = at_m + kSlopeOver_m;
    const PlantAnswer beyond = finger_force(plant, load, state);
    if (found(beyond.status)) state.stiffness_N_per_m = std::max(0.0, (beyond.force_N - out.force_N) / kSlopeOver_m);
    const double mass_kg = plant.options.hand.mass_kg + plant.moving_kg;
    const int steps = std::max(1, static_cast<int>(std::lround(plant.period_s / kHandStep_s)));
    const double dt_s = plant.period_s / steps;
    double depth_m = at_m;
    double speed = state.speed_m_per_s;
    for (int k = 1; k <= steps; ++k) {  // the damping implicitly, so that it cannot feed in energy
        const double device_N = std::max(0.0, out.force_N + state.stiffness_N_per_m * (depth_m - at_m));
        speed =
            (mass_kg * speed + dt_s * (hand_N - device_N)) / (mass_kg + dt_s * plant.options.hand.damping_N_s_per_m);
        depth_m += dt_s * speed;
        place_finger(time_s + k * dt_s, depth_m, state);
    }
    state.speed_m_per_s = speed;
    return out;
}

PlantAnswer yield_to_hand(const Plant& plant, const TangibleCommand& command, double time_s, double hand_N,
                          PlantState& state) noexcept {
    follow(plant, command.actuation, command.length, state);
    DeviceLoad load = load_of(plant, state, plant.options.friction_share > 0.0);
    state.body_length = state.length;
    load.finger = std::max(0.0, hand_N);
    const ForwardAnswer yielded = equilibrium(*plant.model, state.device, load);
    PlantAnswer out = answer_of(yielded, state.depth_m);
    if (!found(yielded.status)) return out;
    const double most_m = kHandSpeed_m_per_s * plant.period_s;
    const double aim_m = hand_N > 0.0 ? yielded.depth_m : 0.0;
    out.depth_m = state.depth_m + std::clamp(aim_m - state.depth_m, -most_m, most_m);
    place_finger(time_s + plant.period_s, out.depth_m, state);
    return out;
}

PlantAnswer held_force(const Plant& plant, const Actuation& actuation, const Lengths& length, double depth_m,
                       PlantState& state) noexcept {
    state.force = actuation;
    state.length = length;
    state.depth_m = depth_m;
    return finger_force(plant, load_of(plant, state, false), state);
}

}  // namespace palpa::tangible
