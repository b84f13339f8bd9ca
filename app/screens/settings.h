#pragma once
// The choices that are kept from run to run: settings.json in the user's configuration folder (XDG).

#include <filesystem>
#include <map>
#include <string>

namespace palpa::app {

struct Settings {
    std::string scene;    // empty: the default one
    std::string profile;  // empty: the scene's own
    bool left_handed = false;
    bool above_finger = false;  // a finger indents the place kFingerOffset_mm above it, and does not hide it
    bool side_view = true;      // of scenes that have one
    bool test_mode = false;
    bool full_screen = false;
    bool keep_results = true;  // of each finished trial, in the user's data folder
    bool guided_done = false;  // the guided start was finished or skipped
    int text_percent = 100;    // size of controls and text: one of kTextPercents
    int width_px = 1280;
    int height_px = 800;
    std::map<std::string, double> px_per_mm;  // by screen (its name and size)
};

inline constexpr int kTextPercents[3] = {100, 120, 140};

// Returns $XDG_CONFIG_HOME/palpa/settings.json, or ~/.config/palpa/settings.json; empty if neither variable is an
// absolute path.
std::filesystem::path settings_file();

// Reads the settings; without a file they are the defaults. If the file cannot be read, `problem` says why, the
// defaults are returned, and the next save moves the file aside instead of overwriting it.
Settings load_settings(const std::filesystem::path& file, std::string& problem);

// Saves what differs from `kept`, as this window last read or saved it, and leaves the rest as another window may have saved
// it since. Returns in words why nothing could be saved, or nothing.
std::string save_settings(const Settings& settings, const Settings& kept, const std::filesystem::path& file);

}  // namespace palpa::app
