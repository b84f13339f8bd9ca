#include "app/assets.h"

#include <cstdlib>
#include <string>

#include "files/input_error.h"

namespace palpa {

std::filesystem::path assets_folder() {
    const char* chosen = std::getenv("PALPA_ASSETS");
    std::string tried;
    for (const char* place : {chosen, PALPA_SOURCE_ASSETS, PALPA_INSTALLED_ASSETS}) {
        if (place == nullptr) continue;
        if (std::filesystem::is_directory(std::filesystem::path(place) / "scenes")) return place;
        if (place == chosen) throw bad_input("PALPA_ASSETS", "", shown(place), "a folder with scenes, maps, profiles");
        tried += std::string(tried.empty() ? "" : ", ") + place;
    }
    throw InputError("assets: found no folder with scenes in " + tried + "; set PALPA_ASSETS to where they are");
}

}  // namespace palpa
