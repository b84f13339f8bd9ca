#pragma once
// A soft device as equations: the energy of its body, of bearings and of its weight, the lengths of its cables and the
// volumes of its cavities as functions of the nodes, and the equilibrium of all of them with a finger.
//
// With actuations a (tensions, pressures), their coordinates q (lengths; minus volumes) and a finger that presses with F
// along the effector's direction, equilibrium is a minimum over the nodes of
//
//   E(u) + sum_j a_j q_j(u) - F depth(u)
//
// Source: Duriez et al., the method of "Soft tangible devices controlled by inverse FEM": quasi-static equilibrium with
// forces (not impulses), so that nothing depends on a time step.

#include <array>
#include <span>

#include "mechanics/large_band.h"
#include "tangible/response.h"

namespace palpa::tangible {

using Actuation = std::array<double, kMostActuators>;  // N or Pa; those beyond the device's actuators are 0
using Lengths = std::array<double, kMostActuators>;    // m, or m^3 of a cavity

// A point at which a bearing may push.
struct BearingPoint {
    std::array<int, 4> node{};  // of the model
    std::array<double, 4> weight{};
    double area_m2 = 0.0;
};

// What does not change while a device runs. Nodes have the order of the model: those with equations first.
struct DeviceModel {
    SoftDevice device;                    // as its file has it; its nodes are numbered as in the file's mesh
    mechanics::LargeBody body;            // nodes in the order of the model
    std::vector<int> place_of;            // node of the file -> node of the model
    int free_nodes = 0;                   // 3 equations each
    int band = 0;                         // half-bandwidth of the equations
    std::vector<int> held;                // equations that a support holds at 0, of nodes that are not held completely
    std::vector<SoftActuator> actuators;  // of the device, with nodes of the model
    std::vector<std::vector<BearingPoint>> bearings;  // points of each of the device's bearings
    std::vector<std::array<int, 2>> equal_motion;     // pairs of actuators
    std::array<int, kMostActuators> driver{};  // first actuator of the force tie that an actuator is in; itself if none
    Eigen::MatrixXd observed;                  // equations x (1 or 3): gradients of depth, and of the two tilts
    Eigen::VectorXd weight_N;                  // one per equation: gravity
    bool has_constraints = false;              // a bearing is one
    Lengths rest{};                            // q at rest
    double size_m = 0.0;                       // diagonal of the body
    double hold_N_per_m = 0.0;                 // mean diagonal of the stiffness at rest
    int equations() const { return 3 * free_nodes; }
    int n_actuators() const { return static_cast<int>(actuators.size()); }
    int n_observed() const { return static_cast<int>(observed.cols()); }
};

// Throws InputError for what the file's numbers make impossible together, OutOfMemory for a mesh that is too large.
DeviceModel make_device_model(const SoftDevice& device);

// How a solve ended.
enum class DeviceStatus {
    good,
    unstable,        // an equilibrium, but small disturbances grow
    slow,            // iterations ran out
    no_equilibrium,  // the device gives way: a strip is pulled through its bearings
    bad_input,       // a number that is not finite
};
const char* name_of(DeviceStatus status);

// What a step changes, with its scratch memory. A copy is a state of its own.
struct DeviceState {
    Eigen::Matrix3Xd u_m;    // 3 x n_nodes, order of the model
    Actuation actuation{};   // as commanded
    Actuation tie_part{};    // what conditions of equal motion add to it
    Actuation pretension{};  // the actuation at zero depth
    double finger_N = 0.0;
    double rest_depth_m = 0.0;                  // of the effector, from the shape at rest: where depth is counted from
    std::vector<double> shift_m, good_shift_m;  // one per bearing point: of bearings that are constraints
    // scratch
    Eigen::Matrix3Xd good_u_m, gradient_N;
    mechanics::BandMatrix K;         // factor of the tangent
    Eigen::MatrixXd summed;          // values of the repaired tangent before they are factored
    Eigen::MatrixXd loads;           // equations x channels: what a unit of each channel does to the nodes
    Eigen::MatrixXd factor_loads;    // the same at the shape that the factor was made at
    Eigen::MatrixXd answers;         // K^-1 of factor_loads, and of what is out of balance
    Response linear;                 // about the shape that prepare_press() left, with
    Eigen::VectorXd linear_u_m;      // displacements without forces, and
    Eigen::MatrixXd linear_moves_m;  // per force of each channel
    bool has_linear = false;
    bool factored = false;
    bool repaired = false;
    int age = 0;                           // solves since the factor was made
    long factorisations = 0, repairs = 0;  // since the start
};

// The device without a finger, its actuators at their lower bounds. Throws std::runtime_error if it has no equilibrium
// there, with the device's name.
DeviceState rest_state(const DeviceModel& model);

// The finger and each actuator are led by force or by position.
struct DeviceLoad {
    Actuation actuation{};  // where led by force: N, Pa
    Lengths length{};       // where led by position: m, m^3
    std::array<bool, kMostActuators> by_position{};
    double finger = 0.0;  // N, or depth (m) from state.rest_depth_m
    bool finger_by_position = false;
};

struct ForwardAnswer {
    DeviceStatus status = DeviceStatus::bad_input;
    double depth_m = 0.0;          // of the effector from state.rest_depth_m
    std::array<double, 2> tilt{};  // rise of the effector's patch per length along the two other axes
    double force_N = 0.0;          // of the finger on the device
    Actuation actuation{};         // forces, also of those led by position; with the part of ties
    Lengths length{};              // q: m, and minus m^3
    int iterations = 0;
    double residual_m = 0.0;  // last correction
};

// The equilibrium under a load, by Newton's method from the state, with the load in steps where that fails. Nothing
// throws or allocates. Unless the answer is good or unstable, the state is the last equilibrium on the way.
ForwardAnswer equilibrium(const DeviceModel& model, DeviceState& state, const DeviceLoad& load) noexcept;
// The same by force alone, with the finger held at a depth: its force is the answer's force_N (negative: it would have
// to pull).
ForwardAnswer press_to_depth(const DeviceModel& model, DeviceState& state, const Actuation& actuation,
                             double depth_m) noexcept;

// Prepares a press: finds the pretension with which the finger's force at the depth floor is `force_at_floor_N`, lets
// the device come to rest there without the finger, and counts depths from there. Devices without `pretension`
// rest at their lower bounds. Status `slow`: the range of the actuator does not reach that force; its end is taken.
ForwardAnswer prepare_press(const DeviceModel& model, DeviceState& state, double force_at_floor_N) noexcept;

double cell_volume_m3(const DeviceModel& model, Eigen::Index cell);  // at rest

// A state at rest, with its memory, that is in no equilibrium yet.
DeviceState blank_state(const DeviceModel& model);

// Of the shape as it is.
double depth_m(const DeviceModel& model, const DeviceState& state) noexcept;  // from state.rest_depth_m
Lengths lengths(const DeviceModel& model, const Eigen::Matrix3Xd& u_m) noexcept;
// Displacements of the nodes in the order of the file, 3 x n_nodes.
Eigen::Matrix3Xd displacements_m(const DeviceModel& model, const DeviceState& state);

}  // namespace palpa::tangible
