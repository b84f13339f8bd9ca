#pragma once
// What a force arm does by itself, and the feed-forward force that takes it away: friction, weight, and the ripple of its
// motor. Fitted to slow strokes of a hand with a force sensor between hand and arm.
//
//   F_hand - F_motor = -W + A sin(2 pi z / L + phase) + s(v) [F_c + (F_s - F_c) exp(-(v/v_s)^2)] + b v
//
// z: depth, v: its velocity, s: sign. All forces against the press are positive but the hand's and the weight's. Inertia is
// left out: it is small in slow strokes, and strokes that accelerate are not used. Kind of model: the paper's feed-forward
// of friction, gravity and torque ripple (its section III); friction's law: Stribeck's in the form of Canudas de Wit 1995.

#include <filesystem>
#include <span>
#include <string>

#include "files/json.h"

namespace palpa::tactile {

struct ArmRipple {
    double amplitude_N = 0.0;
    double wavelength_m = 12e-3;
    double phase_rad = 0.0;
};

struct ArmCompensation {
    double coulomb_N = 0.0;
    double static_N = 0.0;  // >= coulomb_N
    double stribeck_m_per_s = 4e-3;
    double viscous_N_s_per_m = 0.0;
    double weight_N = 0.0;  // pulls along the press
    ArmRipple ripple;
    double share = 0.95;  // of the friction; above 1 the arm would move by itself
};

// One reading of a stroke.
struct StrokeRow {
    double time_s = 0.0;
    double depth_m = 0.0;
    double velocity_m_per_s = 0.0;
    double sensor_N = 0.0;  // of the hand, pressing is positive
    double motor_N = 0.0;   // told to the motor, against the press
};

struct CompensationFit {
    ArmCompensation compensation;
    std::size_t rows = 0;     // that were used
    double residual_N = 0.0;  // root mean square of what is left
    double lowest_m = 0.0;    // range of the depths that were used
    double deepest_m = 0.0;
    double slowest_m_per_s = 0.0;
    double fastest_m_per_s = 0.0;
};

// The wavelength is looked for by a Fourier transform of what remains over the depth; then wavelength and Stribeck's
// velocity are refined, the other parameters being linear. Throws std::runtime_error that says what is missing: fewer than
// 1,000 rows of steady motion, one direction only, less than 20 mm.
CompensationFit fit_compensation(std::span<const StrokeRow> rows);

// Which way friction acts. After the arm turns back it follows the motion over the distance in which a bearing sticks, so
// that an arm that is held still stays quiet: with the sign of a measured velocity it would shake.
// Source of the law: Dahl 1968, with exponent 1: d(direction)/d(depth) = (1 - sign(v) direction) / reach.
struct FrictionDirection {
    double share = 0.0;  // -1 up, 1 down
    double depth_m = 0.0;
    bool begun = false;
};

// The force to add to the motor, against the press. Called once for each reading of the arm. Allocates nothing; 0 for an
// argument that is not finite.
double compensation_N(const ArmCompensation& arm, double depth_m, double velocity_m_per_s,
                      FrictionDirection& direction) noexcept;

// The parameters as files and reports spell them.
files::Json parameters_json(const ArmCompensation& arm);

// COMPENSATION.json. read throws InputError with file and key.
void write_compensation(const CompensationFit& fit, const std::string& arm, const std::filesystem::path& path);
ArmCompensation read_compensation(const std::filesystem::path& path);

}  // namespace palpa::tactile
