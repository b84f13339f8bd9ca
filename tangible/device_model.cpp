#include "tangible/device_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/blas_memory.h"
#include "mechanics/error.h"
#include "tangible/actuators.h"
#include "tangible/bearings.h"
#include "tangible/linearised.h"

namespace palpa::tangible {
namespace {

using Eigen::Index;
using mechanics::Mesh;

constexpr double kMostBandValues = 4e7;  // 320 MB

// Nodes that supports hold along x, y and z.
std::vector<bool> held_nodes(const SoftDevice& device) {
    const Mesh& mesh = device.body.body.mesh;
    std::vector<int> axes(position(mesh.nodes_m.cols()), 0);
    for (const int dof : device.supports.dof) axes[position(dof / 3)] |= 1 << (dof % 3);
    std::vector<bool> out(axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) out[i] = axes[i] == 7;
    return out;
}

std::vector<std::vector<int>> cliques_of(const SoftDevice& device) {
    std::vector<std::vector<int>> out;
    for (std::size_t j = 0; j < device.actuators.size(); ++j) {
        const bool in_motion = std::any_of(device.ties.begin(), device.ties.end(), [&](const SoftTie& tie) {
            const auto& in = tie.actuators;
            return tie.motion && std::find(in.begin(), in.end(), static_cast<int>(j)) != in.end();
        });
        for (auto& nodes : coupled_nodes(device.actuators[j], in_motion)) out.push_back(std::move(nodes));
    }
    return out;
}

// Actuators whose nodes are those of the model.
std::vector<SoftActuator> in_model_order(const DeviceModel& model) {
    std::vector<SoftActuator> out = model.device.actuators;
    for (SoftActuator& actuator : out) {
        for (PathPoint& point : actuator.path) {
            for (int& node : point.node) node = model.place_of[position(node)];
        }
        for (Index i = 0; i < actuator.faces.corners.size(); ++i) {
            int& node = actuator.faces.corners.data()[i];
            node = model.place_of[position(node)];
        }
    }
    return out;
}

void note_ties(DeviceModel& model) {
    for (std::size_t j = 0; j < model.driver.size(); ++j) model.driver[j] = static_cast<int>(j);
    for (const SoftTie& tie : model.device.ties) {
        for (std::size_t k = 1; k < tie.actuators.size(); ++k) {
            const int first = tie.actuators[0];
            const int other = tie.actuators[k];
            if (tie.motion) model.equal_motion.push_back({first, other});
            if (!tie.force) continue;
            // joined with whatever either of them is tied to already
            const int into = std::min(model.driver[position(first)], model.driver[position(other)]);
            const int from = std::max(model.driver[position(first)], model.driver[position(other)]);
            std::replace(model.driver.begin(), model.driver.end(), from, into);
        }
    }
}

// Gradients of the depth and, where it is wanted, of the two tilts: the slope of the plane that fits the patch best.
Eigen::MatrixXd observed_of(const DeviceModel& model) {
    const Effector& effector = model.device.effector;
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(model.equations(), effector.tilt ? 3 : 1);
    std::array<Eigen::Vector3d, 2> across;
    for (int k = 0; k < 2; ++k)
        across[position(k)] = Eigen::Vector3d::Unit((mechanics::axis_of(effector.side) + 1 + k) % 3);
    if (across[1].dot(Eigen::Vector3d::UnitX()) > 0.0) std::swap(across[0], across[1]);  // in the order x, y, z
    for (std::size_t i = 0; i < effector.node.size(); ++i) {
        const int node = model.place_of[position(effector.node[i])];
        if (node >= model.free_nodes) continue;
        out.col(0).segment<3>(3 * node) += effector.weight[i] * effector.direction;
    }
    const Eigen::Matrix3Xd& nodes_m = model.device.body.body.mesh.nodes_m;
    for (Index t = 1; t < out.cols(); ++t) {
        const Eigen::Vector3d along = across[position(t - 1)];
        double mean_m = 0.0;
        double square_m2 = 0.0;
        for (std::size_t i = 0; i < effector.node.size(); ++i)
            mean_m += effector.weight[i] * along.dot(nodes_m.col(effector.node[i]));
        for (std::size_t i = 0; i < effector.node.size(); ++i) {
            const double arm_m = along.dot(nodes_m.col(effector.node[i])) - mean_m;
            square_m2 += effector.weight[i] * arm_m * arm_m;
        }
        for (std::size_t i = 0; i < effector.node.size(); ++i) {
            const int node = model.place_of[position(effector.node[i])];
            const double arm_m = along.dot(nodes_m.col(effector.node[i])) - mean_m;
            if (node >= model.free_nodes) continue;
            out.col(t).segment<3>(3 * node) -= effector.weight[i] * arm_m / square_m2 * effector.direction;
        }
    }
    for (const int equation : model.held) out.row(equation).setZero();
    return out;
}

Eigen::VectorXd weight_of(const DeviceModel& model) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(model.equations());
    if (!model.device.gravity_m_per_s2) return out;
    const Mesh& mesh = model.body.mesh;
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        const double share_N =
            model.device.density_kg_per_m3 * cell_volume_m3(model, cell) / static_cast<double>(mesh.cells.rows());
        for (Index k = 0; k < mesh.cells.rows(); ++k) {
            if (mesh.cells(k, cell) < model.free_nodes)
                out.segment<3>(3 * mesh.cells(k, cell)) += share_N * *model.device.gravity_m_per_s2;
        }
    }
    return out;
}

