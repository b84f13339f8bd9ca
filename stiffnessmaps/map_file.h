#pragma once
// Map folders: NAME.map/ with map.json, normal_N.npy and, if the map has them, tangential_x_N.npy, tangential_y_N.npy
// and filled_normal_N.npy.

#include <filesystem>

#include "files/json.h"
#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

// Throws InputError for anything that is not a whole, consistent map.
Map read_map(const std::filesystem::path& folder);

// Throws InputError for what read_map would refuse: impossible positions, depths or forces.
void check_map(const Map& map, const std::string& file);

// Writes a new folder, whole or not at all. Throws InputError if something of that name exists or the parent folder
// does not.
void write_map(const Map& map, const std::filesystem::path& folder);

// Replaces map.json of an existing map (its nodules, its source); the arrays stay. Comments in map.json are lost.
// Throws std::runtime_error if it cannot be written.
void replace_map_json(const Map& map, const std::filesystem::path& folder);

files::Json map_json(const Map& map);  // the contents of map.json

}  // namespace palpa::stiffnessmaps
