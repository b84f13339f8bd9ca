#include "fem/case.h"

#include <algorithm>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::fem {
namespace {

using namespace mechanics;
using Eigen::Index;

ParabolicPressure read_pressure(files::JsonReader json, const CaseMesh& mesh) {
    json.only({"face", "centre_mm", "diameter_mm", "force_N"});
    ParabolicPressure pressure;
    pressure.side = json.has("face") ? read_side(json) : Side::zmax;
    const auto centre_mm = json.numbers("centre_mm", 2, files::kAnyNumber);
    pressure.centre_m = {1e-3 * centre_mm[0], 1e-3 * centre_mm[1]};
    pressure.diameter_m = 1e-3 * json.number("diameter_mm", files::kPositive);
    pressure.force_N = json.number("force_N", files::kAnyNumber);
    if (faces_on(mesh.mesh, mesh.outer, pressure.side).cell.size() == 0)
        json.fail("face", "no face of the mesh in that side of its bounding box", "at least one");
    const PressureLoad load = parabolic_load(mesh.mesh, mesh.outer, pressure, LoadShare::consistent);
    if (pressure.force_N != 0.0 && !(load.applied_N / pressure.force_N > 1e-6)) {
        if (load.applied_N == 0.0)
            json.fail("centre_mm", "a disc beside the body", "one that at least touches the side");
        json.fail("diameter_mm",
                  "a disc of which " + files::short_number(load.applied_N / pressure.force_N) +
                      " of the force falls on the body",
                  "a disc that is not so much wider than the body");
    }
    return pressure;
}

CaseTraction read_traction(files::JsonReader& entry, const CaseMesh& mesh) {
    CaseTraction traction;
    std::string name;
    traction.faces = faces_named(entry, mesh, name);
    if (entry.any("traction_Pa").is_array()) {
        const auto vector = entry.numbers("traction_Pa", 3, files::kAnyNumber);
        traction.vector_Pa = {vector[0], vector[1], vector[2]};
    } else {
        traction.pressure_Pa = entry.number("traction_Pa", files::kAnyNumber);
    }
    return traction;
}

CaseIndenter read_indenter(files::JsonReader json, const CaseMesh& mesh) {
    json.only({"shape", "radius_mm", "length_mm", "centre_mm", "depth_mm", "force_N", "friction"});
    if (faces_on(mesh.mesh, mesh.outer, Side::zmax).cell.size() == 0) {
        Index highest = 0;
        mesh.mesh.nodes_m.row(2).maxCoeff(&highest);
        json.fail("", "a body without a face in its highest plane; its highest is " + describe_node(mesh.mesh, highest),
                  "a flat surface at zmax for the tool to come down on");
    }
    CaseIndenter out;
    out.indenter.shape =
        json.choice("shape", {"sphere", "cylinder"}) == 0 ? IndenterShape::sphere : IndenterShape::cylinder;
    constexpr files::Bounds kRadius_mm{1e-3, 1e6};
    out.indenter.radius_m = 1e-3 * json.number("radius_mm", kRadius_mm);
    if (json.has("length_mm")) {
        if (out.indenter.shape == IndenterShape::sphere)
            json.fail("length_mm", "a length of a sphere", "it for a cylinder only");
        out.indenter.length_m = 1e-3 * json.number("length_mm", files::kPositive);
    }
    const Eigen::Vector3d low = 1e3 * mesh.mesh.nodes_m.rowwise().minCoeff();
    const Eigen::Vector3d high = 1e3 * mesh.mesh.nodes_m.rowwise().maxCoeff();
    const auto centre_mm = json.numbers("centre_mm", 2, files::kAnyNumber);
    for (int axis = 0; axis < 2; ++axis) {
        const double at = centre_mm[static_cast<std::size_t>(axis)];
        if (at >= low(axis) && at <= high(axis)) continue;
        json.fail(
            "centre_mm", files::short_number(at) + (axis == 0 ? " in x" : " in y"),
            "a place on the tissue, " + files::short_number(low(axis)) + " to " + files::short_number(high(axis)));
    }
    out.centre_m = {1e-3 * centre_mm[0], 1e-3 * centre_mm[1]};
    if (json.has("depth_mm") == json.has("force_N")) {
        json.fail("depth_mm", json.has("depth_mm") ? "depth_mm and force_N" : "nothing", "one of depth_mm and force_N");
    }
    if (json.has("depth_mm")) {
        const double thickness_mm = high(2) - low(2);
        const double depth_mm = json.number("depth_mm", files::kPositive);
        if (depth_mm >= thickness_mm) {
            json.fail("depth_mm", files::short_number(depth_mm),
                      "less than the tissue is thick, " + files::short_number(thickness_mm));
        }
        out.depth_m = 1e-3 * depth_mm;
    } else {
        out.force_N = json.number("force_N", files::kPositive);
    }
    out.friction = json.number("friction", {0.0, 10.0}, 0.0);
    return out;
}

void read_loads(files::JsonReader& json, const CaseMesh& mesh, FemCase& out) {
    for (files::JsonReader& entry : json.objects("loads")) {
        entry.only({"parabolic_pressure", "traction_Pa", "indenter", "face", "physical"});
        const int kinds =
            int{entry.has("parabolic_pressure")} + int{entry.has("traction_Pa")} + int{entry.has("indenter")};
        if (kinds != 1)
            entry.fail("", std::to_string(kinds) + " loads", "one of parabolic_pressure, traction_Pa, indenter");
        if (entry.has("traction_Pa")) {
            out.tractions.push_back(read_traction(entry, mesh));
            continue;
        }
        entry.only({"parabolic_pressure", "indenter"});
        if (entry.has("parabolic_pressure")) {
            out.pressures.push_back(read_pressure(entry.object("parabolic_pressure"), mesh));
            continue;
        }
        if (out.indenter) entry.fail("indenter", "a second indenter", "one");
        if (is_large(out)) {
            entry.fail("indenter", "an indenter on a material of law " + std::string(name_of(out.laws.front())),
                       "parabolic_pressure or traction_Pa, or value_mm of a support (indenters need linear materials)");
        }
        out.indenter = read_indenter(entry.object("indenter"), mesh);
    }
}

}  // namespace

FemCase parse_case(const files::Json& json, const std::string& file_name, const std::filesystem::path& folder) {
    files::JsonReader reader(json, file_name);
    reader.only({"name", "mesh", "element", "materials", "regions", "supports", "loads"});
    reader.text("name", "");
    FemCase out;
    out.file = file_name;
    BodyFile body = read_body(reader, folder);
    const CaseMesh& mesh = body.mesh;
    out.problem = problem_of(std::move(body.body), body.element);
    out.materials = body.materials;
    out.laws = body.laws;
    out.mesh_file = mesh.file;
    out.outer = mesh.outer;
    out.report = mesh.report;
    out.warnings = mesh.warnings;
    out.supports = read_supports(reader, mesh, out.problem.supports);
    read_loads(reader, mesh, out);
    return out;
}

FemCase read_case(const std::filesystem::path& path) {
    return parse_case(files::read_json(path), path.string(), path.parent_path());
}

}  // namespace palpa::fem
