#include "devices/simulators/process.h"

#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <signal.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace palpa::devices::simulators {
namespace {

namespace fs = std::filesystem;

// Between fork and exec only what a signal handler may call.
[[noreturn]] void become(const char* program, char* const* argv, int out, bool outlives, pid_t parent) {
    ::setpgid(0, 0);  // Ctrl-C at the terminal is for the program, which ends its simulators after it
    if (!outlives) {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent) ::_exit(127);  // it has ended in between
    }
    ::dup2(out, STDOUT_FILENO);
    ::execv(program, argv);
    ::_exit(127);
}

}  // namespace

SimulatorProcess::SimulatorProcess(const std::string& program, std::vector<std::string> arguments, bool outlives) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(program + ": no pipe to it");
    arguments.insert(arguments.begin(), program);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0) become(program.c_str(), argv.data(), ends[1], outlives, parent);
    ::close(ends[1]);
    out_ = ::fdopen(ends[0], "r");
    const std::string first = line();
    if (first.rfind("port ", 0) != 0) {
        end();
        std::fclose(out_);
        throw std::runtime_error(program + ": found '" + first + "', expected the line of its port");
    }
    port_ = first.substr(5);
}

SimulatorProcess::~SimulatorProcess() {
    end();
    std::fclose(out_);
}

std::string SimulatorProcess::line() {
    std::string text;
    for (int c = std::fgetc(out_); c != EOF && c != '\n'; c = std::fgetc(out_)) text.push_back(static_cast<char>(c));
    return text;
}

void SimulatorProcess::end() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGCONT);  // one that was halted would never end
    ::kill(pid_, SIGTERM);
    constexpr int kTries = 500;
    int tries = 0;
    while (::waitpid(pid_, nullptr, WNOHANG) == 0) {
        if (++tries == kTries) ::kill(pid_, SIGKILL);  // after five seconds it hangs
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    pid_ = -1;
}

std::string simulator_program(const std::string& name) {
    const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
    std::string tried;
    for (const fs::path& place : {folder / "devices", folder / "../libexec/palpa", folder}) {
        const fs::path program = place / name;
        if (::access(program.c_str(), X_OK) == 0) return program.string();
        tried += (tried.empty() ? "" : ", ") + place.string();
    }
    throw std::runtime_error(name + ": found no such program in " + tried);
}

}  // namespace palpa::devices::simulators
