#include "app/screens/screenshot.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <stdexcept>

#include "app/screens/frame.h"
#include "files/text.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
}

// Returns the folder of XDG_PICTURES_DIR="$HOME/Pictures" in user-dirs.dirs, whose name depends on the person's
// language, else ~/Pictures, else the home folder.
fs::path pictures_folder() {
    const std::string home = variable("HOME");
    if (home.empty()) throw std::runtime_error("the picture is not saved: HOME names no folder");
    const std::string config = variable("XDG_CONFIG_HOME").empty() ? home + "/.config" : variable("XDG_CONFIG_HOME");
    const fs::path dirs = fs::path(config) / "user-dirs.dirs";
    if (fs::exists(dirs)) {
        const std::string text = files::read_text(dirs);
        const std::string key = "XDG_PICTURES_DIR=\"$HOME/";
        const auto at = text.find(key);
        const auto end = at == std::string::npos ? at : text.find('"', at + key.size());
        if (end != std::string::npos) return fs::path(home) / text.substr(at + key.size(), end - at - key.size());
    }
    const fs::path pictures = fs::path(home) / "Pictures";
    return fs::is_directory(pictures) ? pictures : fs::path(home);
}

std::string stamp() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[32];
    std::strftime(text, sizeof text, "palpa-%Y%m%d-%H%M%S", &local);
    return text;
}

}  // namespace

fs::path save_picture(const platform::Window& window, const std::string& log_folder) {
    const fs::path folder = log_folder.empty() ? pictures_folder() : fs::path(log_folder);
    const std::string name = stamp();
    fs::path file = folder / (name + ".png");
    for (int i = 2; fs::exists(file); ++i) file = folder / (name + "-" + std::to_string(i) + ".png");
    save_screen(window, file);
    return file;
}

}  // namespace palpa::app
