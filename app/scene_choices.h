#pragma once
// Loads the scene that a person names on the command line or chooses in the menu.

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace palpa::app {

struct Choice {
    std::string name;  // as shown
    std::string file;
};

// "" = the default scene; a file = a scene; a folder = a map with default effects. A name alone that is not here is looked
// for among the shipped scenes and maps, then in the user's data folder.
scene::Scene load_scene(const std::string& name);

// The files and folders that the scene and the trace (with its sidecar) are read from. No result may be written there.
std::vector<std::filesystem::path> inputs_of(const scene::Scene& scene, const std::filesystem::path& trace = {});

// What the menu offers: the shipped scenes and profiles, and those in the user's data folder
// ($XDG_DATA_HOME/palpa/scenes and profiles). Files that cannot be read are left out.
std::vector<Choice> scene_choices();
std::vector<Choice> profile_choices();
std::vector<Choice> map_choices();    // folders NAME.map, of the assets and of $XDG_DATA_HOME/palpa/maps
std::filesystem::path user_folder();  // empty if neither XDG_DATA_HOME nor HOME names one

std::filesystem::path default_trace();

}  // namespace palpa::app
