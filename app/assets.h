#pragma once

#include <filesystem>

namespace palpa {

// The folder with scenes, maps, profiles and traces: $PALPA_ASSETS, else beside the sources it was built
// from, else where it was installed. Throws InputError that names the places if there is none.
std::filesystem::path assets_folder();

}  // namespace palpa
