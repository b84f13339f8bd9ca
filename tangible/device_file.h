#pragma once
// The file of a soft tangible device: a body with supports and bearings, cables and cavities that move it, and the place
// where a finger presses. Format: docs/formats.md; schema: assets/schemas/device.schema.json.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "devices/rig.h"
#include "fem/body_file.h"

namespace palpa::tangible {

inline constexpr int kMostActuators = 8;

// A point that a cable passes or begins at: fixed in space, or a mean over nodes, which moves with the body.
struct PathPoint {
    Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  // at rest
    std::vector<int> node;                           // empty: fixed
    std::vector<double> weight;                      // one per node, of sum 1
};

enum class ActuatorKind { cable, cavity };
inline const char* name_of(ActuatorKind kind) { return kind == ActuatorKind::cable ? "cable" : "cavity"; }
inline const char* unit_of(ActuatorKind kind) { return kind == ActuatorKind::cable ? "N" : "Pa"; }

// A cable pulls with its tension (N) along its path; a cavity pushes with its pressure (Pa) on the faces around it.
struct SoftActuator {
    std::string name;
    ActuatorKind kind = ActuatorKind::cable;
    double lower = 0.0, upper = 0.0;  // N or Pa
    double rate_per_s = 0.0;          // most change in a second, N/s or Pa/s; 0: not limited
    std::vector<PathPoint> path;      // cable: from its end in the body to the motor
    mechanics::Faces faces;           // cavity: of the cells around it, seen from the cavity
};

// Actuators that share a drive: the same force (or pressure), the same change of length (or volume), or both.
struct SoftTie {
    std::string name;
    std::vector<int> actuators;
    bool force = false;
    bool motion = false;
};

// A round bar that is held in space and pushes on faces of the body without friction. The pressure at penetration d is
//   p(d) = k d^2 / (2 s)  for d < s,   k (d - s/2)  beyond
// with stiffness k and soft start s. By faces it is integrated over points of each face, by nodes it stands at the
// nodes alone, with their share of the area. As a constraint d is shifted until the face only touches (augmented
// Lagrangian method; Nocedal & Wright, Numerical Optimization, section 17.4).
struct Bearing {
    std::string name;
    Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  // of the axis
    Eigen::Vector3d axis = Eigen::Vector3d::UnitY();    // unit
    double radius_m = 0.0;
    mechanics::Faces faces;
    bool by_nodes = false;
    bool constraint = false;
    std::array<int, 2> points{4, 2};  // per face: across the axis, along it
    double stiffness_Pa_per_m = 1.25e9;
    double start_m = 0.3e-3;
};

// Where the finger presses: a patch of one side, by a parabolic pressure (mechanics/loads.h), and its mean place.
struct Effector {
    mechanics::Side side = mechanics::Side::zmax;
    Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
    double radius_m = 0.0;
    Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();  // of the press, into the device
    bool tilt = false;                                      // its slope is commanded too
    std::vector<int> node;
    std::vector<double> weight;  // share of the finger's force, and in the mean place; of sum 1
};

struct SensorOptions {
    double rate_Hz = 100.0;
    double noise_m = 0.0;  // standard deviation
};

// What recorded presses said about a device (`palpa tangible fit`).
struct DeviceFit {
    double modulus_factor = 1.0;  // multiplies the moduli of all materials
    double friction_share = 0.0;  // of a cable's tension, that its guides take
    double zero_m = 0.0;          // of the displacement sensor
    double lag_s = 0.0;           // of the drives, first order: the loop undoes it
};

struct SoftDevice {
    std::string file;
    std::string name;
    fem::BodyFile body;
    std::vector<mechanics::LargeMaterial> materials;  // one per cell
    mechanics::Supports supports;
    std::vector<fem::CaseSupport> support_names;
    std::vector<Bearing> bearings;
    std::vector<SoftActuator> actuators;  // cables, then cavities, in the order of the file
    std::vector<SoftTie> ties;
    Effector effector;
    SensorOptions sensor;
    double depth_floor_m = 0.5e-3;  // below it the actuation is that of the pretension
    std::optional<int> pretension;  // the actuator (with those tied to it) that sets the stiffness at the floor
    double tikhonov = 1e-8;         // of the inverse problem: see inverse.h
    double rate_term_m = 0.0;       // cost of a change by the whole range of an actuator, as an error of depth
    std::optional<devices::ActuatorRig> wires;  // one channel for each actuator, in their order
    double density_kg_per_m3 = 1070.0;
    std::optional<Eigen::Vector3d> gravity_m_per_s2;  // absent: no weight
    DeviceFit fit;
    std::vector<std::string> warnings;
};

// Throws InputError with file, key, what was found and what was expected.
SoftDevice read_soft_device(const std::filesystem::path& path);
SoftDevice parse_soft_device(const files::Json& json, const std::string& file_name,
                             const std::filesystem::path& folder);

}  // namespace palpa::tangible
