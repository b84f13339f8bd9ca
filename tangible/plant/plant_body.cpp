#include "tangible/plant/plant_body.h"

#include <algorithm>
#include <cmath>

namespace palpa::tangible {
namespace {

constexpr double kZeroAfter_s = 0.5;
constexpr int kBisections = 24;

// The tension at which the cables have the commanded length under the finger; 0 where they are slack.
double tension_at(const PlantBody& body, const PlantTable::Axis& axis, double length_m, double depth_m,
                  Actuation trial) noexcept {
    const auto mean_length = [&](double tension_N) {
        for (const int member : axis.members) trial[static_cast<std::size_t>(member)] = tension_N;
        const PlantTouch touched = touch(*body.table, trial, depth_m);
        double sum_m = 0.0;
        for (const int member : axis.members) sum_m += touched.length[static_cast<std::size_t>(member)];
        return sum_m / static_cast<double>(axis.members.size());
    };
    if (mean_length(axis.lower) <= length_m) return 0.0;
    double low_N = axis.lower, high_N = axis.upper;
    for (int i = 0; i < kBisections; ++i) {
        const double middle_N = 0.5 * (low_N + high_N);
        (mean_length(middle_N) > length_m ? low_N : high_N) = middle_N;
    }
    return 0.5 * (low_N + high_N);
}

bool is_cable(const PlantBody& body, const PlantTable::Axis& axis) noexcept {
    return body.plant.model->actuators[static_cast<std::size_t>(axis.members.front())].kind == ActuatorKind::cable;
}

// Tensions and pressures on the body: what the drives give, less what the guides take.
Actuation on_body(const PlantBody& body, const Lengths& before, double dt_s, double depth_m) noexcept {
    Actuation out = body.command;
    for (const PlantTable::Axis& axis : body.table->axes) {
        if (!is_cable(body, axis)) continue;
        if (body.drive.by_length) {
            double mean_m = 0.0;
            for (const int member : axis.members) mean_m += body.command[static_cast<std::size_t>(member)];
            mean_m /= static_cast<double>(axis.members.size());
            const double tension_N = tension_at(body, axis, mean_m, depth_m, out);
            for (const int member : axis.members) out[static_cast<std::size_t>(member)] = tension_N;
        }
        for (const int member : axis.members) {
            const auto j = static_cast<std::size_t>(member);
            const double wound_m_per_s = dt_s > 0.0 ? (before[j] - body.length[j]) / dt_s : 0.0;
            out[j] *= 1.0 - body.plant.options.friction_share * friction_sense(wound_m_per_s);
        }
    }
    return out;
}

void move_finger(double dt_s, PlantBody& body) noexcept {
    const double since_s = body.time_s - body.driven_s - kZeroAfter_s;
    const PlantHand& hand = body.plant.options.hand;
    if (hand.mass_kg <= 0.0) {
        body.finger_m = body.motion.depth_m * press_share(body.motion, since_s);
        return;
    }
    const double push_N = body.motion.hand_N * press_share(body.motion, since_s);
    // the damping implicitly, so that it cannot feed in energy
    body.speed_m_per_s = (hand.mass_kg * body.speed_m_per_s + dt_s * (push_N - body.force_N)) /
                         (hand.mass_kg + dt_s * hand.damping_N_s_per_m);
    body.finger_m += dt_s * body.speed_m_per_s;
}

}  // namespace

double press_share(const FingerMotion& motion, double time_s) noexcept {
    constexpr double kPeakOverMean = 1.875;  // of a minimum-jerk motion
    const double way_s = kPeakOverMean * motion.depth_m / motion.speed_m_per_s;
    const double round_s = 2.0 * way_s + motion.pause_s;
    if (!(time_s > 0.0)) return 0.0;
    const double at_s = time_s - round_s * std::floor(time_s / round_s) - motion.pause_s;
    if (at_s <= 0.0) return 0.0;
    const double s = at_s < way_s ? at_s / way_s : 2.0 - at_s / way_s;
    return s * s * s * (10.0 + s * (6.0 * s - 15.0));
}

void step_body(double dt_s, const Actuation& drives, bool driven, PlantBody& body) noexcept {
    body.time_s += dt_s;
    const double left = body.plant.options.lag_s > 0.0 ? std::exp(-dt_s / body.plant.options.lag_s) : 0.0;
    for (std::size_t j = 0; j < drives.size(); ++j) body.command[j] = drives[j] + left * (body.command[j] - drives[j]);
    if (driven && body.driven_s < 0.0) body.driven_s = body.time_s;
    const bool begins = body.driven_s >= 0.0 && body.time_s - body.driven_s > kZeroAfter_s;
    if (begins && !body.zeroed) {
        body.zeroed = true;
        body.zero_m = touch(*body.table, body.actuation, 0.0).surface_m;
    }
    if (body.zeroed) move_finger(dt_s, body);
    const double surface_m = touch(*body.table, body.actuation, 0.0).surface_m;
    const double depth_m = body.zeroed ? body.zero_m + body.finger_m : surface_m;
    const PlantTouch touched = touch(*body.table, body.actuation, depth_m);
    const Lengths before = body.length;
    body.length = touched.length;
    body.actuation = on_body(body, body.time_s > dt_s ? before : body.length, dt_s, depth_m);
    body.force_N = touch(*body.table, body.actuation, depth_m).force_N;
    place_finger(body.time_s, body.finger_m, body.sensor);
}

double displacement_m(PlantBody& body) noexcept {
    return read_plant_sensor(body.plant, body.time_s, body.sensor).sensor_m;
}

}  // namespace palpa::tangible
