#pragma once
// A simulated force arm with one degree of freedom, the hand that holds it, and the force sensor between them. A model
// without clock or port: the program arm_simulator and a run in virtual time both advance it.
//
//   m dv/dt = F_hand + m_w g - F_motor - F_friction - A sin(2 pi z / L + phase)        z: depth, positive along the press
//
// Friction is LuGre's: ds/dt = v - k |v| s / g(v),  F = k s + c ds/dt + b v,  g(v) = F_c + (F_s - F_c) exp(-(v/v_s)^2).
// Source: Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE Trans. Automatic Control 40 (1995), equations (1) to (4).
// All parameters are assumed, not those of an arm.

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "devices/arm_link.h"
#include "devices/press_file.h"

namespace palpa::devices::simulators {

struct ArmPlantParameters {
    double mass_kg = 1.6;
    double coulomb_N = 2.0;
    double static_N = 2.6;
    double stribeck_m_per_s = 4e-3;
    double viscous_N_s_per_m = 3.0;
    double ripple_N = 0.4;
    double ripple_wavelength_m = 12e-3;
    double ripple_phase_rad = 0.0;
    double weight_kg = 0.8;  // that pulls along the press
    double encoder_step_m = 2e-6;
    double stick_N_per_m = 1e5;      // k: how stiffly it sticks
    double stick_N_s_per_m = 200.0;  // c
    double hand_N_per_m = 3000.0;
    double hand_N_s_per_m = 40.0;
    double sensor_noise_N = 0.01;
    double lowest_m = -0.015;  // end stops
    double deepest_m = 0.055;
};

// The parameters above, each of the arm's own within 20 % and the phase anywhere, by the seed; seed 0 leaves them.
ArmPlantParameters arm_parameters(std::uint64_t seed);

struct ArmPlant {
    ArmPlantParameters arm;
    std::vector<PressRow> press;  // how the hand presses; empty: no hand, and the brake holds an arm that is not led
    std::mt19937_64 random;

    double time_s = 0.0;
    double depth_m = 0.0;
    double velocity_m_per_s = 0.0;
    double bristle_m = 0.0;  // s of the friction
    double hand_N = 0.0;
    double motor_N = 0.0;           // against the press
    double measured_m_per_s = 0.0;  // the arm's estimate of its velocity: a low-pass of 20 Hz over the encoder
    double encoder_m = 0.0;
    ArmCommandPacket command{};
    double commanded_s = -1.0;  // when a command came last
    double hand_began_s =
        -1.0;  // the brake holds the arm, and nobody touches it, until it is told to do more than rest
    std::size_t press_at = 0;
    std::uint32_t sent = 0;
    int substeps = 0;
};

ArmPlant make_arm_plant(const ArmPlantParameters& arm, std::vector<PressRow> press, std::uint64_t seed);

// Takes a command as it would come over the wire; one older than 100 ms counts no more.
void command(const ArmCommand& wanted, ArmPlant& plant);
void command(const ArmCommandPacket& wanted, ArmPlant& plant);

// Advances by a multiple of 0.1 ms (rounded to one).
void advance(double dt_s, ArmPlant& plant);

// What the arm says now. The plant's own clock stands for the host's.
ArmFeedback feedback(ArmPlant& plant);
ArmFeedbackPacket feedback_packet(ArmPlant& plant);
double sensor_N(ArmPlant& plant);  // with its noise

// A datagram to the arm and its answer; nothing for one that is no command.
std::optional<std::array<std::uint8_t, kArmFeedback_bytes>> answer(std::span<const std::uint8_t> bytes,
                                                                   ArmPlant& plant);

}  // namespace palpa::devices::simulators
