#include "devices/guard_process.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <signal.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "devices/line_io.h"

namespace palpa::devices {
namespace {

namespace fs = std::filesystem;

// Between fork and exec only what a signal handler may call.
[[noreturn]] void become_guard(const char* program, char* const* argv, int socket) {
    ::setpgid(0, 0);  // Ctrl-C at the terminal is for the program; the guard outlives it to relax
    ::fcntl(socket, F_SETFD, 0);
    ::execv(program, argv);
    ::_exit(127);
}

}  // namespace

std::string guard_program() {
    const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
    std::string tried;
    // the last two: programs of tests in a build folder
    for (const fs::path& place :
         {folder / "devices", folder / "../libexec/palpa", folder, folder / "../devices", folder / "../../devices"}) {
        const fs::path program = place / "palpa_guard";
        if (::access(program.c_str(), X_OK) == 0) return program.string();
        tried += (tried.empty() ? "" : ", ") + place.string();
    }
    throw std::runtime_error("palpa_guard: found no such program in " + tried);
}

GuardLink::GuardLink(const std::string& program, const std::string& start) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        throw std::runtime_error(program + ": no sockets to it: " + std::strerror(errno));
    std::string name = program, number = std::to_string(ends[1]);
    std::array<char*, 3> argv{name.data(), number.data(), nullptr};
    pid_ = ::fork();
    if (pid_ == 0) become_guard(program.c_str(), argv.data(), ends[1]);
    ::close(ends[1]);
    socket_ = ends[0];
    if (pid_ < 0 || ::send(socket_, start.data(), start.size(), MSG_NOSIGNAL) < 0) {
        const std::string reason = std::strerror(errno);
        ::close(socket_);
        if (pid_ > 0) ::waitpid(pid_, nullptr, 0);
        throw std::runtime_error(program + ": cannot be started: " + reason);
    }
    wait_for_start(program);
}

void GuardLink::wait_for_start(const std::string& program) {
    std::array<char, 4096> bytes;
    pollfd waiting{socket_, POLLIN, 0};
    constexpr int kStart_ms = 10'000;
    const bool came = ::poll(&waiting, 1, kStart_ms) > 0;
    const ssize_t n = came ? ::recv(socket_, bytes.data(), bytes.size(), MSG_PEEK | MSG_DONTWAIT) : 0;
    if (n > 0 && bytes[0] != kGuardRefusal) return;
    ::close(socket_);
    if (n <= 0) ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    if (n > 0) throw std::runtime_error(std::string(bytes.data() + 1, static_cast<std::size_t>(n - 1)));
    throw std::runtime_error(program + ": the guard does not start");
}

GuardLink::~GuardLink() {
    ::close(socket_);
    constexpr int kPatience = 200;  // of 10 ms
    for (int i = 0; i < kPatience; ++i) {
        if (::waitpid(pid_, nullptr, WNOHANG) != 0) return;
        pause(0.01);
    }
}

void GuardLink::send(GuardWord word, std::span<const double> values) noexcept {
    GuardMessage message;
    message.word = word;
    message.values = static_cast<std::uint32_t>(std::min(values.size(), GuardMessage::kMostValues));
    std::copy_n(values.begin(), message.values, message.value);
    // a guard that takes nothing for 100 ms has relaxed everything
    static_cast<void>(::send(socket_, &message, size_of(message), MSG_DONTWAIT | MSG_NOSIGNAL));
}

int GuardLink::receive(void* bytes, std::size_t room) noexcept {
    const ssize_t n = ::recv(socket_, bytes, room, MSG_DONTWAIT);
    if (n > 0) return static_cast<int>(n);
    return n < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
}

GuardProcess::GuardProcess(const ActuatorRig& rig, const std::string& program)
    : rig_(rig), link_(program, files::Json{{"kind", "rig"}, {"rig", rig_json(rig)}}.dump()) {}

bool GuardProcess::poll(RigReport& out) noexcept {
    RigReport report;
    bool fresh = std::exchange(again_, false);
    int n = link_.receive(&report, sizeof report);
    for (; n > 0; n = link_.receive(&report, sizeof report)) {
        if (n != static_cast<int>(sizeof report)) continue;
        newest_ = report;
        fresh = true;
    }
    const double now_s = steady_s();
    if (fresh) reported_s_ = now_s;
    if (newest_.fault == Fault::none && reported_s_ > 0.0 && now_s - reported_s_ > kGuardSilence_s) {
        newest_.fault = Fault::guard_silent;
        fresh = true;
    }
    if (n < 0 && newest_.fault != Fault::guard_gone) {
        newest_.fault = Fault::guard_gone;
        newest_.driven = newest_.ready = false;
        fresh = true;
    }
    if (fresh) out = newest_;
    return fresh;
}

std::string trouble_of(const RigPort& port, const LineHealth& health) {
    const std::string where = "port '" + port.name + "' at " + port.path + ": ";
    switch (health.state) {
        case PinState::driving:
            return "";
        case PinState::proving:
            return where + "its devices are still being proved";
        case PinState::gone:
            return where + "it is unplugged";
        case PinState::no_answer:
            return where + "a device does not answer";
        case PinState::no_timeout:
            return where +
                   "a device would hold its force when Palpa is gone: its watchdog did not fire in 150 ms of silence";
        case PinState::no_crc:
            return where + "a board would take garbled targets";
        case PinState::faulty:
            return where + "a device answers by errors, or wrongly";
    }
    return where;
}

void GuardProcess::wait_until_ready(double most_s) {
    RigReport report;
    std::array<LineHealth, kMostPorts> told{};  // what a proof found, while the next one runs
    for (const double until_s = steady_s() + most_s; steady_s() < until_s; pause(0.002)) {
        poll(report);
        if (report.fault == Fault::guard_gone) throw std::runtime_error("the guard of the device has ended");
        if (report.ready) {
            again_ = true;
            return;
        }
        for (std::size_t i = 0; i < kMostPorts; ++i) {
            if (report.line[i].state != PinState::proving) told[i] = report.line[i];
        }
    }
    for (std::size_t i = 0; i < rig_.ports.size(); ++i) {
        const std::string trouble = trouble_of(rig_.ports[i], told[i]);
        if (!trouble.empty()) throw std::runtime_error(trouble);
    }
    throw std::runtime_error("nothing comes from the sensor of the displacement");
}

}  // namespace palpa::devices
