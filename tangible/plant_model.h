#pragma once
// A soft device in the place of the real one: its drives, its body, its sensor and, if there is one, the hand on it. The body
// may differ from the model that the loop works with: in its mesh, its elements, its modulus. What it computes are converged
// equilibria.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "tangible/loop.h"

namespace palpa::tangible {

struct PlantSensor {
    double rate_Hz = 0.0;  // 0: read at every tick
    double noise_m = 0.0;  // standard deviation
    double delay_s = 0.0;  // from the moment of a reading until it arrives
    double zero_m = 0.0;   // what it reads at the rest
};

// A hand: a mass with damping that a force pushes into the device.
struct PlantHand {
    double mass_kg = 0.0;  // 0: the finger follows a motion, whatever the device does
    double damping_N_s_per_m = 2.0;
};

// A plant file, or "exact": all as in the device's own model, with what was fitted to it.
struct PlantOptions {
    std::string name = "exact";
    bool as_fitted = false;                      // modulus, friction, zero and lag are those of the device's fit
    files::Json device = files::Json::object();  // merge patch (RFC 7386) of the device file: mesh, element, law
    double modulus_factor = 1.0;                 // of the device file's moduli, without its fit
    double friction_share = 0.0;                 // of a cable's tension that its guide takes
    double lag_s = 0.0;                          // of the drives, first order
    bool inertia = false;                        // the effector's share of the body's mass resists acceleration
    PlantSensor sensor;
    PlantHand hand;
};
// Throws InputError. "exact" is no file.
PlantOptions read_plant(const std::string& exact_or_file);

// The options with the values of the fit, where the plant is as fitted.
PlantOptions of_fit(PlantOptions options, const DeviceFit& fit);

// Prepared once; constant while it runs.
struct Plant {
    PlantOptions options;
    std::shared_ptr<const DeviceModel> model;
    CommandKind command = CommandKind::force;
    double period_s = 0.01;
    double moving_kg = 0.0;  // effector's share of the mass; 0 without inertia
};
// Reads the device file, changed as the plant wants it. model: that of the loop, taken over by a plant that has no body of
// its own. Throws InputError and std::runtime_error as make_device_model() and rest_state().
Plant make_plant(const std::shared_ptr<const DeviceModel>& model, const PlantOptions& options, const LoopOptions& loop);

struct PlantState {
    static constexpr std::size_t kHistory = 256;
    DeviceState device;
    Actuation force{};  // of the drives, after their lag
    Lengths length{};
    Lengths body_length{};  // of the cables, one step ago
    double depth_m = 0.0;   // of the finger, from the rest
    double speed_m_per_s = 0.0;
    double stiffness_N_per_m = 0.0;         // of the device under a hand, at the last step
    std::array<double, kHistory> time_s{};  // of the finger's way
    std::array<double, kHistory> way_m{};
    std::int64_t steps = 0;
    double read_s = -1.0;  // when the sensor read last
    double reading_m = 0.0;
    std::uint64_t random = 1;
    bool begun = false;
};
// At rest under the loop's first command, from whose height depths are counted, as a person zeroes the sensor.
PlantState make_plant_state(const Plant& plant, const TangiblePlan& loop, std::uint64_t seed);

struct PlantAnswer {
    DeviceStatus status = DeviceStatus::good;
    double force_N = 0.0;  // on the finger, >= 0; 0 where they do not touch
    double depth_m = 0.0;  // of the finger
    bool touching = false;
    int iterations = 0;
};

// The sensor at a time. Where the finger was is known up to the last step.
TangibleFeedback read_plant_sensor(const Plant& plant, double time_s, PlantState& state) noexcept;

// The finger is at a depth from time_s on.
void place_finger(double time_s, double depth_m, PlantState& state) noexcept;

// One period under a command, the finger held where it is.
PlantAnswer step_plant(const Plant& plant, const TangibleCommand& command, PlantState& state) noexcept;

// One period under a command in which a hand pushes with a force: the finger moves.
PlantAnswer push_plant(const Plant& plant, const TangibleCommand& command, double time_s, double hand_N,
                       PlantState& state) noexcept;

// The same for a hand without mass: the finger goes to where its force is in equilibrium with the device under this command,
// at most at kHandSpeed_m_per_s, and rises from the surface without one.
inline constexpr double kHandSpeed_m_per_s = 0.06;
PlantAnswer yield_to_hand(const Plant& plant, const TangibleCommand& command, double time_s, double hand_N,
                          PlantState& state) noexcept;

// The force on a finger that is held at a depth while the drives stand still: for tables. actuation in N and Pa, or lengths
// where the plant is driven by position.
PlantAnswer held_force(const Plant& plant, const Actuation& actuation, const Lengths& length, double depth_m,
                       PlantState& state) noexcept;

}  // namespace palpa::tangible
