#include "session/tangible_body.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "files/input_error.h"

namespace palpa::session {
namespace {

using tangible::TangiblePlan;

PointOfDevice point_of(const Eigen::Vector3d& p_m) {
    return {static_cast<float>(p_m.x()), static_cast<float>(p_m.y()), static_cast<float>(p_m.z())};
}

std::vector<int> file_nodes(const TangiblePlan& plan) {
    std::vector<int> nodes = mechanics::nodes_of(mechanics::boundary_faces(plan.model->device.body.body.mesh));
    if (nodes.size() > kMostTangibleNodes) nodes.resize(kMostTangibleNodes);
    return nodes;
}

// Faces all of whose corners are among the nodes, by their places in the list.
std::vector<std::array<std::int32_t, 4>> faces_of(const TangiblePlan& plan, const std::vector<int>& nodes) {
    const mechanics::Faces faces = mechanics::boundary_faces(plan.model->device.body.body.mesh);
    std::vector<std::array<std::int32_t, 4>> out;
    for (Eigen::Index f = 0; f < faces.corners.cols(); ++f) {
        std::array<std::int32_t, 4> face{};
        bool all = true;
        for (Eigen::Index k = 0; k < 4; ++k) {
            const int node = faces.corners(std::min(k, faces.corners.rows() - 1), f);
            const auto found = std::lower_bound(nodes.begin(), nodes.end(), node);
            all = all && found != nodes.end() && *found == node;
            face[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(found - nodes.begin());
        }
        if (all) out.push_back(face);
    }
    return out;
}

TangibleActuator actuator_of(const tangible::SoftDevice& device, const tangible::SoftActuator& actuator,
                             const std::vector<int>& nodes) {
    TangibleActuator out;
    out.name = actuator.name;
    out.cavity = actuator.kind == tangible::ActuatorKind::cavity;
    out.lower = actuator.lower;
    out.upper = actuator.upper;
    for (std::size_t k = 0; k < actuator.path.size(); ++k) {
        if (k > 0) out.guides.push_back(point_of(actuator.path[k].at_m));
    }
    if (actuator.path.empty()) return out;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double away_m = (device.body.body.mesh.nodes_m.col(nodes[i]) - actuator.path.front().at_m).norm();
        if (away_m >= nearest_m) continue;
        nearest_m = away_m;
        out.anchor = static_cast<std::int32_t>(i);
    }
    return out;
}

// The stretch of a bearing's axis that lies along the body.
TangibleBearing bearing_of(const tangible::SoftDevice& device, const tangible::Bearing& bearing) {
    const Eigen::VectorXd along =
        bearing.axis.transpose() * (device.body.body.mesh.nodes_m.colwise() - bearing.point_m);
    TangibleBearing out;
    out.from_m = point_of(bearing.point_m + along.minCoeff() * bearing.axis);
    out.to_m = point_of(bearing.point_m + along.maxCoeff() * bearing.axis);
    out.radius_m = bearing.radius_m;
    return out;
}

// "mixed": what the device's wires say of each drive.
bool is_told_length(const TangiblePlan& plan, std::size_t actuator) {
    const tangible::SoftDevice& device = plan.model->device;
    if (device.actuators[actuator].kind == tangible::ActuatorKind::cavity) return false;
    if (plan.loop.command != tangible::CommandKind::mixed) return plan.loop.command == tangible::CommandKind::position;
    return device.wires && device.wires->channels.at(actuator).drive == devices::Drive::length;
}

// The second opening would wait for the first, and say that another program has the port.
void check_one_use(const std::string& where, const std::string& path, std::set<std::string>& paths) {
    if (!paths.insert(path).second)
        throw files::bad_input(where, "", files::shown(path) + " for two ports of the device",
                               "a path of its own for each");
}

}  // namespace

std::vector<int> surface_nodes(const TangiblePlan& plan) {
    std::vector<int> nodes = file_nodes(plan);
    for (int& node : nodes) node = plan.model->place_of[static_cast<std::size_t>(node)];
    return nodes;
}

TangibleBody body_of(const TangiblePlan& plan, const std::string& rendered) {
    const tangible::SoftDevice& device = plan.model->device;
    const std::vector<int> nodes = file_nodes(plan);
    TangibleBody body;
    body.device = device.name;
    for (const int node : nodes) body.rest_m.push_back(point_of(device.body.body.mesh.nodes_m.col(node)));
    body.faces = faces_of(plan, nodes);
    for (const tangible::SoftActuator& actuator : device.actuators)
        body.actuators.push_back(actuator_of(device, actuator, nodes));
    for (const tangible::Bearing& bearing : device.bearings) body.bearings.push_back(bearing_of(device, bearing));
    body.direction = point_of(device.effector.direction);
    body.effector_m = point_of(device.effector.centre_m);
    body.effector_radius_m = device.effector.radius_m;
    for (std::size_t j = 0; j < body.actuators.size(); ++j) body.actuators[j].by_length = is_told_length(plan, j);
    body.rate_Hz = plan.loop.rate_Hz;
    body.rendered = rendered;
    body.algorithm = tangible::kFidelityNames[static_cast<std::size_t>(plan.loop.inverse.fidelity)];
    return body;
}

void fill_shape(const TangiblePlan& plan, const std::vector<int>& nodes, const tangible::DeviceState& state,
                TangibleShape& out) noexcept {
    const Eigen::Matrix3Xd& rest_m = plan.model->body.mesh.nodes_m;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        out.node_m[i] = point_of(rest_m.col(nodes[i]) + state.u_m.col(nodes[i]));
}

void fill_moment(const TickRecord& record, const TangibleSink& sink, double rate_Hz, TangibleMoment& out) {
    const tangible::TangibleCommand& tick = record.command;
    out.time_s = tick.time_s;
    out.depth_m = tick.depth_m;
    out.world_depth_m = tick.world_depth_m;
    out.wanted_N = tick.wanted_N;
    out.rendered_N = record.rendered_N;
    out.proxy_m = tick.proxy_m;
    out.next_stiffness = tick.slope_N_per_m;
    out.pressed = tick.pressed;
    out.gap_m = tick.gap_m;
    out.by_actuators_m = tick.residual_m - tick.gap_m;
    out.compliance = tick.compliance;
    out.residual_m = tick.residual_m;
    out.rank = tick.rank;
    out.active = tick.active;
    out.limited_by = tick.limited_by;
    out.iterations = tick.iterations;
    out.converged = tick.converged;
    out.actuation = tick.actuation;
    out.length = tick.length;
    out.stopped = tick.fault == tangible::TickFault::stopped;
    const bool by_guard = out.stopped && record.guard != devices::Fault::none;
    out.fault = by_guard ? devices::text(record.guard).data() : tangible::text_of(tick.fault);
    out.held = tick.held;
    out.period_p50_s = 1e-9 * sink.period.quantile_ns(0.5);
    out.period_p99_s = 1e-9 * sink.period.quantile_ns(0.99);
    out.step_p50_s = 1e-9 * sink.tick.quantile_ns(0.5);
    out.step_p99_s = 1e-9 * sink.tick.quantile_ns(0.99);
    const tangible::TickFigures& ticks = sink.result.ticks;
    out.ticks = ticks.ticks;
    out.missed_ticks = record.missed;
    out.saturated_ticks = ticks.saturated_ticks;
    out.held_s = static_cast<double>(ticks.held_ticks) / rate_Hz;
    out.force_rms_percent = tangible::force_rms_percent(ticks);
}

devices::ActuatorRig tangible_rig(const tangible::DeviceModel& model, const std::vector<std::string>& ports) {
    const tangible::SoftDevice& device = model.device;
    if (!device.wires)
        throw files::bad_input(device.file, "wires", "none",
                               "the ports and drives of the device, or a plant in its place");
    devices::ActuatorRig rig = *device.wires;
    std::set<std::string> names;
    for (const std::string& port : ports) {
        devices::set_port(port, rig);
        const std::string name = port.substr(0, port.find('='));
        if (!names.insert(name).second)
            throw files::bad_input("--port", "", files::shown(name) + " twice", "each port once");
    }
    const std::string where = ports.empty() ? device.file : "--port";
    std::set<std::string> paths;
    for (const devices::RigPort& port : rig.ports) check_one_use(where, port.path, paths);
    for (const devices::RigSensor& sensor : rig.sensor)
        if (sensor.place.host.empty()) check_one_use(where, sensor.place.path, paths);
    return rig;
}

}  // namespace palpa::session
