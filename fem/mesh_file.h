#pragma once
// The mesh of a case, and the names by which the case speaks of its parts.

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
    std::string file;               // of the mesh, "" for a box
    std::optional<files::Msh> msh;  // where physical groups are looked up; absent for a box
    std::vector<std::string> warnings;
};

// Reads "mesh" and "element". A .msh is in mm; its nodes in no cell are left out, so that they count for
// nothing. Refuses cells that touch without sharing their nodes, and more nodes than a desktop can factor.
CaseMesh read_case_mesh(files::JsonReader& json, const std::filesystem::path& folder, mechanics::Element& element);

// What "face" (xmin ... zmax) or "physical" in an entry of the case means. `name` is filled for messages.
mechanics::Faces faces_named(files::JsonReader& entry, const CaseMesh& mesh,
                             std::string& name);                                                  // all on the outside
std::vector<int> nodes_named(files::JsonReader& entry, const CaseMesh& mesh, std::string& name);  // ascending
std::vector<int> cells_of_group(files::JsonReader& entry, const CaseMesh& mesh);

mechanics::Side read_side(files::JsonReader& entry);

// Runs a call of mechanics/ and turns its errors about the model into an InputError with file and key.
void with_key(const std::string& file, const std::string& key, const std::string& expected,
              const std::function<void()>& call);

}  // namespace palpa::fem
