#pragma once
// The case file of `palpa fem solve`: mesh, materials by region, supports, loads. Format: docs/fem.md.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fem/body_file.h"
#include "mechanics/contact.h"
#include "mechanics/loads.h"

namespace palpa::fem {

// Force per area on faces: a pressure into the body, or a vector.
struct CaseTraction {
    mechanics::Faces faces;
    std::optional<double> pressure_Pa;  // square to the faces; absent: vector_Pa
    std::array<double, 3> vector_Pa{};  // x, y, z
};

struct CaseIndenter {
    mechanics::Indenter indenter;
    std::array<double, 2> centre_m{};  // x, y on zmax
    std::optional<double> depth_m;     // below the surface at rest; absent: force_N
    double force_N = 0.0;
    double friction = 0.0;  // coefficient
};

// A case whose parts were checked: materials, mesh and supports can be solved together.
struct FemCase {
    std::string file;
    std::string mesh_file;       // empty for a box
    mechanics::Problem problem;  // mesh.region: position in `materials`
    mechanics::Faces outer;
    mechanics::MeshReport report;
    std::vector<std::string> warnings;  // of the mesh
    std::vector<std::string> materials;
    std::vector<mechanics::Law> laws;  // one per material: all linear, or none
    std::vector<CaseSupport> supports;
    std::vector<mechanics::ParabolicPressure> pressures;
    std::vector<CaseTraction> tractions;
    std::optional<CaseIndenter> indenter;
};

inline bool is_large(const FemCase& model) {
    return !model.laws.empty() && model.laws.front() != mechanics::Law::linear;
}

// Reads a case. Throws InputError with file, key, what was found and what was expected.
FemCase read_case(const std::filesystem::path& path);
// The same from JSON that was read already. `folder`: the one that relative names of meshes refer to.
FemCase parse_case(const files::Json& json, const std::string& file_name, const std::filesystem::path& folder);

}  // namespace palpa::fem
