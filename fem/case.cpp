#include "fem/case.h"

#include <algorithm>

#include "fem/mesh_file.h"
#include "files/input_error.h"
#include "files/text.h"

namespace palpa::fem {
namespace {

using namespace mechanics;
using Eigen::Index;

Material read_material(files::JsonReader json) {
    if (json.has("law")) {
        constexpr std::array kLaws{"linear", "neo-hookean", "stable-neo-hookean", "corotational"};
        const auto law = json.choice("law", {"linear", "neo-hookean", "stable-neo-hookean", "corotational"});
        if (law != 0) {
            json.fail("law", files::shown(kLaws[law]),
                      "linear (young_Pa and poisson): `fem solve` does not have the nonlinear laws yet");
        }
    }
    json.only({"law", "young_Pa", "poisson"});
    Material material;
    material.young_Pa = json.number("young_Pa", {0.0, 1e15, true});
    material.poisson = json.number("poisson", files::kAnyNumber);
    // at 0.5 - 1e-10 a block sinks as at 0.4999999 to six digits, at 0.5 - 1e-12 only to five, and a few
    // roundings below 0.5 the matrix can no longer be factored (2026-11)
    constexpr double kMostPoisson = 0.5 - 1e-10;
    if (!(material.poisson > -1.0 && material.poisson <= kMostPoisson)) {
        json.fail("poisson", files::number_text(material.poisson),
                  "a number > -1 and < 0.5 by at least 1e-10 (0.4999 stands for an incompressible tissue)");
    }
    return material;
}

std::vector<Material> read_materials(files::JsonReader& json, std::vector<std::string>& names) {
    const files::Json& list = json.any("materials");
    if (!list.is_object() || list.empty()) {
        json.fail("materials", files::described(list),
                  "an object with at least one material: {\"gel\": {\"young_Pa\": 2500, \"poisson\": 0.45}}");
    }
    std::vector<Material> materials;
    for (const auto& item : list.items()) {
        names.push_back(item.key());
        materials.push_back(read_material(files::JsonReader(item.value(), json.file(), "materials." + item.key())));
    }
    return materials;
}

Eigen::Matrix3Xd centroids_m(const Mesh& mesh) {
    Eigen::Matrix3Xd out(3, mesh.cells.cols());
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        out.col(cell).setZero();
        for (Index k = 0; k < mesh.cells.rows(); ++k) out.col(cell) += mesh.nodes_m.col(mesh.cells(k, cell));
        out.col(cell) /= static_cast<double>(mesh.cells.rows());
    }
    return out;
}

Eigen::Vector3d vector_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

// Cells that one region takes: those whose centre is inside.
std::vector<int> cells_of_region(files::JsonReader& entry, const CaseMesh& mesh, const Eigen::Matrix3Xd& centre_m) {
    if (entry.has("physical")) return cells_of_group(entry, mesh);
    std::vector<int> cells;
    const auto take_if = [&](auto&& inside) {
        for (Index cell = 0; cell < centre_m.cols(); ++cell) {
            if (inside(Eigen::Vector3d(centre_m.col(cell)))) cells.push_back(static_cast<int>(cell));
        }
    };
    if (entry.has("all")) {
        if (!entry.boolean("all", true)) entry.fail("all", "false", "true");
        take_if([](const Eigen::Vector3d&) { return true; });
    } else if (entry.has("sphere")) {
        files::JsonReader sphere = entry.object("sphere");
        sphere.only({"centre_mm", "radius_mm"});
        const Eigen::Vector3d middle = 1e-3 * vector_of(sphere.numbers("centre_mm", 3, files::kAnyNumber));
        const double radius_m = 1e-3 * sphere.number("radius_mm", files::kPositive);
        take_if([&](const Eigen::Vector3d& x) { return (x - middle).norm() <= radius_m; });
    } else {
        files::JsonReader box = entry.object("box");
        box.only({"min_mm", "max_mm"});
        const Eigen::Vector3d low = 1e-3 * vector_of(box.numbers("min_mm", 3, files::kAnyNumber));
        const Eigen::Vector3d high = 1e-3 * vector_of(box.numbers("max_mm", 3, files::kAnyNumber));
        if (!(low.array() < high.array()).all())
            box.fail("max_mm", "a corner that is not above min_mm", "max_mm > min_mm in x, y and z");
        take_if([&](const Eigen::Vector3d& x) {
            return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
        });
    }
    return cells;
}

void read_regions(files::JsonReader& json, const std::vector<std::string>& materials, CaseMesh& mesh) {
    auto entries = json.objects("regions");
    if (entries.empty() && materials.size() == 1) return;  // one material: it is everywhere
    mesh.mesh.region.setConstant(-1);
    const Eigen::Matrix3Xd centre_m = centroids_m(mesh.mesh);
    for (files::JsonReader& entry : entries) {
        entry.only({"all", "box", "sphere", "physical", "material"});
        const int kinds =
            int{entry.has("all")} + int{entry.has("box")} + int{entry.has("sphere")} + int{entry.has("physical")};
        if (kinds != 1) entry.fail("", std::to_string(kinds) + " shapes", "one of all, box, sphere, physical");
        const std::string name = entry.text("material");
        const auto it = std::find(materials.begin(), materials.end(), name);
        if (it == materials.end()) {
            std::string known;
            for (const auto& material : materials) known += (known.empty() ? "" : ", ") + material;
            entry.fail("material", files::shown(name), "one of the materials: " + known);
        }
        const std::vector<int> cells = cells_of_region(entry, mesh, centre_m);
        if (cells.empty())
            entry.fail("", "no cell whose centre is inside", "at least one (a finer mesh, a larger region)");
        for (const int cell : cells) mesh.mesh.region(cell) = static_cast<int>(it - materials.begin());
    }
    const auto bare = (mesh.mesh.region.array() < 0).count();
    if (bare > 0) {
        Index first = 0;
        while (mesh.mesh.region(first) >= 0) ++first;
        json.fail("regions",
                  std::to_string(bare) + " of " + std::to_string(mesh.mesh.region.size()) +
                      " cells without a material, the first is cell " +
                      std::to_string(number_of_cell(mesh.mesh, first)),
                  "a region for each: begin with {\"all\": true, \"material\": ...}");
    }
}

void read_supports(files::JsonReader& json, const CaseMesh& mesh, FemCase& out) {
    for (files::JsonReader& entry : json.objects("supports")) {
        entry.only({"face", "physical", "fix", "value_mm"});
        CaseSupport support;
        support.nodes = nodes_named(entry, mesh, support.name);
        support.axes = entry.text("fix");
        std::string sorted = support.axes;
        std::sort(sorted.begin(), sorted.end());
        const bool once = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
        if (sorted.empty() || !once || sorted.find_first_not_of("xyz") != std::string::npos) {
            entry.fail("fix", files::shown(support.axes), "some of x, y and z, each once: \"xyz\", \"z\"");
        }
        support.value_m = 1e-3 * entry.number("value_mm", files::kAnyNumber, 0.0);
        fix(support.nodes, support.axes, support.value_m, out.problem.supports);
        out.supports.push_back(std::move(support));
    }
    const std::string held = "supports that hold every part, each displacement given once";
    with_key(json.file(), "supports", held, [&] {
        check_supported(out.problem.mesh, out.problem.supports);
        make_reduction(out.problem.mesh, out.problem.supports, {});
    });
}

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
        json.fail("centre_mm", "a disc beside the body", "one that at least touches the side");
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
    out.indenter.radius_m = 1e-3 * json.number("radius_mm", files::kPositive);
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
    const std::vector<Material> materials = read_materials(reader, out.materials);
    CaseMesh mesh = read_case_mesh(reader, folder, out.problem.element);
    read_regions(reader, out.materials, mesh);
    out.problem.mesh = mesh.mesh;
    out.problem.materials = materials_of_cells(mesh.mesh.region, materials);
    out.mesh_file = mesh.file;
    out.outer = mesh.outer;
    out.report = mesh.report;
    out.warnings = mesh.warnings;
    read_supports(reader, mesh, out);
    read_loads(reader, mesh, out);
    return out;
}

FemCase read_case(const std::filesystem::path& path) {
    return parse_case(files::read_json(path), path.string(), path.parent_path());
}

}  // namespace palpa::fem
