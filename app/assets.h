#pragma once

#include <filesystem>

namespace palpa::app {

// The folder with scenes, maps, profiles and traces: $PALPA_ASSETS, else the one that belongs to the running
// program. Throws InputError that names the places if there is none.
std::filesystem::path assets_folder();

// Upwards from the folder that `program` is in, the first that has share/palpa/assets (installed) or assets (a
// build folder inside the sources). No path of the machine that built it is compiled in, so an installed tree may
// be moved.
std::filesystem::path assets_beside(const std::filesystem::path& program);

}  // namespace palpa::app
