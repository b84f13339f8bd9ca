#include "files/text.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <unistd.h>

#include "files/input_error.h"
#include "files/pieces.h"
#include "files/regular_file.h"

namespace palpa::files {

std::string read_text(const std::filesystem::path& path, std::size_t limit_bytes) {
    const InputFile file(path);
    std::string text;
    // memory is reserved for the file's size, if that is known: growing would take three times the memory
    if (file.bytes() <= limit_bytes) text.reserve(file.bytes() + 1);
    std::array<char, 1 << 16> buffer;
    while (const std::size_t n = file.read_at(text.size(), buffer.data(), buffer.size())) {
        text.append(buffer.data(), n);
        if (text.size() > limit_bytes) {
            throw bad_input(path.string(), "", "more than " + std::to_string(limit_bytes) + " bytes", "less");
        }
    }
    return text;
}

bool write_all(int fd, std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = ::write(fd, text.data(), text.size());
        if (n > 0) text.remove_prefix(static_cast<std::size_t>(n));
        if (n == 0 || (n < 0 && errno != EINTR)) return false;
    }
    return true;
}

namespace {

using Pieces = std::initializer_list<std::string_view>;

// Opens a file that has no name until give_name(): what a killed run wrote goes with the run. -1 where there is no such file.
int open_unnamed([[maybe_unused]] const std::filesystem::path& folder) {
#if defined(O_TMPFILE) && !defined(__EMSCRIPTEN__)
    if (::access("/proc/self/fd", X_OK) == 0)
        return ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0644);
#endif
    return -1;
}

bool give_name(int fd, const std::filesystem::path& path) {
    const std::string now = "/proc/self/fd/" + std::to_string(fd);
    return ::linkat(AT_FDCWD, now.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

// Returns false with errno set; then there is no file `path`.
bool write_new(const std::filesystem::path& path, Pieces pieces, bool sync) {
    ::unlink(path.c_str());  // left by a killed run, or a FIFO that somebody put there
    int fd = open_unnamed(path.parent_path());
    const bool unnamed = fd >= 0;
    if (!unnamed) fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (fd < 0) return false;
    const auto write = [&](std::string_view text) { return write_all(fd, text); };
    const bool written = std::all_of(pieces.begin(), pieces.end(), write);
    const bool whole = written && (!sync || ::fsync(fd) == 0) && (!unnamed || give_name(fd, path));
    int reason = errno;
    const bool closed = ::close(fd) == 0;
    if (whole && closed) return true;
    if (whole) reason = errno;
    ::unlink(path.c_str());
    errno = reason;
    return false;
}

void write_and_rename(const std::filesystem::path& name, Pieces pieces, bool sync) {
    const std::filesystem::path path = output_target(name);
    std::filesystem::path aside = path;
    aside += ".part-" + std::to_string(::getpid());
    if (!write_new(aside, pieces, sync)) fail_writing(path);
    if (::rename(aside.c_str(), path.c_str()) != 0) {
        const int reason = errno;
        ::unlink(aside.c_str());
        errno = reason;
        fail_writing(path);
    }
}

}  // namespace

void fail_writing(const std::filesystem::path& path) {
    throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(errno));
}

void write_text_atomically(const std::filesystem::path& path, std::string_view text) {
    write_and_rename(path, {text}, true);
}

void write_pieces_atomically(const std::filesystem::path& path, Pieces pieces) { write_and_rename(path, pieces, true); }

void write_text_whole(const std::filesystem::path& path, std::string_view text) {
    write_and_rename(path, {text}, false);
}

void sync_file(const std::filesystem::path& path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) fail_writing(path);
    const bool synced = ::fsync(fd) == 0;
    ::close(fd);
    if (!synced) fail_writing(path);
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
    std::vector<std::string_view> out;
    while (true) {
        const auto end = line.find(separator);
        out.push_back(line.substr(0, end));
        if (end == std::string_view::npos) return out;
        line.remove_prefix(end + 1);
    }
}

std::string number_text(double value) {
    std::string out;
    append_number(value, out);
    return out;
}

std::string short_number(double value) {
    std::array<char, 32> buffer;
    std::snprintf(buffer.data(), buffer.size(), "%.4g", value);
    return buffer.data();
}

std::string counted(std::int64_t n, const char* noun) { return std::to_string(n) + " " + noun + (n == 1 ? "" : "s"); }

}  // namespace palpa::files
