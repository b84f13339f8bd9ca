#include "tangible/device_checks.h"

#include <cmath>

#include "files/text.h"
#include "tangible/linearised.h"
#include "tangible/places.h"

namespace palpa::tangible {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// The share of a displacement that a motion of the whole body makes up: |projection| over |u|.
double share_of(const Eigen::Matrix3Xd& u, const Eigen::Matrix3Xd& motion, int free_nodes) {
    const auto a = u.leftCols(free_nodes);
    const auto b = motion.leftCols(free_nodes);
    const double size = a.norm() * b.norm();
    return size > 0.0 ? std::abs(a.cwiseProduct(b).sum()) / size : 0.0;
}

std::string name_of_motion(const DeviceModel& model, const Eigen::Matrix3Xd& u) {
    static constexpr std::array<const char*, 6> kNames{"slides along x", "slides along y", "slides along z",
                                                       "turns about x",  "turns about y",  "turns about z"};
    const Eigen::Matrix3Xd& x_m = model.body.mesh.nodes_m;
    const Eigen::Matrix3Xd from_middle = x_m.colwise() - x_m.rowwise().mean();
    std::size_t best = 0;
    double most = 0.0;
    for (std::size_t k = 0; k < kNames.size(); ++k) {
        Eigen::Matrix3Xd motion(3, x_m.cols());
        const Vector3d axis = Vector3d::Unit(static_cast<Index>(k % 3));
        for (Index node = 0; node < x_m.cols(); ++node)
            motion.col(node) = k < 3 ? axis : axis.cross(Vector3d(from_middle.col(node)));
        const double share = share_of(u, motion, model.free_nodes);
        if (share <= most) continue;
        most = share;
        best = k;
    }
    return most > 0.5 ? kNames[best] : "gives way";
}

// The softest motion of a state whose tangent is not positive without repair: by inverse iteration.
std::string softest_motion(const DeviceModel& model, DeviceState& state) {
    Eigen::MatrixXd v = Eigen::MatrixXd::Zero(model.equations(), 1);
    for (Index i = 0; i < v.rows(); ++i) v(i, 0) = 1.0 + 0.3 * std::sin(static_cast<double>(i));
    for (int i = 0; i < 30; ++i) {
        mechanics::solve_in_place(state.K, v);
        v /= v.norm();
    }
    Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Zero(3, state.u_m.cols());
    Eigen::Map<Eigen::VectorXd>(u.data(), model.equations()) = v;
    return name_of_motion(model, u);
}

// Warns where the device may move without resistance: at the lower limits, and without supports up to half the way to
// the upper ones.
void warn_of_free_motion(const DeviceModel& model, std::vector<std::string>& out) {
    DeviceState state = blank_state(model);
    DeviceLoad load;
    const bool supported = !model.device.supports.dof.empty();
    for (const double share : {0.0, 0.25, 0.5}) {
        if (supported && share > 0.0) return;  // nothing slides
        for (std::size_t j = 0; j < model.actuators.size(); ++j) {
            const SoftActuator& actuator = model.actuators[j];
            const bool pulls = actuator.kind == ActuatorKind::cable;
            load.actuation[j] = actuator.lower + (pulls ? share : 0.0) * (actuator.upper - actuator.lower);
        }
        const ForwardAnswer answer = equilibrium(model, state, load);
        const bool found = answer.status == DeviceStatus::good || answer.status == DeviceStatus::unstable;
        if (found && factor_tangent(model, state) && !state.repaired) continue;
        if (!found && share > 0.0) continue;  // pulled down as far as it goes
        if (!state.factored) factor_tangent(model, state);
        const std::string motion = state.factored ? softest_motion(model, state) : "gives way";
        out.push_back((found ? "with " + files::short_number(load.actuation[0]) + " " +
                                   unit_of(model.actuators[0].kind) + " the device "
                             : std::string("no equilibrium at the lower limits: the device ")) +
                      motion + " without resistance (supports, or a tie of motion between cables, hold it)");
        return;
    }
}

// One cell through: nearly all nodes lie on the surface.
void warn_of_thin_tets(const DeviceModel& model, std::vector<std::string>& out) {
    if (model.device.body.element != mechanics::Element::tet4) return;
    const mechanics::Mesh& mesh = model.device.body.body.mesh;
    std::vector<bool> outside(position(mesh.nodes_m.cols()), false);
    for (const int node : mechanics::nodes_of(model.device.body.mesh.outer)) outside[position(node)] = true;
    Index thin = 0;
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        bool all = true;
        for (Index k = 0; k < 4; ++k) all = all && outside[position(mesh.cells(k, cell))];
        thin += all ? 1 : 0;
    }
    if (2 * thin < mesh.cells.cols()) return;
    out.push_back("1 linear tetrahedron (tet4) through the wall, in " + std::to_string(thin) + " of " +
                  std::to_string(mesh.cells.cols()) +
                  " cells: such a wall is some four times too stiff in bending; hex8i, or hex8-bbar with two cells "
                  "through the wall, are not");
}

}  // namespace

std::vector<std::string> device_warnings(const DeviceModel& model) {
    std::vector<std::string> out = model.device.warnings;
    warn_of_free_motion(model, out);
    warn_of_thin_tets(model, out);
    return out;
}

double weight_N(const DeviceModel& model) {
    constexpr double kEarth_m_per_s2 = 9.80665;
    double volume_m3 = 0.0;
    for (Index cell = 0; cell < model.body.mesh.cells.cols(); ++cell) volume_m3 += cell_volume_m3(model, cell);
    return kEarth_m_per_s2 * model.device.density_kg_per_m3 * volume_m3;
}

std::string describe(const SoftDevice& device, const SoftTie& tie) {
    std::string names;
    for (const int j : tie.actuators) names += (names.empty() ? "" : ", ") + device.actuators[position(j)].name;
    return names + ": same " + (tie.force ? "force" : "") + (tie.force && tie.motion ? " and same " : "") +
           (tie.motion ? "motion" : "");
}

}  // namespace palpa::tangible
