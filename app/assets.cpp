#include "app/assets.h"

#include <cstdlib>
#include <string>

#include "files/input_error.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

bool holds_scenes(const fs::path& folder) {
    std::error_code none;
    return fs::is_directory(folder / "scenes", none);
}

}  // namespace

fs::path assets_beside(const fs::path& program) {
    std::string tried;
    for (fs::path folder = program.parent_path(); !folder.empty(); folder = folder.parent_path()) {
        for (const fs::path& place : {folder / PALPA_DATA_FOLDER "/palpa/assets", folder / "assets"}) {
            if (holds_scenes(place)) return place;
            tried += (tried.empty() ? "" : ", ") + place.string();
        }
        if (folder == folder.parent_path()) break;
    }
    throw files::InputError("assets: found no folder with scenes in " + tried + "; set PALPA_ASSETS to where they are");
}

fs::path assets_folder() {
    if (const char* chosen = std::getenv("PALPA_ASSETS")) {
        if (holds_scenes(chosen)) return chosen;
        throw files::bad_input("PALPA_ASSETS", "", files::shown(chosen), "a folder with scenes, maps, profiles");
    }
    return assets_beside(fs::read_symlink("/proc/self/exe"));
}

}  // namespace palpa::app
