#pragma once
// The mesh of a case, and the names by which the case refers to its parts.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "files/json.h"
#include "files/msh.h"
#include "mechanics/statics.h"

namespace palpa::fem {

struct CaseMesh {
    mechanics::Mesh mesh;
    mechanics::Faces outer;
    mechanics::MeshReport report;
    std::string file;               // of the mesh; "" for a box
    std::optional<files::Msh> msh;  // holds the physical groups; absent for a box
    std::vector<std::string> warnings;
    std::vector<int> inside;  // nodes around the cavity of a bellows: its face "inside"
};

// Reads "mesh" (a box, bellows, or a file) and "element". The coordinates of a .msh file are in mm; its nodes that no cell uses are left out.
// Throws InputError for a mesh that cannot be computed with, for a node that lies in a face of a cell without being a
// corner of the cell, and for more nodes than a desktop can factor. Two nodes at one place only give a warning.
CaseMesh read_case_mesh(files::JsonReader& json, const std::filesystem::path& folder, mechanics::Element& element);

// Return the outer faces, or the nodes (ascending), that "face" (xmin ... zmax) or "physical" in an entry of the case
// refers to. `name` receives that name, for messages. Throw InputError for a name that the mesh does not have.
mechanics::Faces faces_named(files::JsonReader& entry, const CaseMesh& mesh, std::string& name);
std::vector<int> nodes_named(files::JsonReader& entry, const CaseMesh& mesh, std::string& name);

// Returns the cells of the volume group that "physical" names.
std::vector<int> cells_of_group(files::JsonReader& entry, const CaseMesh& mesh);

// Reads "face", one of the sides of the bounding box.
mechanics::Side read_side(files::JsonReader& entry);

// Calls a function of mechanics/ and turns its errors about the model into an InputError with file and key. A
// SolverError, which does not mean that the input is wrong, remains one and gets the file's name.
void with_key(const std::string& file, const std::string& key, const std::string& expected,
              const std::function<void()>& call);

}  // namespace palpa::fem
