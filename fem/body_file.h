#pragma once
// A body as files spell it: mesh, element, materials, regions and supports. Format: docs/fem.md. Apart from the rest of
// this folder, so that whatever else is made of a mesh with materials is read alike.

#include <filesystem>
#include <string>
#include <vector>

#include "fem/mesh_file.h"
#include "files/json.h"
#include "mechanics/body.h"

namespace palpa::fem {

struct BodyFile {
    mechanics::Body body;  // mesh.region: position in `materials`
    mechanics::Element element = mechanics::Element::hex8_bbar;
    std::vector<std::string> materials;  // their names
    CaseMesh mesh;                       // the same mesh, with the names of its parts
};

// Reads "mesh", "element", "materials" and "regions". Everything that is wrong is an InputError with file, key, what
// was found and what was expected. `folder`: where relative names of meshes start.
BodyFile read_body(files::JsonReader& json, const std::filesystem::path& folder);

struct CaseSupport {
    std::string name;        // "zmin", or the name of a physical group
    std::vector<int> nodes;  // ascending
    std::string axes;        // "xyz", "z", ...
    double value_m = 0.0;
};

// Reads "supports" and adds them to the problem's; they hold every part of the mesh.
std::vector<CaseSupport> read_supports(files::JsonReader& json, const CaseMesh& mesh, mechanics::Supports& supports);

}  // namespace palpa::fem
