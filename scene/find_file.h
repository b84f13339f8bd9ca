#pragma once

#include <filesystem>
#include <string>

namespace palpa::scene {

// Returns the path that a scene file names: relative to the file, or for a name without a folder that is not beside the
// file, in `assets_folder`.
inline std::filesystem::path find_file(const std::string& name, const std::filesystem::path& scene_file,
                                       const std::filesystem::path& assets_folder) {
    const std::filesystem::path given(name);
    if (given.is_absolute()) return given;
    const std::filesystem::path beside = (scene_file.parent_path() / given).lexically_normal();
    if (std::filesystem::exists(beside) || given.has_parent_path()) return beside;
    return assets_folder / given;
}

}  // namespace palpa::scene
