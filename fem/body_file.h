#pragma once
// A body as files describe it: mesh, element, materials, regions and supports. Format: docs/fem.md. It is read apart
// from the rest of a case, so that other kinds of files can describe bodies in the same way.

#include <filesystem>
#include <string>
#include <vector>

#include "fem/mesh_file.h"
#include "files/json.h"
#include "mechanics/body.h"
#include "mechanics/hyperelastic.h"

namespace palpa::fem {

struct BodyFile {
    mechanics::Body body;  // mesh.region: position in `materials`
    mechanics::Element element = mechanics::Element::hex8_bbar;
    std::vector<std::string> materials;  // names, in the order of the file
    // One per material. Either all are linear or none is; body.materials holds the moduli at rest of both.
    std::vector<mechanics::Law> laws;
    CaseMesh mesh;  // the same mesh, with the names of its parts
};

// Reads "mesh", "element", "materials" and "regions". Throws InputError with file, key, what was found and what was
// expected. `folder`: the one that relative names of meshes refer to.
BodyFile read_body(files::JsonReader& json, const std::filesystem::path& folder);

struct CaseSupport {
    std::string name;        // "zmin", or the name of a physical group
    std::vector<int> nodes;  // ascending
    std::string axes;        // "xyz", "z", ...
    double value_m = 0.0;    // displacement along each of them
};

// Reads "supports" and adds them to `supports`. Throws InputError also if they leave a part of the mesh free to move,
// or give one displacement two values.
std::vector<CaseSupport> read_supports(files::JsonReader& json, const CaseMesh& mesh, mechanics::Supports& supports);

}  // namespace palpa::fem
