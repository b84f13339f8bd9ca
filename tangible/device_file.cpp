#include "tangible/device_file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/face_point.h"
#include "mechanics/loads.h"
#include "tangible/places.h"

namespace palpa::tangible {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using files::JsonReader;

Vector3d place_m(JsonReader& json, std::string_view key) {
    const auto mm = json.numbers(key, 3, {-1e5, 1e5});
    return 1e-3 * Vector3d(mm[0], mm[1], mm[2]);
}

std::string millimetres(const Vector3d& m) {
    const Vector3d mm = 1e3 * m;
    return "[" + files::short_number(mm.x()) + ", " + files::short_number(mm.y()) + ", " + files::short_number(mm.z()) +
           "]";
}

double body_size_m(const mechanics::Mesh& mesh) {
    return (mesh.nodes_m.rowwise().maxCoeff() - mesh.nodes_m.rowwise().minCoeff()).norm();
}

bool by_nodes(JsonReader& json) { return json.has("by") && json.choice("by", {"faces", "nodes"}) == 1; }

// The mean of a face: every part of its area counts alike, or every node.
PathPoint point_of_face(JsonReader& entry, const fem::CaseMesh& mesh) {
    std::string name;
    const bool nodes = by_nodes(entry);
    const mechanics::Faces faces = fem::faces_named(entry, mesh, name);
    Eigen::VectorXd area_m2 = mechanics::tributary_area_m2(mesh.mesh, faces);
    if (nodes) area_m2 = (area_m2.array() > 0.0).cast<double>();
    PathPoint point;
    for (const int node : mechanics::nodes_of(faces)) {
        point.node.push_back(node);
        point.weight.push_back(area_m2(node) / area_m2.sum());
        point.at_m += point.weight.back() * mesh.mesh.nodes_m.col(node);
    }
    return point;
}

// The point of the body's surface at a place.
PathPoint point_of_surface(JsonReader& entry, const fem::CaseMesh& mesh) {
    const Vector3d wanted_m = place_m(entry, "at_mm");
    mechanics::OnFace nearest;
    nearest.away_m = 1e300;
    Index face = -1;
    for (Index i = 0; i < mesh.outer.corners.cols(); ++i) {
        const mechanics::OnFace here =
            mechanics::nearest_on_face(mechanics::corners_of_face_m(mesh.mesh, mesh.outer, i), wanted_m);
        if (here.away_m >= nearest.away_m) continue;
        nearest = here;
        face = i;
    }
    if (face < 0 || nearest.away_m > 0.01 * body_size_m(mesh.mesh))
        entry.fail("at_mm",
                   millimetres(wanted_m) + ", " + files::short_number(1e3 * nearest.away_m) +
                       " mm away from the body's surface",
                   "a place on the surface (guide_mm is for places in space)");
    PathPoint point;
    for (Index k = 0; k < nearest.weight.size(); ++k) {
        if (nearest.weight(k) < 1e-9) continue;
        point.node.push_back(mesh.outer.corners(k, face));
        point.weight.push_back(nearest.weight(k));
        point.at_m += nearest.weight(k) * mesh.mesh.nodes_m.col(point.node.back());
    }
    return point;
}

void read_limits(JsonReader& json, SoftActuator& actuator, const std::string& unit) {
    actuator.lower = json.number("lower_" + unit, {0.0, 1e9}, 0.0);
    actuator.upper = json.number("upper_" + unit, {0.0, 1e9, true});
    actuator.rate_per_s = json.number("rate_" + unit + "_per_s", {0.0, 1e12, true}, 0.0);
    if (actuator.lower > actuator.upper)
        json.fail("lower_" + unit, files::number_text(actuator.lower),
                  "at most upper_" + unit + ", " + files::number_text(actuator.upper));
}

SoftActuator read_cable(JsonReader& json, const fem::CaseMesh& mesh) {
    json.only({"name", "path", "lower_N", "upper_N", "rate_N_per_s"});
    SoftActuator cable;
    cable.name = json.text("name");
    cable.kind = ActuatorKind::cable;
    read_limits(json, cable, "N");
    for (JsonReader& entry : json.objects("path")) {
        entry.only({"face", "physical", "by", "at_mm", "guide_mm"});
        if (entry.has("guide_mm"))
            cable.path.push_back({place_m(entry, "guide_mm"), {}, {}});
        else
            cable.path.push_back(entry.has("at_mm") ? point_of_surface(entry, mesh) : point_of_face(entry, mesh));
        entry.finish();
    }
    if (cable.path.size() < 2 || cable.path.front().node.empty() || !cable.path.back().node.empty())
        json.fail("path", "a path of " + std::to_string(cable.path.size()) + " points",
                  "at least two: first a place in the body (face, physical or at_mm), last a guide (guide_mm)");
    for (std::size_t k = 0; k + 1 < cable.path.size(); ++k) {
        if ((cable.path[k].at_m - cable.path[k + 1].at_m).norm() < 1e-6)
            json.fail("path", "two points at " + millimetres(cable.path[k].at_m), "points that are apart");
    }
    return cable;
}

// Edges that belong to one face only, by their two nodes.
std::vector<std::array<int, 2>> open_edges(const mechanics::Faces& faces) {
    std::map<std::array<int, 2>, int> count;
    const Index corners = faces.corners.rows();
    for (Index face = 0; face < faces.corners.cols(); ++face) {
        for (Index k = 0; k < corners; ++k) {
            std::array<int, 2> edge{faces.corners(k, face), faces.corners((k + 1) % corners, face)};
            if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
            ++count[edge];
        }
    }
    std::vector<std::array<int, 2>> out;
    for (const auto& [edge, times] : count) {
        if (times == 1) out.push_back(edge);
    }
    return out;
}

// A cavity may be open only where supports hold its rim: there the base closes it. The rim's middle, from which its
// volume counts, becomes the only point of its path.
void check_closed(JsonReader& json, const SoftDevice& device, SoftActuator& cavity) {
    const mechanics::Mesh& mesh = device.body.body.mesh;
    std::vector<int> axes(position(mesh.nodes_m.cols()), 0);
    for (const int dof : device.supports.dof) axes[position(dof / 3)] |= 1 << (dof % 3);
    Vector3d middle = Vector3d::Zero();
    const auto edges = open_edges(cavity.faces);
    for (const auto& edge : edges) {
        middle += (mesh.nodes_m.col(edge[0]) + mesh.nodes_m.col(edge[1])) / (2.0 * static_cast<double>(edges.size()));
        if (axes[position(edge[0])] == 7 && axes[position(edge[1])] == 7) continue;
        json.fail(
            "face",
            "an open cavity: its edge at " + millimetres(mesh.nodes_m.col(edge[0])) + " mm belongs to one face only",
            "faces that close the cavity, or whose rim supports hold along xyz");
    }
    if (!edges.empty()) cavity.path.push_back({middle, {}, {}});
}

SoftActuator read_cavity(JsonReader& json, const SoftDevice& device) {
    json.only({"name", "face", "physical", "lower_Pa", "upper_Pa", "rate_Pa_per_s"});
    SoftActuator cavity;
    cavity.name = json.text("name");
    cavity.kind = ActuatorKind::cavity;
    read_limits(json, cavity, "Pa");
    std::string name;
    cavity.faces = fem::faces_named(json, device.body.mesh, name);
    check_closed(json, device, cavity);
    return cavity;
}

int actuator_named(JsonReader& json, std::string_view key, const std::string& name, const SoftDevice& device) {
    std::string known;
    for (std::size_t j = 0; j < device.actuators.size(); ++j) {
        if (device.actuators[j].name == name) return static_cast<int>(j);
        known += (known.empty() ? "" : ", ") + device.actuators[j].name;
    }
    json.fail(key, files::shown(name), "the name of an actuator: " + known);
}

SoftTie read_tie(JsonReader& json, const SoftDevice& device) {
    json.only({"actuators", "force", "motion"});
    SoftTie tie;
    double lower = 0.0;
    double upper = 1e300;
    for (const std::string& name : json.texts("actuators", 2, "names of actuators")) {
        tie.actuators.push_back(actuator_named(json, "actuators", name, device));
        const SoftActuator& other = device.actuators[position(tie.actuators.back())];
        const SoftActuator& first = device.actuators[position(tie.actuators.front())];
        if (std::count(tie.actuators.begin(), tie.actuators.end(), tie.actuators.back()) > 1)
            json.fail("actuators", files::shown(other.name) + " twice", "each actuator once");
        if (other.kind != first.kind)
            json.fail("actuators",
                      std::string("the ") + name_of(first.kind) + " " + first.name + " tied to the " +
                          name_of(other.kind) + " " + other.name,
                      "actuators of one kind: N cannot equal Pa");
        lower = std::max(lower, other.lower);
        upper = std::min(upper, other.upper);
    }
    tie.force = json.boolean("force", false);
    tie.motion = json.boolean("motion", false);
    if (!tie.force && !tie.motion) json.fail("force", "a tie of neither force nor motion", "force or motion true");
    if (tie.motion && device.actuators[position(tie.actuators[0])].kind == ActuatorKind::cavity)
        json.fail("motion", "cavities that share their motion", "cables");
    if (tie.force && lower > upper)
        json.fail(
            "actuators",
            "limits without a common value (" + files::short_number(lower) + " > " + files::short_number(upper) + ")",
            "limits that overlap");
    return tie;
}

Bearing read_bearing(JsonReader& json, const fem::CaseMesh& mesh) {
    json.only({"name", "face", "physical", "point_mm", "axis", "radius_mm", "by", "as", "points", "stiffness_Pa_per_mm",
               "start_mm"});
    Bearing bearing;
    bearing.name = json.text("name");
    std::string face;
    bearing.faces = fem::faces_named(json, mesh, face);
    bearing.point_m = place_m(json, "point_mm");
    const auto axis = json.numbers("axis", 3, {-1e6, 1e6});
    bearing.axis = Vector3d(axis[0], axis[1], axis[2]);
    if (!(bearing.axis.norm() > 0.0)) json.fail("axis", "[0, 0, 0]", "a direction");
    bearing.axis.normalize();
    bearing.radius_m = 1e-3 * json.number("radius_mm", {0.0, 1e5, true});
    bearing.by_nodes = by_nodes(json);
    bearing.constraint = json.has("as") && json.choice("as", {"penalty", "constraint"}) == 1;
    if (json.has("points")) {
        const auto points = json.numbers("points", 2, {1.0, 4.0});
        for (std::size_t k = 0; k < 2; ++k) {
            if (points[k] != std::floor(points[k])) json.fail("points", files::number_text(points[k]), "1, 2, 3 or 4");
            bearing.points[k] = static_cast<int>(points[k]);
        }
    }
    bearing.stiffness_Pa_per_m = 1e3 * json.number("stiffness_Pa_per_mm", {0.0, 1e12, true}, 1.25e6);
    bearing.start_m = 1e-3 * json.number("start_mm", {0.0, 1e3, true}, 0.3);
    return bearing;
}

Effector read_effector(JsonReader json, const fem::CaseMesh& mesh) {
    json.only({"face", "centre_mm", "radius_mm", "by", "tilt"});
    Effector out;
    out.side = json.has("face") ? fem::read_side(json) : mechanics::Side::zmax;
    const int axis = mechanics::axis_of(out.side);
    const auto centre_mm = json.numbers("centre_mm", 2, {-1e5, 1e5});
    out.radius_m = 1e-3 * json.number("radius_mm", {0.0, 1e5, true});
    out.tilt = json.boolean("tilt", false);
    out.direction = (mechanics::is_max(out.side) ? -1.0 : 1.0) * Vector3d::Unit(axis);
    mechanics::ParabolicPressure pressure{
        out.side, {1e-3 * centre_mm[0], 1e-3 * centre_mm[1]}, 2.0 * out.radius_m, 1.0};
    const mechanics::PressureLoad load =
        mechanics::parabolic_load(mesh.mesh, mesh.outer, pressure, mechanics::LoadShare::consistent);
    if (load.partial || !(load.applied_N > 0.0))
        json.fail("centre_mm", "a disc that lies beside the body, in part at least", "a disc on the side");
    const bool nodes = by_nodes(json);
    double sum = 0.0;
    for (Index node = 0; node < load.force_N.cols(); ++node) {
        double share = load.force_N.col(node).dot(out.direction);
        if (nodes && share > 0.0) {
            Vector3d away_m = mesh.mesh.nodes_m.col(node);
            away_m(axis) = 0.0;
            for (int k = 0, other = 0; k < 3; ++k) away_m(k) -= k == axis ? 0.0 : pressure.centre_m[position(other++)];
            share = std::max(0.0, 1.0 - away_m.squaredNorm() / (out.radius_m * out.radius_m));
        }
        if (share == 0.0) continue;
        out.node.push_back(static_cast<int>(node));
        out.weight.push_back(share);
        sum += share;
    }
    if (!(sum > 0.0)) json.fail("radius_mm", "a disc without a node", "a larger disc, or by faces");
    for (std::size_t i = 0; i < out.node.size(); ++i) {
        out.weight[i] /= sum;
        out.centre_m += out.weight[i] * mesh.mesh.nodes_m.col(out.node[i]);
    }
    return out;
}

void read_actuators(JsonReader& json, SoftDevice& out) {
    for (JsonReader& entry : json.objects("cables")) out.actuators.push_back(read_cable(entry, out.body.mesh));
    for (JsonReader& entry : json.objects("cavities")) out.actuators.push_back(read_cavity(entry, out));
    const std::size_t count = out.actuators.size();
    if (count == 0 || count > position(kMostActuators))
        json.fail("cables", std::to_string(count) + " cables and cavities",
                  "1 to " + std::to_string(kMostActuators) + " in all");
    for (std::size_t j = 0; j < count; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
            if (out.actuators[j].name == out.actuators[k].name)
                json.fail("cables", "two actuators called " + files::shown(out.actuators[j].name),
                          "names of their own");
        }
    }
    for (JsonReader& entry : json.objects("ties")) {
        out.ties.push_back(read_tie(entry, out));
        entry.finish();
    }
    if (json.has("pretension")) out.pretension = actuator_named(json, "pretension", json.text("pretension"), out);
}

