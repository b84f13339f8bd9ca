#include "devices/simulators/arm_plant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa::devices::simulators {
namespace {

constexpr double kSubstep_s = 1e-4;
constexpr int kSubstepsPerTick = 10;  // of the arm's own controller, 1 kHz
constexpr double kGravity_m_per_s2 = 9.80665;
constexpr double kArmSilence_s = 0.1;
constexpr double kVelocityFilter_Hz = 20.0;
constexpr double kServo_N_per_m = 2e4;  // mode position
constexpr double kStop_N_per_m = 2e4;
constexpr double kStop_N_s_per_m = 100.0;

// Friction after one step. Implicit in the bristle, which is stiff at high speed.
double friction_N(const ArmPlantParameters& arm, double v_m_per_s, double& bristle_m) {
    const double ratio = v_m_per_s / arm.stribeck_m_per_s;
    const double g_N = arm.coulomb_N + (arm.static_N - arm.coulomb_N) * std::exp(-ratio * ratio);
    const double rate_per_s = arm.stick_N_per_m * std::abs(v_m_per_s) / g_N;
    const double before_m = bristle_m;
    bristle_m = (bristle_m + v_m_per_s * kSubstep_s) / (1.0 + rate_per_s * kSubstep_s);
    const double bristle_m_per_s = (bristle_m - before_m) / kSubstep_s;
    return arm.stick_N_per_m * bristle_m + arm.stick_N_s_per_m * bristle_m_per_s + arm.viscous_N_s_per_m * v_m_per_s;
}

double hand_force_N(ArmPlant& plant) {
    if (plant.press.empty()) return 0.0;
    const double t_s = plant.time_s - plant.hand_began_s;
    const PressRow row = press_at(plant.press, t_s, plant.press_at);
    if (std::isfinite(row.force_N)) return row.force_N - plant.arm.hand_N_s_per_m * plant.velocity_m_per_s;
    std::size_t at = plant.press_at;
    const double wanted_m_per_s = (press_at(plant.press, t_s + kSubstep_s, at).depth_m - row.depth_m) / kSubstep_s;
    return plant.arm.hand_N_per_m * (row.depth_m - plant.depth_m) +
           plant.arm.hand_N_s_per_m * (wanted_m_per_s - plant.velocity_m_per_s);
}

double motor_force_N(const ArmPlant& plant) {
    if (plant.time_s - plant.commanded_s > kArmSilence_s) return 0.0;
    switch (static_cast<ArmMode>(plant.command.mode)) {
        case ArmMode::rest:
            return 0.0;
        case ArmMode::force:
            return plant.command.force_N;
        case ArmMode::position: {
            const double critical = 2.0 * std::sqrt(kServo_N_per_m * plant.arm.mass_kg);
            return kServo_N_per_m * (plant.depth_m - plant.command.depth_m) + critical * plant.velocity_m_per_s;
        }
    }
    return 0.0;
}

double stop_force_N(const ArmPlant& plant) {
    const double beyond_m = plant.depth_m - std::clamp(plant.depth_m, plant.arm.lowest_m, plant.arm.deepest_m);
    return beyond_m == 0.0 ? 0.0 : kStop_N_per_m * beyond_m + kStop_N_s_per_m * plant.velocity_m_per_s;
}

double encoded_m(const ArmPlant& plant) {
    return plant.arm.encoder_step_m * std::floor(plant.depth_m / plant.arm.encoder_step_m);
}

// The arm's controller looks at its encoder.
void tick(ArmPlant& plant) {
    constexpr double kTick_s = kSubstep_s * kSubstepsPerTick;
    const double now_m = encoded_m(plant);
    const double share = 1.0 - std::exp(-2.0 * std::numbers::pi * kVelocityFilter_Hz * kTick_s);
    plant.measured_m_per_s += share * ((now_m - plant.encoder_m) / kTick_s - plant.measured_m_per_s);
    plant.encoder_m = now_m;
}

void substep(ArmPlant& plant) {
    const ArmPlantParameters& arm = plant.arm;
    plant.time_s += kSubstep_s;
    plant.motor_N = motor_force_N(plant);
    const bool led = plant.command.mode == static_cast<std::uint16_t>(ArmMode::position);
    if (plant.hand_began_s < 0.0 || (plant.press.empty() && !led)) {  // the brake holds
        plant.velocity_m_per_s = 0.0;
        return;
    }
    plant.hand_N = hand_force_N(plant);
    const double ripple_N = arm.ripple_N * std::sin(2.0 * std::numbers::pi * plant.depth_m / arm.ripple_wavelength_m +
                                                    arm.ripple_phase_rad);
    const double force_N = plant.hand_N + arm.weight_kg * kGravity_m_per_s2 - plant.motor_N - ripple_N -
                           stop_force_N(plant) - friction_N(arm, plant.velocity_m_per_s, plant.bristle_m);
    plant.velocity_m_per_s += kSubstep_s * force_N / arm.mass_kg;
    plant.depth_m += kSubstep_s * plant.velocity_m_per_s;
    if (++plant.substeps % kSubstepsPerTick == 0) tick(plant);
}

}  // namespace

