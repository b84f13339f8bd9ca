#pragma once
// What a person chose once and keeps: settings.json in the user's configuration folder (XDG).

#include <filesystem>
#include <map>
#include <string>

namespace palpa::app {

struct Settings {
    std::string scene;    // empty: the default one
    std::string profile;  // empty: the scene's own
    bool left_handed = false;
    bool above_finger = false;  // a finger indents what lies kFingerOffset_mm above it, and does not hide it
    bool test_mode = false;
    bool full_screen = false;
    int width_px = 1280;
    int height_px = 800;
    std::map<std::string, double> px_per_mm;  // by screen (its name and size)
};

// $XDG_CONFIG_HOME/palpa/settings.json, or ~/.config/palpa/settings.json; empty if neither is known.
std::filesystem::path settings_file();

// What the file says; defaults where there is none. A file that cannot be read says why in `problem` and is moved aside
// by the next save, not overwritten.
Settings load_settings(const std::filesystem::path& file, std::string& problem);

// Returns why it could not be saved, in words, or nothing.
std::string save_settings(const Settings& settings, const std::filesystem::path& file);

}  // namespace palpa::app
