#include "fem/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/bellows.h"
#include "mechanics/error.h"
#include "mechanics/mesh_seams.h"

namespace palpa::fem {
namespace {

using namespace mechanics;
using Eigen::Index;

constexpr double kMostNodes = 400'000;  // 161,000 nodes take 4.9 GB to factor

// Reads the place of the box's corner, the origin if it is absent.
Eigen::Vector3d read_origin_m(files::JsonReader& box) {
    if (!box.has("origin_mm")) return Eigen::Vector3d::Zero();
    const auto mm = box.numbers("origin_mm", 3, {-1e6, 1e6});
    return 1e-3 * Eigen::Vector3d(mm[0], mm[1], mm[2]);
}

Box read_box(files::JsonReader box) {
    box.only({"size_mm", "elements", "grading", "origin_mm"});
    const auto size_mm = box.numbers("size_mm", 3, {0.0, 1e6, true});
    const auto elements = box.numbers("elements", 3, {1.0, 2000.0});
    Box out;
    double nodes = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (elements[axis] != std::floor(elements[axis])) {
            box.fail("elements", files::short_number(elements[axis]), "whole numbers from 1 to 2000");
        }
        out.size_m[axis] = 1e-3 * size_mm[axis];
        out.cells[axis] = static_cast<int>(elements[axis]);
        nodes *= elements[axis] + 1.0;
    }
    if (nodes > kMostNodes) {
        box.fail("elements", files::short_number(nodes) + " nodes", "at most " + files::short_number(kMostNodes));
    }
    if (auto grading = box.optional_object("grading")) {
        grading->only({"centre_mm", "finest_mm"});
        auto centre_mm = grading->numbers("centre_mm", 2, files::kAnyNumber);
        const Eigen::Vector3d origin_mm = 1e3 * read_origin_m(box);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double low_mm = origin_mm[static_cast<Eigen::Index>(axis)];
            const double given_mm = centre_mm[axis];
            centre_mm[axis] -= low_mm;  // in the box's own frame
            if (centre_mm[axis] >= 0.0 && centre_mm[axis] <= size_mm[axis]) continue;
            grading->fail("centre_mm", files::short_number(given_mm),
                          "a place in the box, " + files::short_number(low_mm) + " to " +
                              files::short_number(low_mm + size_mm[axis]));
        }
        const double even_mm = std::min(size_mm[0] / elements[0], size_mm[1] / elements[1]);
        out.grading = Grading{{1e-3 * centre_mm[0], 1e-3 * centre_mm[1]},
                              1e-3 * grading->number("finest_mm", {0.0, even_mm, true})};
    }
    return out;
}

Bellows read_bellows(files::JsonReader json) {
    json.only({"radius_mm", "amplitude_mm", "waves", "height_mm", "wall_mm", "plate_mm", "sectors", "along", "through",
               "plate_cells", "rings"});
    Bellows out;
    constexpr files::Bounds kSize_mm{0.0, 1e5, true};
    out.radius_m = 1e-3 * json.number("radius_mm", kSize_mm);
    out.amplitude_m = 1e-3 * json.number("amplitude_mm", {0.0, 1e5});
    out.waves = json.number("waves", {0.0, 1e3});
    out.height_m = 1e-3 * json.number("height_mm", kSize_mm);
    out.wall_m = 1e-3 * json.number("wall_mm", kSize_mm);
    out.plate_m = 1e-3 * json.number("plate_mm", kSize_mm);
    out.sectors = json.integer("sectors", 8, 400);
    out.along = json.integer("along", 1, 1000);
    out.through = json.integer("through", 1, 20, out.through);
    out.plate_cells = json.integer("plate_cells", 1, 20, out.plate_cells);
    out.rings = json.integer("rings", 0, 100, out.rings);
    return out;
}

files::MshKind kind_of(Element element) { return element == Element::tet4 ? files::MshKind::tet : files::MshKind::hex; }

// Removes the nodes that no cell of this kind uses; other cells get -1 in their place.
void drop_loose_nodes(files::MshKind kind, files::Msh& msh) {
    std::vector<int> kept_as(msh.n_nodes(), -1);
    for (const int node : msh.of(kind).nodes) kept_as[static_cast<std::size_t>(node)] = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < kept_as.size(); ++i) {
        if (kept_as[i] < 0) continue;
        std::copy_n(msh.nodes.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                    msh.nodes.begin() + static_cast<std::ptrdiff_t>(3 * kept));
        msh.node_number[kept] = msh.node_number[i];
        kept_as[i] = static_cast<int>(kept++);
    }
    msh.nodes.resize(3 * kept);
    msh.node_number.resize(kept);
    for (files::MshCells& cells : msh.cells) {
        for (int& node : cells.nodes) node = kept_as[static_cast<std::size_t>(node)];
    }
}

