#include "tangible/plan.h"

#include <algorithm>
#include <stdexcept>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::tangible {
namespace {

Actuation lower_bounds(const DeviceModel& model) {
    Actuation out{};
    for (std::size_t j = 0; j < model.actuators.size(); ++j) out[j] = model.actuators[j].lower;
    return out;
}

// The device at the pretension of its world: where the finger's force at the depth floor is the tissue's.
void take_start(TangiblePlan& plan) {
    const DeviceModel& model = *plan.model;
    plan.start = rest_state(model);
    plan.relaxed_length = lengths(model, plan.start.u_m);
    scene::TissueWork work = scene::make_work(*plan.world.tissue);
    const WorldForce floor = world_force(plan.world, plan.place_m, model.device.depth_floor_m, work);
    const ForwardAnswer prepared = prepare_press(model, plan.start, floor.force_N);
    if (prepared.status == DeviceStatus::slow)
        plan.notes.push_back(
            "the pretension that this tissue wants at the depth floor is beyond the device's limits; the "
            "nearest within them is taken");
    else if (prepared.status != DeviceStatus::good && prepared.status != DeviceStatus::unstable)
        throw std::runtime_error("the device " + model.device.name + " has no equilibrium at its pretension (" +
                                 name_of(prepared.status) + ")");
}

const scene::TangibleOptions& options_of(const scene::Scene& scene) {
    if (!scene.tangible)
        throw files::bad_input(scene.file.string(), "tangible", "no such key", "one that names a device");
    return *scene.tangible;
}

}  // namespace

CommandKind command_named(std::string_view name) {
    return name == "position" ? CommandKind::position : CommandKind::force;
}

std::string_view name_of(CommandKind command) {
    if (command == CommandKind::mixed) return "mixed";
    return command == CommandKind::position ? "position" : "force";
}

LoopOptions loop_options(const scene::TangibleOptions& scene) {
    LoopOptions options;
    options.inverse.fidelity = fidelity_named(scene.fidelity);
    options.inverse.rate_share = scene.rate_share;
    options.command = command_named(scene.command);
    return options;
}

TangiblePlan make_tangible_plan(std::shared_ptr<const DeviceModel> model, const World& world,
                                const Eigen::Vector2d& place_m, const LoopOptions& options) {
    TangiblePlan plan;
    plan.model = std::move(model);
    plan.world = world;
    plan.loop = options;
    plan.loop.inverse.dt_s = 1.0 / options.rate_Hz;
    plan.place_m = place_m;
    plan.relaxed = lower_bounds(*plan.model);
    take_start(plan);
    return plan;
}

TangiblePlan make_tangible_plan(const scene::Scene& scene, const scene::Plan& scene_plan, const LoopOptions& options) {
    const scene::TangibleOptions& asked = options_of(scene);
    auto model = std::make_shared<const DeviceModel>(make_device_model(read_soft_device(asked.device)));
    const Eigen::Vector2d place_m = asked.at_m.value_or(scene_plan.area.centre_m);
    TangiblePlan plan = make_tangible_plan(std::move(model), make_world(scene, scene_plan), place_m, options);
    plan.place_follows = !asked.at_m.has_value();
    plan.greatest_m = scene_plan.greatest_depth_m / plan.world.depth_scale;
    return plan;
}

void command_as_wired(bool asked, TangiblePlan& plan) {
    const SoftDevice& device = plan.model->device;
    if (!device.wires) return;
    const auto drives_of = [&](devices::Drive drive) {
        const auto& channels = device.wires->channels;
        return std::find_if(channels.begin(), channels.end(), [&](const auto& one) { return one.drive == drive; });
    };
    const bool position = plan.loop.command == CommandKind::position;
    const auto other = drives_of(position ? devices::Drive::force : devices::Drive::length);
    if (other == device.wires->channels.end()) return;
    if (asked || position)
        throw files::bad_input(device.file, "wires.actuators, " + other->name + ".drive", position ? "force" : "length",
                               position ? "length, since the drives are to be told positions (command)"
                                        : "force, since the drives are to be told forces (--command)");
    const bool all = drives_of(devices::Drive::force) == device.wires->channels.end();
    plan.loop.command = all ? CommandKind::position : CommandKind::mixed;
}

TangiblePlan make_tangible_plan(const scene::Scene& scene, const scene::Plan& scene_plan) {
    return make_tangible_plan(scene, scene_plan, loop_options(options_of(scene)));
}

}  // namespace palpa::tangible
