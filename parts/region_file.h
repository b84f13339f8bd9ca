#pragma once
// Regions as part files spell them.

#include <filesystem>

#include "files/json.h"
#include "mechanics/voxel_region.h"

namespace palpa::parts {

// Reads one region from an object with one of the keys all, box, sphere, cylinder, path, bands, stl, both, any and without
// (docs/parts.md), and the STL files that it names. Other keys of the object are left to the caller. Throws InputError.
mechanics::Region read_region(files::JsonReader& json);

// Reads what follows the key "path" or "sculpt": `points_mm`, `radius_mm` and `ends` (round | flat).
mechanics::PathRegion read_path(files::JsonReader json);

// Returns the path of a file that a part file names: relative ones start in the part file's folder.
std::filesystem::path beside(const files::JsonReader& json, const std::filesystem::path& file);

// Reads [x, y, z] in mm.
mechanics::Point read_point_m(files::JsonReader& json, std::string_view key);

}  // namespace palpa::parts