Mesh mesh_of(files::Msh& msh, Element element, const std::string& file) {
    const bool tets = element == Element::tet4;
    const files::MshKind wanted = kind_of(element);
    const std::size_t others = msh.count(tets ? files::MshKind::hex : files::MshKind::tet);
    const auto n = static_cast<Index>(msh.count(wanted));
    if (n == 0 || others > 0) {
        throw files::bad_input(
            file, "",
            std::to_string(msh.count(files::MshKind::hex)) + " hexahedra and " +
                std::to_string(msh.count(files::MshKind::tet)) + " tetrahedra",
            tets ? "tetrahedra only (element tet4)" : "hexahedra only (element hex8-bbar, hex8 or hex8i)");
    }
    drop_loose_nodes(wanted, msh);
    if (static_cast<double>(msh.n_nodes()) > kMostNodes) {
        throw files::bad_input(file, "", std::to_string(msh.n_nodes()) + " nodes",
                               "at most " + files::short_number(kMostNodes));
    }
    Mesh mesh;
    mesh.nodes_m = 1e-3 * Eigen::Map<const Eigen::Matrix3Xd>(msh.nodes.data(), 3, static_cast<Index>(msh.n_nodes()));
    mesh.cells = Eigen::Map<const Eigen::MatrixXi>(msh.of(wanted).nodes.data(), tets ? 4 : 8, n);
    mesh.region = Eigen::VectorXi::Zero(n);
    mesh.node_number = msh.node_number;
    mesh.cell_number = msh.of(wanted).number;
    return mesh;
}

void check_cells(CaseMesh& mesh, const files::JsonReader& json) {
    try {
        mesh.report = check_mesh(mesh.mesh);
    } catch (const MeshError& error) {
        if (!mesh.msh) throw files::bad_input(json.file(), "mesh", error.what(), "cells with a volume");
        std::string found = "inverted or flat elements";
        for (std::size_t i = 0; i < std::min<std::size_t>(error.cells.size(), 8); ++i) {
            found += " " + std::to_string(number_of_cell(mesh.mesh, error.cells[i]));
        }
        if (error.cells.size() > 8) found += " ...";
        throw files::bad_input(mesh.file, "", found + " (" + std::to_string(error.cells.size()) + " in all)",
                               "elements with a positive volume");
    }
}

// Refuses or warns of seams, since the two sides of a seam move apart or into each other, and no figure of the result
// would show it.
void check_seams(CaseMesh& mesh) {
    const Seams seams = find_seams(mesh.mesh, mesh.outer);
    if (!seams.hanging.empty()) {
        const Seam& seam = seams.hanging.front();
        throw files::bad_input(mesh.file, "",
                               describe_node(mesh.mesh, seam.node) + " in a face of element " +
                                   std::to_string(number_of_cell(mesh.mesh, seam.cell)) +
                                   " without being its corner (" + std::to_string(seams.hanging.size()) +
                                   " such nodes)",
                               "elements that share whole faces where they touch, or a gap between them");
    }
    if (seams.doubled.empty()) return;
    const Seam& seam = seams.doubled.front();
    mesh.warnings.push_back(mesh.file + ": " + std::to_string(seams.doubled.size()) +
                            " nodes lie where another node is, the first is " + describe_node(mesh.mesh, seam.node) +
                            " on node " + std::to_string(number_of_node(mesh.mesh, seam.other)) +
                            "; the elements are not joined there and may move through each other (Gmsh joins them with "
                            "Tools > Coherence or `Coherence Mesh;`)");
}

std::string name_of(const files::MshGroup& group) {
    return group.name.empty() ? std::to_string(group.tag) : group.name;
}

const files::MshGroup& find_group(files::JsonReader& entry, const CaseMesh& mesh, int dimension) {
    const std::string name = entry.text("physical");
    if (!mesh.msh)
        entry.fail("physical", files::shown(name), "a mesh from a .msh file; a box has faces xmin ... zmax only");
    std::string known;
    std::string tags;
    const files::MshGroup* found = nullptr;
    for (const files::MshGroup& group : mesh.msh->groups) {
        if (group.dimension != dimension) continue;
        known += (known.empty() ? "" : ", ") + files::shown(name_of(group));
        if (name_of(group) != name) continue;
        tags += (found != nullptr ? ", " : "") + std::to_string(group.tag);
        if (found != nullptr) {
            entry.fail("physical",
                       "several groups of dimension " + std::to_string(dimension) + " called " + files::shown(name) +
                           " in " + mesh.file + " (physical tags " + tags + ")",
                       "a name that one of them has alone");
        }
        found = &group;
    }
    if (found != nullptr) return *found;
    entry.fail("physical", files::shown(name),
               "a physical group of dimension " + std::to_string(dimension) + " in " + mesh.file + ": " +
                   (known.empty() ? "there is none" : known));
}

