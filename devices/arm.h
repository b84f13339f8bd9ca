#pragma once
// A force arm: what it says and is told once per millisecond, and its device file (docs/tactile.md).
//
// Supported: one degree of freedom along the press, low impedance (depth in, force out) and high impedance (force in,
// depth out), over the UDP packets of devices/arm_link.h, with a force sensor that speaks RDT (devices/netft.h).
// Tried with devices/simulators only, not with an arm.

#include <concepts>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "devices/netft.h"

namespace palpa::devices {

// What the arm and its sensor say. Depth is along the press, positive into the tissue, 0 at its surface at rest.
struct ArmFeedback {
    double time_s = 0.0;         // arrival, on the host's steady clock
    double device_time_s = 0.0;  // clock of the arm
    double x_m = 0.0;            // place on the tissue
    double y_m = 0.0;
    double depth_m = 0.0;
    double velocity_m_per_s = 0.0;  // of the depth, as the arm estimates it
    double sensor_N = 0.0;          // pressing is positive; 0 without a sensor
    double has_sensor = 0.0;        // 1 or 0
    double round_trip_s = 0.0;      // command there and feedback back, without the time that the arm held it
    double age_s = 0.0;             // from the arrival to when the loop read it
    double faulty = 0.0;            // 1: the arm says that it has a fault of its own
};

enum class ArmMode { rest = 0, force = 1, position = 2 };

// What the arm is told. The motor's force against the press is force_N + feedforward_N.
struct ArmCommand {
    double force_N = 0.0;        // rendered, against the press, >= 0
    double feedforward_N = 0.0;  // compensation of friction, weight and ripple, signed (tactile/arm_compensation.h)
    double depth_m = 0.0;        // mode position: where a high-impedance arm goes
    double mode = 0.0;           // ArmMode
};

template <class Row, class Visit>
requires std::same_as<std::remove_const_t<Row>, ArmFeedback>
void visit_fields(Row& row, Visit&& visit) {
    visit("arm_time_s", row.time_s);
    visit("arm_device_time_s", row.device_time_s);
    visit("arm_x_m", row.x_m);
    visit("arm_y_m", row.y_m);
    visit("arm_depth_m", row.depth_m);
    visit("arm_velocity_m_per_s", row.velocity_m_per_s);
    visit("arm_sensor_N", row.sensor_N);
    visit("arm_has_sensor", row.has_sensor);
    visit("arm_round_trip_s", row.round_trip_s);
    visit("arm_age_s", row.age_s);
}

template <class Row, class Visit>
requires std::same_as<std::remove_const_t<Row>, ArmCommand>
void visit_fields(Row& row, Visit&& visit) {
    visit("arm_force_N", row.force_N);
    visit("arm_feedforward_N", row.feedforward_N);
    visit("arm_depth_m", row.depth_m);
    visit("arm_mode", row.mode);
}

enum class ArmImpedance { low, high };

// The device file, assets/devices/arm.json.
struct ArmDevice {
    std::string name;
    std::string host = "127.0.0.1";
    int port = 49160;
    ArmImpedance impedance = ArmImpedance::low;
    double lowest_m = -0.01;  // range of the depth
    double deepest_m = 0.05;
    double force_N = 15.0;        // greatest rendered force
    double feedforward_N = 15.0;  // greatest compensation, either way
    double force_slew_N_per_s = 1000.0;
    double depth_slew_m_per_s = 0.2;  // mode position
    double speed_m_per_s = 1.0;       // faster than that the force rests
    double silence_s = 0.1;
    std::optional<NetFtOptions> sensor;  // between arm and display
    std::filesystem::path compensation;  // file of tactile/arm_compensation.h; empty: none
};

// Reads a device file; `compensation` is relative to it. Throws InputError with file and key.
ArmDevice read_arm_device(const std::filesystem::path& path);

// Whether the force sensor that this arm follows says nothing: without it a hand that presses would press nothing.
inline bool is_unfelt(const ArmDevice& arm, const ArmFeedback& feedback) noexcept {
    return arm.sensor && arm.impedance == ArmImpedance::high && !(feedback.has_sensor > 0.5);
}

// The loop delay above which a rendered stiffness may oscillate under a soft hand: stiffness x delay > 8 N s/m (quiet up
// to it, oscillating at 12, in a simulation with a hand of 0.3 to 3 N/mm). Returns the warning, or "".
inline constexpr double kMostStiffnessDelay_N_s_per_m = 8.0;
std::string delay_warning(double stiffness_N_per_m, double loop_delay_s);

}  // namespace palpa::devices