void read_materials(const JsonReader& json, SoftDevice& out) {
    for (Index cell = 0; cell < out.body.body.mesh.cells.cols(); ++cell) {
        const auto region = position(out.body.body.mesh.region(cell));
        if (out.body.laws[region] == mechanics::Law::linear)
            json.fail("materials." + out.body.materials[region], "a linear material",
                      "a law for large strains: neo-hookean, neo-hookean-split, stable-neo-hookean, corotational");
        out.materials.push_back(mechanics::with_law(out.body.body.materials[position(cell)], out.body.laws[region]));
    }
}

void read_inverse(JsonReader& json, SoftDevice& out) {
    out.depth_floor_m = 1e-3 * json.number("depth_floor_mm", {0.0, 1e3, true}, 0.5);
    auto inverse = json.optional_object("inverse");
    if (!inverse) return;
    inverse->only({"tikhonov", "rate_term_mm"});
    out.tikhonov = inverse->number("tikhonov", {0.0, 1.0, true}, out.tikhonov);
    out.rate_term_m = 1e-3 * inverse->number("rate_term_mm", {0.0, 1e3}, 0.0);
}

void read_sensor(JsonReader& json, SoftDevice& out) {
    auto sensor = json.optional_object("sensor");
    if (!sensor) return;
    sensor->only({"rate_Hz", "noise_mm"});
    out.sensor.rate_Hz = sensor->number("rate_Hz", {0.0, 1e5, true}, 100.0);
    out.sensor.noise_m = 1e-3 * sensor->number("noise_mm", {0.0, 100.0}, 0.0);
}