std::size_t count_in(const files::MshGroup& group, files::MshKind kind) {
    return group.cells[static_cast<std::size_t>(kind)].size();
}

// Refuses a group whose faces are not all of the kind that the mesh's cells have, or that has none: part of it or all
// of it would be left unloaded.
void check_faces_of(files::JsonReader& entry, const CaseMesh& mesh, const files::MshGroup& group) {
    const bool hex = is_hex(mesh.mesh);
    const std::size_t triangles = count_in(group, files::MshKind::triangle);
    const std::size_t quads = count_in(group, files::MshKind::quad);
    if ((hex ? triangles : quads) == 0 && triangles + quads > 0) return;
    entry.fail("physical",
               "a group " + files::shown(name_of(group)) + " of " + std::to_string(triangles) + " triangles and " +
                   std::to_string(quads) + " quads in " + mesh.file,
               hex ? "quads only, at least one: the faces of hexahedra"
                   : "triangles only, at least one: the faces of tetrahedra");
}

std::array<int, 4> sorted_corners(const int* nodes, int corners) {
    std::array<int, 4> key{-1, -1, -1, -1};
    std::copy_n(nodes, corners, key.begin());
    std::sort(key.begin(), key.end());
    return key;
}

Faces faces_at(const CaseMesh& mesh, const std::vector<Index>& found) {
    Faces out;
    out.corners.resize(mesh.outer.corners.rows(), static_cast<Index>(found.size()));
    out.cell.resize(static_cast<Index>(found.size()));
    for (Index i = 0; i < out.cell.size(); ++i) {
        out.corners.col(i) = mesh.outer.corners.col(found[static_cast<std::size_t>(i)]);
        out.cell(i) = mesh.outer.cell(found[static_cast<std::size_t>(i)]);
    }
    return out;
}

// Returns the outer faces that have the corners of a group's triangles or quads. Unlike those, outer faces are
// oriented. Refuses a group with a face that is not on the outside.
Faces faces_of_group(files::JsonReader& entry, const CaseMesh& mesh) {
    const files::MshGroup& group = find_group(entry, mesh, 2);
    check_faces_of(entry, mesh, group);
    std::map<std::array<int, 4>, Index> at;
    const auto corners = static_cast<int>(mesh.outer.corners.rows());
    for (Index f = 0; f < mesh.outer.cell.size(); ++f) {
        at[sorted_corners(mesh.outer.corners.col(f).data(), corners)] = f;
    }
    const files::MshKind kind = corners == 3 ? files::MshKind::triangle : files::MshKind::quad;
    std::vector<Index> found;
    for (const int cell : group.cells[static_cast<std::size_t>(kind)]) {
        const auto it = at.find(sorted_corners(mesh.msh->of(kind).nodes.data() + corners * cell, corners));
        if (it == at.end()) {
            entry.fail("physical",
                       "element " + std::to_string(mesh.msh->of(kind).number[static_cast<std::size_t>(cell)]) + " of " +
                           mesh.file + ", which is no outer face of a cell",
                       "faces on the outside");
        }
        found.push_back(it->second);
    }
    return faces_at(mesh, found);
}

// The outer faces all of whose corners lie around the cavity.
Faces faces_inside(const CaseMesh& mesh) {
    std::vector<Index> found;
    for (Index face = 0; face < mesh.outer.corners.cols(); ++face) {
        const auto corners = mesh.outer.corners.col(face);
        if (std::all_of(corners.begin(), corners.end(),
                        [&](int node) { return std::binary_search(mesh.inside.begin(), mesh.inside.end(), node); }))
            found.push_back(face);
    }
    return faces_at(mesh, found);
}

Faces faces_of_side(files::JsonReader& entry, const CaseMesh& mesh) {
    if (!mesh.inside.empty() && entry.text("face") == "inside") return faces_inside(mesh);
    Faces faces = faces_on(mesh.mesh, mesh.outer, read_side(entry));
    if (faces.cell.size() == 0)
        entry.fail("face", "no face of the mesh in that side of its bounding box", "at least one");
    return faces;
}

}  // namespace

void with_key(const std::string& file, const std::string& key, const std::string& expected,
              const std::function<void()>& call) {
    try {
        call();
    } catch (const OutOfMemory& error) {
        throw OutOfMemory(file + ": " + error.what(), error.code);
    } catch (const SolverError& error) {  // the run failed; the input may be right
        throw SolverError(file + ": " + error.what(), error.code);
    } catch (const MechanicsError& error) {
        throw files::bad_input(file, key, error.what(), expected);
    }
}

