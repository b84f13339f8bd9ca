#pragma once

#include <filesystem>
#include <string>

#include "platform/window.h"

namespace palpa::app {

// Saves what the window shows under a new name with the date: in the log's folder if there is one, else among the
// person's pictures (xdg-user-dirs), else in the home folder. Returns the file. Throws std::runtime_error if it cannot
// be written.
std::filesystem::path save_picture(const platform::Window& window, const std::string& log_folder);

}  // namespace palpa::app
