#pragma once
// A pseudo-terminal of a simulator, which can be unplugged and plugged in again.

#include <CLI/CLI.hpp>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <stdlib.h>
#include <string>
#include <termios.h>
#include <unistd.h>

namespace palpa::devices::simulators {

struct Terminal {
    int master = -1;
    int slave = -1;  // stays open, so that readers may come and go
    std::string path;
};

inline void unplug(Terminal& terminal) {
    ::close(terminal.slave);
    ::close(terminal.master);
    terminal = {};
}

// Adds --link, whose folder must be there.
inline void add_link_option(CLI::App& app, std::string& link) {
    const auto is_in_folder = [](const std::string& path) {
        const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
        return std::filesystem::is_directory(folder) ? std::string() : folder.string() + ": is no folder";
    };
    app.add_option("--link", link, "symbolic link to the terminal")->check(CLI::Validator(is_in_folder, ""));
}

// `link`: a symbolic link to it, or "". Without success `master` is -1, and errno says why.
inline Terminal plug_in(const std::string& link) {
    Terminal terminal;
    terminal.master = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (terminal.master < 0 || ::grantpt(terminal.master) != 0 || ::unlockpt(terminal.master) != 0) return {};
    terminal.path = ::ptsname(terminal.master);
    terminal.slave = ::open(terminal.path.c_str(), O_RDWR | O_NOCTTY);
    termios settings{};
    ::tcgetattr(terminal.slave, &settings);
    ::cfmakeraw(&settings);
    ::tcsetattr(terminal.slave, TCSANOW, &settings);
    if (link.empty()) return terminal;
    std::error_code failed;
    std::filesystem::remove(link, failed);
    std::filesystem::create_symlink(terminal.path, link, failed);
    if (!failed) return terminal;
    unplug(terminal);
    errno = failed.value();
    return terminal;
}

}  // namespace palpa::devices::simulators