CaseMesh read_case_mesh(files::JsonReader& json, const std::filesystem::path& folder, Element& element) {
    if (json.has("element"))
        element = static_cast<Element>(
            json.choice("element", {kElementNames[0], kElementNames[1], kElementNames[2], kElementNames[3]}));
    else
        element = Element::hex8_bbar;
    files::JsonReader mesh_json = json.object("mesh");
    mesh_json.only({"box", "bellows", "file"});
    const int kinds = int{mesh_json.has("box")} + int{mesh_json.has("bellows")} + int{mesh_json.has("file")};
    if (kinds != 1) json.fail("mesh", std::to_string(kinds) + " meshes", "one of box, bellows and file");
    CaseMesh out;
    if (mesh_json.has("file")) {
        const std::filesystem::path path = folder / mesh_json.text("file");
        out.file = path.string();
        out.msh = files::read_msh(path);
        out.mesh = mesh_of(*out.msh, element, out.file);
    } else if (mesh_json.has("bellows")) {
        const Bellows shape = read_bellows(mesh_json.object("bellows"));
        with_key(json.file(), "mesh.bellows", "a wall and a plate that can be meshed", [&] {
            BellowsMesh made = bellows(shape);
            out.mesh = element == Element::tet4 ? split_columns_to_tets(made.mesh) : std::move(made.mesh);
            out.inside = std::move(made.inside);
        });
        if (static_cast<double>(out.mesh.nodes_m.cols()) > kMostNodes)
            json.fail("mesh.bellows", std::to_string(out.mesh.nodes_m.cols()) + " nodes",
                      "at most " + files::short_number(kMostNodes));
    } else {
        files::JsonReader box_json = mesh_json.object("box");
        const Eigen::Vector3d origin_m = read_origin_m(box_json);
        const Box box = read_box(box_json);
        with_key(json.file(), "mesh.box", "a box that can be meshed", [&] { out.mesh = hex_box(box); });
        out.mesh.nodes_m.colwise() += origin_m;
        if (element == Element::tet4) out.mesh = split_to_tets(out.mesh);
    }
    check_cells(out, json);
    out.outer = boundary_faces(out.mesh);
    if (out.msh) check_seams(out);
    return out;
}

Side read_side(files::JsonReader& entry) {
    return static_cast<Side>(entry.choice("face", {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"}));
}

Faces faces_named(files::JsonReader& entry, const CaseMesh& mesh, std::string& name) {
    if (entry.has("face") == entry.has("physical")) {
        entry.fail("face", entry.has("face") ? "face and physical" : "nothing",
                   "one of face (xmin ... zmax) and physical");
    }
    name = entry.text(entry.has("face") ? "face" : "physical");
    return entry.has("face") ? faces_of_side(entry, mesh) : faces_of_group(entry, mesh);
}

std::vector<int> nodes_named(files::JsonReader& entry, const CaseMesh& mesh, std::string& name) {
    if (entry.has("face") || !entry.has("physical")) return nodes_of(faces_named(entry, mesh, name));
    const files::MshGroup& group = find_group(entry, mesh, 2);  // its faces may also lie inside the body
    name = entry.text("physical");
    std::vector<int> nodes;
    for (const files::MshKind kind : {files::MshKind::triangle, files::MshKind::quad}) {
        const auto corners = static_cast<std::size_t>(files::kMshCorners[static_cast<std::size_t>(kind)]);
        for (const int cell : group.cells[static_cast<std::size_t>(kind)]) {
            const int* first = mesh.msh->of(kind).nodes.data() + corners * static_cast<std::size_t>(cell);
            if (std::any_of(first, first + corners, [](int node) { return node < 0; })) {
                entry.fail("physical",
                           "element " + std::to_string(mesh.msh->of(kind).number[static_cast<std::size_t>(cell)]) +
                               " of " + mesh.file + ", with a node that no cell of the body has",
                           "faces of the body");
            }
            nodes.insert(nodes.end(), first, first + corners);
        }
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (nodes.empty()) {
        entry.fail("physical", "a group " + files::shown(name) + " without faces in " + mesh.file, "at least one");
    }
    return nodes;
}

std::vector<int> cells_of_group(files::JsonReader& entry, const CaseMesh& mesh) {
    const files::MshKind kind = is_hex(mesh.mesh) ? files::MshKind::hex : files::MshKind::tet;
    const files::MshGroup& group = find_group(entry, mesh, 3);
    if (count_in(group, kind) == 0) {
        entry.fail("physical", "a group " + files::shown(name_of(group)) + " without elements in " + mesh.file,
                   "at least one");
    }
    return group.cells[static_cast<std::size_t>(kind)];
}

}  // namespace palpa::fem