// The mean diagonal of the stiffness at rest.
double mean_stiffness(const DeviceModel& model) {
    mechanics::BandMatrix K = mechanics::band_matrix(model.equations(), model.band);
    Eigen::Matrix3Xd gradient_N = Eigen::Matrix3Xd::Zero(3, model.body.mesh.nodes_m.cols());
    const Eigen::Matrix3Xd still = gradient_N;
    mechanics::add_energy_tangent_N_per_m(model.body, still, mechanics::Tangent::exact, gradient_N, K);
    return K.values.row(0).mean();
}

std::vector<mechanics::LargeMaterial> scaled_materials(const SoftDevice& device) {
    std::vector<mechanics::LargeMaterial> materials = device.materials;
    for (mechanics::LargeMaterial& material : materials) {
        material.mu_Pa *= device.fit.modulus_factor;
        material.kappa_Pa *= device.fit.modulus_factor;
    }
    return materials;
}

}  // namespace

const char* name_of(DeviceStatus status) {
    switch (status) {
        case DeviceStatus::good:
            return "good";
        case DeviceStatus::unstable:
            return "unstable";
        case DeviceStatus::slow:
            return "slow";
        case DeviceStatus::no_equilibrium:
            return "no equilibrium";
        case DeviceStatus::bad_input:
            break;
    }
    return "bad input";
}

