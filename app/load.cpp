#include "app/load.h"

#include "app/assets.h"
#include "files/input_error.h"

namespace palpa {

Scene load_scene(const std::string& name) {
    const std::filesystem::path assets = assets_folder();
    if (name.empty()) return read_scene(assets / "scenes" / "default.json", assets);
    if (std::filesystem::is_directory(name)) return scene_of_map(name, assets);
    if (!std::filesystem::exists(name)) throw bad_input(name, "", "nothing", "a scene SCENE.json or a map folder");
    return read_scene(name, assets);
}

std::filesystem::path default_trace() { return assets_folder() / "traces" / "raster.tsv"; }

}  // namespace palpa
