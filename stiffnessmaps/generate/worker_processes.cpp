#include "stiffnessmaps/generate/worker_processes.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <signal.h>
#include <stdexcept>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "mechanics/blas_memory.h"

namespace palpa::stiffnessmaps {
namespace {

pid_t start(const Arguments& arguments) {
    std::vector<char*> argv;
    std::string program = "/proc/self/exe";
    std::vector<std::string> copy = arguments;  // exec needs writable strings
    argv.push_back(program.data());
    for (std::string& argument : copy) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error(std::string("cannot start a job: ") + std::strerror(errno));
    if (child > 0) return child;
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(1);  // the parent ended before the line above
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
}

}  // namespace

void run_jobs(const std::vector<Arguments>& calls, int at_a_time, const std::function<void()>& meanwhile) {
    // the jobs need it too, and without it a fork would wait for a thread of OpenBLAS for ever
    mechanics::require_blas_memory();
    std::size_t next = 0;
    std::vector<pid_t> running;
    bool failed = false;
    while (!running.empty() || (next < calls.size() && !failed)) {
        while (!failed && next < calls.size() && running.size() < static_cast<std::size_t>(at_a_time)) {
            running.push_back(start(calls[next++]));
        }
        for (std::size_t i = 0; i < running.size();) {
            int status = 0;
            const pid_t ended = ::waitpid(running[i], &status, WNOHANG);
            if (ended == 0) {
                ++i;
                continue;
            }
            failed = failed || ended < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0;
            running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
        }
        meanwhile();
        if (!running.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    if (failed)
        throw std::runtime_error("a job failed; what is finished is kept, and the same command goes on from there");
}

FileLock::FileLock(const std::filesystem::path& file, bool wait) {
    fd_ = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (fd_ < 0) return;
    if (::flock(fd_, LOCK_EX | (wait ? 0 : LOCK_NB)) != 0) held_ = errno != EWOULDBLOCK;
}

FileLock::~FileLock() {
    if (fd_ >= 0) ::close(fd_);
}

}  // namespace palpa::stiffnessmaps
