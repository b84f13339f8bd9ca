#include "app/screens/settings.h"

#include <cstdlib>
#include <exception>

#include "files/input_error.h"
#include "files/json.h"
#include "files/text.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

constexpr files::Bounds kScale_px_per_mm{0.5, 200.0};

Settings parse(const fs::path& file) {
    const files::Json root = files::read_json(file);
    files::JsonReader json(root, file.string());
    Settings s;
    s.scene = json.text("scene", s.scene);
    s.profile = json.text("profile", s.profile);
    s.left_handed = json.boolean("left_handed", s.left_handed);
    s.above_finger = json.boolean("above_finger", s.above_finger);
    s.side_view = json.boolean("side_view", s.side_view);
    s.test_mode = json.boolean("test_mode", s.test_mode);
    s.full_screen = json.boolean("full_screen", s.full_screen);
    s.keep_results = json.boolean("keep_results", s.keep_results);
    s.guided_done = json.boolean("guided_done", s.guided_done);
    s.text_percent = json.integer("text_percent", kTextPercents[0], kTextPercents[2], s.text_percent);
    s.width_px = json.integer("width_px", 100, 16384, s.width_px);
    s.height_px = json.integer("height_px", 100, 16384, s.height_px);
    for (files::JsonReader& screen : json.objects("screens")) {
        const std::string name = screen.text("name");
        s.px_per_mm[name] = screen.number("px_per_mm", kScale_px_per_mm);
        screen.finish();
    }
    json.finish();
    return s;
}

files::Json json_of(const Settings& s) {
    files::Json json{{"scene", s.scene},
                     {"profile", s.profile},
                     {"left_handed", s.left_handed},
                     {"above_finger", s.above_finger},
                     {"side_view", s.side_view},
                     {"test_mode", s.test_mode},
                     {"full_screen", s.full_screen},
                     {"keep_results", s.keep_results},
                     {"guided_done", s.guided_done},
                     {"text_percent", s.text_percent},
                     {"width_px", s.width_px},
                     {"height_px", s.height_px},
                     {"screens", files::Json::array()}};
    for (const auto& [name, px_per_mm] : s.px_per_mm)
        json["screens"].push_back({{"name", name}, {"px_per_mm", px_per_mm}});
    return json;
}

// What is in the file, with the changes from `kept` to `settings`.
files::Json merged(const Settings& settings, const Settings& kept, Settings there) {
    for (const auto& [screen, px_per_mm] : settings.px_per_mm) {
        const auto before = kept.px_per_mm.find(screen);
        if (before == kept.px_per_mm.end() || before->second != px_per_mm) there.px_per_mm[screen] = px_per_mm;
    }
    for (const auto& [screen, px_per_mm] : kept.px_per_mm) {
        if (settings.px_per_mm.count(screen) == 0) there.px_per_mm.erase(screen);
    }
    files::Json out = json_of(there);
    const files::Json before = json_of(kept), now = json_of(settings);
    for (const auto& [key, value] : now.items()) {
        if (key != "screens" && value != before.at(key)) out[key] = value;
    }
    return out;
}

// Renames a settings file that cannot be read, which may have been written by hand, so that it is not overwritten.
void move_broken_aside(const fs::path& file) {
    if (!fs::exists(file)) return;
    std::string problem;
    load_settings(file, problem);
    if (problem.empty()) return;
    fs::path aside = file;
    for (int i = 1; fs::exists(aside += ".broken-" + std::to_string(i)); ++i) aside = file;
    fs::rename(file, aside);
}

}  // namespace

fs::path settings_file() {
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config != nullptr && *config == '/') {
        return fs::path(config) / "palpa" / "settings.json";
    }
    if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
        return fs::path(home) / ".config" / "palpa" / "settings.json";
    }
    return {};
}

Settings load_settings(const fs::path& file, std::string& problem) {
    problem.clear();
    try {
        if (!file.empty() && fs::exists(file)) return parse(file);
    } catch (const std::exception& error) {
        problem = std::string(error.what()) + " (settings as if there were none)";
    }
    return {};
}

std::string save_settings(const Settings& settings, const Settings& kept, const fs::path& file) {
    if (file.empty()) return "settings are not kept: neither XDG_CONFIG_HOME nor HOME names a folder";
    try {
        fs::create_directories(file.parent_path());
        move_broken_aside(file);
        std::string problem;
        files::write_text_atomically(file, files::json_text(merged(settings, kept, load_settings(file, problem))));
    } catch (const std::exception& error) {
        return std::string("settings are not kept: ") + error.what();
    }
    return {};
}

}  // namespace palpa::app