// One channel for each actuator, whose order it gets.
void read_wires(JsonReader& json, SoftDevice& out) {
    auto wires = json.optional_object("wires");
    if (!wires) return;
    devices::ActuatorRig rig = devices::read_rig(*wires);
    std::vector<devices::RigChannel> channels;
    for (const SoftActuator& actuator : out.actuators) {
        const auto same = [&](const devices::RigChannel& channel) { return channel.name == actuator.name; };
        const auto channel = std::find_if(rig.channels.begin(), rig.channels.end(), same);
        if (channel == rig.channels.end())
            json.fail("wires.actuators", "none of the name '" + actuator.name + "'", "one for each cable and cavity");
        const bool pressure = channel->drive == devices::Drive::pressure;
        if (pressure != (actuator.kind == ActuatorKind::cavity))
            json.fail("wires.actuators",
                      "the " + std::string(name_of(actuator.kind)) + " '" + actuator.name + "' driven by " +
                          (pressure ? "pressure" : "force or length"),
                      actuator.kind == ActuatorKind::cavity ? "pressure" : "force or length");
        channels.push_back(*channel);
    }
    if (channels.size() != rig.channels.size())
        json.fail("wires.actuators", std::to_string(rig.channels.size()) + " actuators",
                  std::to_string(channels.size()) + ": the device's cables and cavities");
    rig.channels = std::move(channels);
    if (rig.name.empty()) rig.name = out.name;
    out.wires = std::move(rig);
}

