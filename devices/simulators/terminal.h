#pragma once
// A pseudo-terminal of a simulator, which can be unplugged and plugged in again.

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

// `link`: a symbolic link to it, or "". Without success `master` is -1.
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
    if (!link.empty()) {
        std::filesystem::remove(link);
        std::filesystem::create_symlink(terminal.path, link);
    }
    return terminal;
}

inline void unplug(Terminal& terminal) {
    ::close(terminal.slave);
    ::close(terminal.master);
    terminal = {};
}

}  // namespace palpa::devices::simulators
