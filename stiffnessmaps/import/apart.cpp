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
#include "stiffnessmaps/import/arrays.h"

namespace palpa::stiffnessmaps {
namespace {

constexpr rlim_t kMost_s = 60;
constexpr rlim_t kMost_bytes = rlim_t{4} << 30;
// true with AddressSanitizer, which GCC and clang announce in different ways
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kReservesTerabytes = true;
#elif defined(__has_feature)
constexpr bool kReservesTerabytes = __has_feature(address_sanitizer);
#else
constexpr bool kReservesTerabytes = false;
#endif

// What the child process writes first; then follows an array (number of axes, length of each, numbers) or a message.
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

template <class Value>
std::string_view bytes_of(const std::vector<Value>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

void say_array(int fd, const files::NpyArray& array) {
    std::vector<std::uint64_t> axes{array.shape.size()};
    axes.insert(axes.end(), array.shape.begin(), array.shape.end());
    say(fd, std::string(1, kArray));
    say(fd, bytes_of(axes));
    say(fd, bytes_of(array.values));
}

[[noreturn]] void run_child(int fd, const std::function<files::NpyArray()>& read) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGPIPE}) ::signal(signal, SIG_DFL);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, kMost_s);
    if (!kReservesTerabytes) limit(RLIMIT_AS, kMost_bytes);
    std::string said;
    try {
        const files::NpyArray array = read();  // what the library allocated is freed by now
        say_array(fd, array);
    } catch (const files::InputError& error) {
        said = kRefused + std::string(error.what());
    } catch (const std::bad_alloc&) {
        said.clear();
    } catch (const std::exception& error) {
        said = kRefused + std::string(error.what());
    }
    say(fd, said);
    ::_exit(0);
}

// Reads up to n bytes, fewer if the other end closes.
std::size_t hear(int fd, char* to, std::size_t n) {
    std::size_t heard = 0;
    while (heard < n) {
        const ssize_t some = ::read(fd, to + heard, n - heard);
        if (some < 0 && errno == EINTR) continue;
        if (some <= 0) break;
        heard += static_cast<std::size_t>(some);
    }
    return heard;
}

// Returns whether a whole array arrived. Never allocates more than the largest array needs.
bool hear_array(int fd, files::NpyArray& array) {
    const auto hear_all = [&](auto* to, std::size_t n) {
        return hear(fd, reinterpret_cast<char*>(to), n * sizeof(*to)) == n * sizeof(*to);
    };
    std::uint64_t n_axes = 0;
    if (!hear_all(&n_axes, 1) || n_axes > 8) return false;
    std::vector<std::uint64_t> axes(n_axes);
    if (!hear_all(axes.data(), n_axes)) return false;
    double n = 1.0;
    for (const std::uint64_t axis : axes) n *= static_cast<double>(axis);
    if (n > static_cast<double>(kMostNumbers)) return false;
    array.shape.assign(axes.begin(), axes.end());
    array.values.resize(static_cast<std::size_t>(n));
    return hear_all(array.values.data(), array.values.size());
}

std::string hear_message(int fd) {
    std::string said;
    std::array<char, 4096> buffer;
    while (const std::size_t n = hear(fd, buffer.data(), buffer.size())) said.append(buffer.data(), n);
    return said;
}

}  // namespace

files::NpyArray read_apart(const std::string& file, const char* library, const std::function<files::NpyArray()>& read) {
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
    char kind = '\0';
    files::NpyArray array;
    std::string refused;
    bool whole = hear(ends[0], &kind, 1) == 1;
    if (kind == kArray) whole = hear_array(ends[0], array);
    if (kind == kRefused) refused = hear_message(ends[0]);
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !whole) {
        const bool slow = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
        throw files::bad_input(file, "",
                               slow ? "over a minute of work for " + std::string(library)
                                    : "what " + std::string(library) + " cannot read without failing",
                               "a whole file of moderate size");
    }
    if (kind == kRefused) throw files::InputError(refused);
    return array;
}

}  // namespace palpa::stiffnessmaps
