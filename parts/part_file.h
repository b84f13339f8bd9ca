#pragma once
// The part file: materials, a list of operations that make the shape, supports and loads. Format: docs/parts.md.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/json.h"
#include "mechanics/button.h"
#include "mechanics/material.h"
#include "mechanics/mesh.h"
#include "mechanics/voxels.h"

namespace palpa::parts {

struct PartMaterial {
    std::string name;
    mechanics::Material elastic;
    double density_kg_per_m3 = 0.0;
    std::string colour;  // "#rrggbb"
};

// Displacements that are held at 0, on a side of the part or in a region.
struct PartSupport {
    std::optional<mechanics::Side> face;
    mechanics::Region region;  // if there is no face
    std::uint8_t axes = 7;     // 1 x, 2 y, 4 z
};

// A force spread over a side, or over the surface that looks against it within a circle.
struct PartLoad {
    std::string name;
    std::optional<mechanics::Side> face;
    mechanics::Point at_m{};                     // if there is no face: middle of the patch
    double patch_m = 0.0;                        // diameter
    mechanics::Point direction{0.0, 0.0, -1.0};  // unit vector
    double force_N = 1.0;
};

struct Part {
    std::string file;
    std::string name;
    mechanics::Voxels voxels;
    mechanics::EditHistory history;  // one entry per operation of `shape`
    int voxels_per_cell = 1;
    std::vector<PartMaterial> materials;
    std::vector<PartSupport> supports;
    std::vector<PartLoad> loads;
    std::optional<mechanics::Button> button;
    std::optional<int> axis;            // of the beam that the part is taken for; 0 x, 1 y, 2 z
    std::vector<std::string> warnings;  // begin with the part's name
};

// Reads a part and makes its voxels. Throws InputError with file, key, what was found and what was expected: also for an
// operation that reaches no voxel, for nothing left, for two bodies, and for too many voxels.
Part read_part(const std::filesystem::path& path);
// The same from JSON that was read already.
Part parse_part(const files::Json& json, const std::string& file_name);

// Young's modulus of rubber from its Shore A hardness, 0 < S < 100:
//   E = 0.0981 (56 + 7.62336 S) / (0.137505 (254 - 2.54 S)) MPa
// Source: Gent, "On the relation between indentation hardness and Young's modulus", Rubber Chem. Technol. 31 (1958),
//         896-906. It holds for about 20 to 80.
double young_Pa_of_shore_A(double shore_A);

std::vector<mechanics::Material> elastic_of(const Part& part);

}  // namespace palpa::parts