ArmPlantParameters arm_parameters(std::uint64_t seed) {
    ArmPlantParameters arm;
    if (seed == 0) return arm;
    std::mt19937_64 random(seed);
    constexpr double kScatter = 0.2;
    std::uniform_real_distribution<double> factor(1.0 - kScatter, 1.0 + kScatter);
    for (double* value : {&arm.mass_kg, &arm.coulomb_N, &arm.static_N, &arm.stribeck_m_per_s, &arm.viscous_N_s_per_m,
                          &arm.ripple_N, &arm.ripple_wavelength_m, &arm.weight_kg, &arm.encoder_step_m})
        *value *= factor(random);
    arm.static_N = std::max(arm.static_N, arm.coulomb_N);
    arm.ripple_phase_rad = std::uniform_real_distribution<double>(0.0, 2.0 * std::numbers::pi)(random);
    return arm;
}

ArmPlant make_arm_plant(const ArmPlantParameters& arm, std::vector<PressRow> press, std::uint64_t seed) {
    ArmPlant plant;
    plant.arm = arm;
    plant.press = std::move(press);
    plant.random.seed(seed);
    if (!plant.press.empty() && std::isfinite(plant.press.front().depth_m)) plant.depth_m = plant.press.front().depth_m;
    plant.encoder_m = encoded_m(plant);
    return plant;
}

void command(const ArmCommandPacket& wanted, ArmPlant& plant) {
    plant.command = wanted;
    plant.commanded_s = plant.time_s;
    if (plant.hand_began_s < 0.0 && wanted.mode != static_cast<std::uint16_t>(ArmMode::rest))
        plant.hand_began_s = plant.time_s;
}

void command(const ArmCommand& wanted, ArmPlant& plant) {
    command(packet_of(wanted, plant.command.sequence + 1, plant.time_s), plant);
}

void advance(double dt_s, ArmPlant& plant) {
    for (long left = std::lround(dt_s / kSubstep_s); left > 0; --left) substep(plant);
}

double sensor_N(ArmPlant& plant) {
    return plant.hand_N + plant.arm.sensor_noise_N * std::normal_distribution<double>()(plant.random);
}

ArmFeedbackPacket feedback_packet(ArmPlant& plant) {
    ArmFeedbackPacket packet;
    packet.sequence = ++plant.sent;
    packet.state = plant.time_s - plant.commanded_s > kArmSilence_s ? 1 : 0;
    packet.answers = plant.command.sequence;
    packet.host_time_s = plant.command.host_time_s;
    packet.device_time_s = plant.time_s;
    if (!plant.press.empty()) {
        const PressRow& at = plant.press[std::min(plant.press_at, plant.press.size() - 1)];
        packet.x_m = at.x_m;
        packet.y_m = at.y_m;
    }
    packet.depth_m = encoded_m(plant);
    packet.velocity_m_per_s = plant.measured_m_per_s;
    packet.motor_N = plant.motor_N;
    return packet;
}

ArmFeedback feedback(ArmPlant& plant) {
    const ArmFeedbackPacket packet = feedback_packet(plant);
    ArmFeedback out;
    out.time_s = plant.time_s;
    out.device_time_s = plant.time_s;
    out.x_m = packet.x_m;
    out.y_m = packet.y_m;
    out.depth_m = packet.depth_m;
    out.velocity_m_per_s = packet.velocity_m_per_s;
    out.sensor_N = sensor_N(plant);
    out.has_sensor = 1.0;
    return out;
}

std::optional<std::array<std::uint8_t, kArmFeedback_bytes>> answer(std::span<const std::uint8_t> bytes,
                                                                   ArmPlant& plant) {
    ArmCommandPacket packet;
    if (!decode(bytes, packet)) return std::nullopt;
    command(packet, plant);
    return encode(feedback_packet(plant));
}

}  // namespace palpa::devices::simulators