void read_fit(JsonReader& json, SoftDevice& out) {
    auto fit = json.optional_object("fit");
    if (!fit) return;
    fit->only({"modulus_factor", "friction_share", "zero_mm", "lag_ms"});
    out.fit.modulus_factor = fit->number("modulus_factor", {0.1, 10.0}, out.fit.modulus_factor);
    out.fit.friction_share = fit->number("friction_share", {0.0, 0.5}, out.fit.friction_share);
    out.fit.zero_m = 1e-3 * fit->number("zero_mm", {-100.0, 100.0}, 0.0);
    out.fit.lag_s = 1e-3 * fit->number("lag_ms", {0.0, 1000.0}, 0.0);
    fit->finish();
}

void read_weight(JsonReader& json, SoftDevice& out) {
    out.density_kg_per_m3 = json.number("density_kg_per_m3", {0.0, 1e5, true}, 1070.0);
    if (!json.has("gravity_m_per_s2")) return;
    const auto g = json.numbers("gravity_m_per_s2", 3, {-1e3, 1e3});
    out.gravity_m_per_s2 = Vector3d(g[0], g[1], g[2]);
}

}  // namespace

SoftDevice parse_soft_device(const files::Json& json, const std::string& file_name,
                             const std::filesystem::path& folder) {
    JsonReader reader(json, file_name);
    reader.only({"name", "mesh", "element", "materials", "regions", "supports", "bearings", "cables", "cavities",
                 "ties", "pretension", "effector", "sensor", "depth_floor_mm", "inverse", "wires", "density_kg_per_m3",
                 "gravity_m_per_s2", "fit"});
    SoftDevice out;
    out.file = file_name;
    out.name = reader.text("name");
    out.body = fem::read_body(reader, folder);
    out.warnings = out.body.mesh.warnings;
    read_materials(reader, out);
    if (reader.has("supports")) out.support_names = fem::read_supports(reader, out.body.mesh, out.supports);
    for (const double value : out.supports.value_m) {
        if (value != 0.0) reader.fail("supports", "a value_mm that is not 0", "supports that stand still");
    }
    for (JsonReader& entry : reader.objects("bearings")) out.bearings.push_back(read_bearing(entry, out.body.mesh));
    read_actuators(reader, out);
    out.effector = read_effector(reader.object("effector"), out.body.mesh);
    read_inverse(reader, out);
    read_sensor(reader, out);
    read_wires(reader, out);
    read_weight(reader, out);
    read_fit(reader, out);
    reader.finish();
    return out;
}

SoftDevice read_soft_device(const std::filesystem::path& path) {
    return parse_soft_device(files::read_json(path), path.string(), path.parent_path());
}

}  // namespace palpa::tangible