double cell_volume_m3(const DeviceModel& model, Index cell) {
    if (!model.body.tets.empty()) return model.body.tets[position(cell)].volume_m3[0];
    const auto& volumes = model.body.hexes[position(cell)].volume_m3;
    return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

DeviceModel make_device_model(const SoftDevice& device) {
    mechanics::require_blas_memory();
    DeviceModel model;
    model.device = device;
    const Mesh& mesh = device.body.body.mesh;
    const std::vector<bool> held = held_nodes(device);
    const mechanics::NodeOrder order = mechanics::node_order(mesh, held, cliques_of(device));
    model.free_nodes = order.free_nodes;
    model.band = std::min(order.band, std::max(0, model.equations() - 1));
    if (static_cast<double>(model.equations()) * model.band > kMostBandValues || model.free_nodes == 0)
        throw files::bad_input(
            device.file, "mesh",
            std::to_string(model.equations()) + " equations of half-bandwidth " + std::to_string(model.band),
            "a mesh that is small enough for a loop: at most 4e7 values");
    model.place_of.resize(order.node_at.size());
    for (std::size_t i = 0; i < order.node_at.size(); ++i)
        model.place_of[position(order.node_at[i])] = static_cast<int>(i);
    model.body =
        mechanics::make_large_body(mechanics::renumbered(mesh, order), device.body.element, scaled_materials(device));
    for (const int dof : device.supports.dof) {
        const int place = model.place_of[position(dof / 3)];
        if (place < model.free_nodes) model.held.push_back(3 * place + dof % 3);
    }
    model.actuators = in_model_order(model);
    note_ties(model);
    for (const Bearing& bearing : device.bearings) {
        model.bearings.push_back(bearing_points(bearing, mesh, model.place_of));
        model.has_constraints |= bearing.constraint;
    }
    model.observed = observed_of(model);
    model.weight_N = weight_of(model);
    for (const int equation : model.held) model.weight_N(equation) = 0.0;
    model.rest = lengths(model, Eigen::Matrix3Xd::Zero(3, mesh.nodes_m.cols()));
    model.size_m = (mesh.nodes_m.rowwise().maxCoeff() - mesh.nodes_m.rowwise().minCoeff()).norm();
    model.hold_N_per_m = mean_stiffness(model);
    return model;
}

DeviceState blank_state(const DeviceModel& model) {
    DeviceState state;
    const Index n = model.body.mesh.nodes_m.cols();
    for (Eigen::Matrix3Xd* field : {&state.u_m, &state.good_u_m, &state.gradient_N}) field->setZero(3, n);
    std::size_t points = 0;
    for (const auto& bearing : model.bearings) points += bearing.size();
    state.shift_m.assign(points, 0.0);
    state.good_shift_m = state.shift_m;
    const int m = channels_of(model);
    state.K = mechanics::band_matrix(model.equations(), model.band);
    state.summed = state.K.values;
    state.loads.setZero(model.equations(), m);
    state.factor_loads.setZero(model.equations(), m);
    state.answers.setZero(model.equations(), m + 1);
    state.linear_u_m.setZero(model.equations());
    state.linear_moves_m.setZero(model.equations(), m);
    for (int j = 0; j < model.n_actuators(); ++j) state.actuation[position(j)] = model.actuators[position(j)].lower;
    state.pretension = state.actuation;
    return state;
}

DeviceState rest_state(const DeviceModel& model) {
    DeviceState state = blank_state(model);
    DeviceLoad load;
    load.actuation = state.actuation;
    const ForwardAnswer answer = equilibrium(model, state, load);
    if (answer.status != DeviceStatus::good && answer.status != DeviceStatus::unstable)
        throw std::runtime_error(model.device.file +
                                 ": the device has no equilibrium at the lower limits of its "
                                 "actuators (" +
                                 name_of(answer.status) + ", last change " +
                                 files::short_number(1e3 * answer.residual_m) + " mm)");
    state.rest_depth_m = depth_m(model, state);
    return state;
}

double depth_m(const DeviceModel& model, const DeviceState& state) noexcept {
    const Eigen::Map<const Eigen::VectorXd> u(state.u_m.data(), model.equations());
    return model.observed.col(0).dot(u) - state.rest_depth_m;
}

Lengths lengths(const DeviceModel& model, const Eigen::Matrix3Xd& u_m) noexcept {
    Lengths out{};
    const Places x{model.body.mesh.nodes_m, u_m};
    for (std::size_t j = 0; j < model.actuators.size(); ++j) out[j] = coordinate(model.actuators[j], x);
    return out;
}

Eigen::Matrix3Xd displacements_m(const DeviceModel& model, const DeviceState& state) {
    Eigen::Matrix3Xd out(3, state.u_m.cols());
    for (Index node = 0; node < out.cols(); ++node) out.col(node) = state.u_m.col(model.place_of[position(node)]);
    return out;
}

}  // namespace palpa::tangible
