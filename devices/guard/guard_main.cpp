// palpa_guard: started by Palpa, for as long as it drives devices (devices/guard_process.h).

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include "devices/guard/rig_server.h"
#include "devices/guard/shape_server.h"
#include "devices/guard_link.h"
#include "files/json.h"

using namespace palpa;

namespace {

volatile int g_ended = 0;

void serve(const std::string& start, int socket) {
    const files::Json json = files::parse_json(start, "wires");
    files::JsonReader reader(json, "wires");
    reader.only({"kind", "rig", "shape"});
    if (reader.choice("kind", {"rig", "shape"}) == 1)
        return devices::guard::serve_shape(devices::read_shape_rig(reader.object("shape")), socket, g_ended);
    devices::guard::serve_rig(devices::read_rig(reader.object("rig")), socket, g_ended);
}

}  // namespace

int main(int argc, char** argv) {
    const int socket = argc == 2 ? std::atoi(argv[1]) : -1;
    std::vector<char> start(1 << 16);
    const ssize_t n = socket > 2 ? ::recv(socket, start.data(), start.size(), 0) : -1;
    if (n <= 0) {
        std::fprintf(stderr, "palpa_guard: Palpa starts it, for as long as it drives devices; it is of no use alone\n");
        return 2;
    }
    // what the program left open is not the guard's
    if (socket > 3) ::close_range(3, static_cast<unsigned>(socket - 1), 0);
    ::close_range(static_cast<unsigned>(socket + 1), ~0u, 0);
    ::prctl(PR_SET_TIMERSLACK, 1000UL);  // ns
    std::signal(SIGINT, SIG_IGN);
    for (const int end : {SIGTERM, SIGHUP}) std::signal(end, [](int) { g_ended = 1; });
    try {
        serve(std::string(start.data(), static_cast<std::size_t>(n)), socket);
    } catch (const std::exception& error) {
        const std::string refusal = std::string(1, devices::kGuardRefusal) + error.what();
        static_cast<void>(::send(socket, refusal.data(), refusal.size(), MSG_NOSIGNAL));
        return 1;
    }
    return 0;
}
