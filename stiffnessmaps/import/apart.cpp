#include "stiffnessmaps/import/apart.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <signal.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "files/input_error.h"

namespace palpa {
namespace {

constexpr rlim_t kMost_s = 60;
constexpr rlim_t kMost_bytes = rlim_t{4} << 30;
// AddressSanitizer does, as GCC and as clang tell of it
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kReservesTerabytes = true;
#elif defined(__has_feature)
constexpr bool kReservesTerabytes = __has_feature(address_sanitizer);
#else
constexpr bool kReservesTerabytes = false;
#endif

// What the process says: one of these, then an array in .npy form or a message.
constexpr char kArray = 'a';
constexpr char kRefused = 'r';

void limit(int resource, rlim_t value) {
    rlimit now{};
    if (::getrlimit(static_cast<__rlimit_resource>(resource), &now) != 0) return;
    if (now.rlim_max != RLIM_INFINITY && now.rlim_max < value) return;
    now.rlim_cur = value;
    ::setrlimit(static_cast<__rlimit_resource>(resource), &now);
}

void say(int fd, std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = ::write(fd, text.data(), text.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(n));
    }
}

[[noreturn]] void run_child(int fd, const std::function<NpyArray()>& read) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGPIPE}) ::signal(signal, SIG_DFL);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, kMost_s);
    if (!kReservesTerabytes) limit(RLIMIT_AS, kMost_bytes);
    std::string said;
    try {
        said = kArray + npy_bytes(read());
    } catch (const InputError& error) {
        said = kRefused + std::string(error.what());
    } catch (const std::bad_alloc&) {
        said.clear();
    } catch (const std::exception& error) {
        said = kRefused + std::string(error.what());
    }
    say(fd, said);
    ::_exit(0);
}

std::string hear(int fd) {
    std::string said;
    std::array<char, 1 << 16> buffer;
    while (true) {
        const ssize_t n = ::read(fd, buffer.data(), buffer.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return said;
        said.append(buffer.data(), static_cast<std::size_t>(n));
    }
}

}  // namespace

NpyArray read_apart(const std::string& file, const char* library, const std::function<NpyArray()>& read) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
    const pid_t child = ::fork();
    if (child < 0) {
        ::close(ends[0]);
        ::close(ends[1]);
        throw std::runtime_error(std::string("no new process: ") + std::strerror(errno));
    }
    if (child == 0) {
        ::close(ends[0]);
        run_child(ends[1], read);
    }
    ::close(ends[1]);
    std::string said = hear(ends[0]);
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || said.empty()) {
        const bool slow = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
        throw bad_input(file, "",
                        slow ? "over a minute of work for " + std::string(library)
                             : "what " + std::string(library) + " cannot read without failing",
                        "a whole file of moderate size");
    }
    if (said.front() == kRefused) throw InputError(said.substr(1));
    return parse_npy(std::string_view(said).substr(1), file);
}

}  // namespace palpa
