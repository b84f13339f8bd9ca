#include "app/scene_choices.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>

#include "app/assets.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/regular_file.h"
#include "scene/tissue.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

// The name that a file gives itself, else the other one. A file that cannot be read is listed too: to choose it says what is
// wrong, and a scene that somebody has just edited does not vanish.
std::string name_in(const fs::path& file, const std::string& other) {
    try {
        const files::Json json = files::read_json(file);
        if (json.contains("name") && json["name"].is_string()) return json["name"];
    } catch (const std::exception&) {
    }
    return other;
}

void add_choices(const fs::path& folder, std::vector<Choice>& out) {
    for (const fs::path& entry : files::listed_entries(folder)) {
        if (entry.extension() == ".json") out.push_back({name_in(entry, entry.stem().string()), entry.string()});
    }
}

// In order of their names. One of the user's own that is called as another is, such as an edited copy, has its file's name too.
std::vector<Choice> in_order(std::vector<Choice> choices) {
    const std::vector<Choice> given = choices;
    const fs::path own = user_folder();
    for (Choice& one : choices) {
        const fs::path file(one.file);
        const auto alike = [&](const Choice& other) { return other.name == one.name && other.file != one.file; };
        if (file.parent_path().parent_path() == own && std::any_of(given.begin(), given.end(), alike))
            one.name += " (own, " + file.stem().string() + ")";
    }
    std::sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) { return a.name < b.name; });
    return choices;
}

std::vector<Choice> choices(const char* kind) {
    std::vector<Choice> out;
    add_choices(assets_folder() / kind, out);
    add_choices(user_folder() / kind, out);
    return in_order(std::move(out));
}

// A name without a folder that is not here is one of the choices below, with or without its ending. A folder of that name is
// meant only if it is a map: `palpa run tactile` may be typed beside a folder "tactile".
fs::path scene_file(const std::string& name, const fs::path& assets) {
    const fs::path given(name);
    const bool here = fs::exists(given);
    if (here && (!fs::is_directory(given) || fs::exists(given / "map.json"))) return given;
    std::string places;
    for (const fs::path& root : {assets, user_folder()}) {
        if (root.empty()) continue;
        places += (places.empty() ? "" : " or ") + root.string();
        if (given.has_parent_path()) continue;
        for (const fs::path& file : {root / "scenes" / given, root / "scenes" / (name + ".json"), root / "maps" / given,
                                     root / "maps" / (name + ".map")})
            if (fs::exists(file)) return file;
    }
    if (here) return given;  // what is missing in it is named by its reader
    throw files::bad_input(name, "", "nothing",
                           "a scene SCENE.json, a map folder, or the name of a scene or map in " + places);
}

}  // namespace

fs::path user_folder() {
    if (const char* data = std::getenv("XDG_DATA_HOME"); data != nullptr && *data == '/')
        return fs::path(data) / "palpa";
    if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
        return fs::path(home) / ".local/share/palpa";
    return {};
}

scene::Scene load_scene(const std::string& name) {
    const fs::path assets = assets_folder();
    if (name.empty()) return scene::read_scene(assets / "scenes" / "default.json", assets);
    const fs::path file = scene_file(name, assets);
    return fs::is_directory(file) ? scene::scene_of_map(file, assets) : scene::read_scene(file, assets);
}

std::vector<fs::path> inputs_of(const scene::Scene& scene, const fs::path& trace) {
    std::vector<fs::path> inputs{scene.file, scene.profile};
    for (const fs::path& file : scene::input_files(scene.tissue)) inputs.push_back(file);
    if (!trace.empty()) inputs.insert(inputs.end(), {trace, fs::path(trace).replace_extension(".json")});
    return inputs;
}

std::vector<Choice> scene_choices() { return choices("scenes"); }
std::vector<Choice> profile_choices() { return choices("profiles"); }

std::vector<Choice> map_choices() {
    std::vector<Choice> out;
    for (const fs::path& folder : {assets_folder() / "maps", user_folder() / "maps"}) {
        for (const fs::path& entry : files::listed_entries(folder)) {
            if (entry.extension() == ".map")
                out.push_back({name_in(entry / "map.json", entry.stem().string()), entry.string()});
        }
    }
    return in_order(std::move(out));
}

fs::path default_trace() { return assets_folder() / "traces" / "raster.tsv"; }

}  // namespace palpa::app
