#pragma once
// What the loop of a soft device needs, made once: the model of the device, the virtual world, and the state from which a
// press begins.

#include <memory>
#include <string>
#include <vector>

#include "tangible/inverse.h"
#include "tangible/world.h"

namespace palpa::tangible {

// What the drives are told: tensions and pressures, or the cables' lengths of the solved model, as the paper does
// (pressures stay pressures). Mixed: each cable of a real device what its own drive takes.
enum class CommandKind { force, position, mixed };

struct LoopOptions {
    double rate_Hz = 100.0;
    InverseOptions inverse;  // dt_s follows from the rate
    CommandKind command = CommandKind::force;
    bool predict = true;              // extrapolate the finger where the sensor is slower than the loop
    double hold_s = 0.1;              // how long the last valid command is repeated before the device relaxes
    double silence_s = 0.1;           // the sensor may be silent, or three of its periods if these are longer
    bool compensate_friction = true;  // that of the device's fit
    bool compensate_lag = true;       // of the drives, that of the device's fit
};

CommandKind command_named(std::string_view name);  // "force" or "position"

std::string_view name_of(CommandKind command);  // "force", "position" or "mixed"

// What the scene asks of the loop.
LoopOptions loop_options(const scene::TangibleOptions& scene);

struct TangiblePlan {
    std::shared_ptr<const DeviceModel> model;
    World world;
    LoopOptions loop;
    Eigen::Vector2d place_m =
        Eigen::Vector2d::Zero();  // on the tissue; of a scene that follows the touch: where it begins
    bool place_follows = false;
    DeviceState start;    // at the pretension, without a finger
    Actuation relaxed{};  // the lower bounds
    Lengths relaxed_length{};
    double greatest_m = 0.0;  // depth that the tissue is known for, in the device
    std::vector<std::string> notes;
};

// Makes the plan of a scene that has the key `tangible`, on its plan, which must outlive it. Reads the device. Throws
// InputError, and std::runtime_error for a device that has no equilibrium at its pretension.
TangiblePlan make_tangible_plan(const scene::Scene& scene, const scene::Plan& scene_plan, const LoopOptions& options);
TangiblePlan make_tangible_plan(const scene::Scene& scene, const scene::Plan& scene_plan);  // with the scene's options

// The same for a model that is there already. place_m: on the tissue.
TangiblePlan make_tangible_plan(std::shared_ptr<const DeviceModel> model, const World& world,
                                const Eigen::Vector2d& place_m, const LoopOptions& options);

// For real drives, which take what their wires say: sets the plan's command to it. Throws InputError that names the actuator if
// a cable's drive cannot take the command that was asked for, by the scene ("position") or as `asked`.
void command_as_wired(bool asked, TangiblePlan& plan);

}  // namespace palpa::tangible
