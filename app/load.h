#pragma once
// What a person names on the command line becomes a scene.

#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace palpa {

// "" = the default scene; NAME.json = a scene; a folder = a map with default effects.
Scene load_scene(const std::string& name);

std::filesystem::path default_trace();

}  // namespace palpa
