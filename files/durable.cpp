#include "files/durable.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "files/text.h"

namespace palpa {
namespace {

[[noreturn]] void fail_writing(const std::filesystem::path& path) {
    throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

void append_synced(const std::filesystem::path& path, std::string_view text) {
    const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (fd < 0) fail_writing(path);
    char last = '\n';
    const off_t size = ::lseek(fd, 0, SEEK_END);
    std::string whole(text);
    if (size > 0 && ::pread(fd, &last, 1, size - 1) == 1 && last != '\n') whole.insert(0, "\n");
    std::string_view rest = whole;
    while (!rest.empty()) {
        const ssize_t n = ::write(fd, rest.data(), rest.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) {
            const int reason = errno;
            ::close(fd);
            errno = reason;
            fail_writing(path);
        }
        rest.remove_prefix(static_cast<std::size_t>(n));
    }
    const bool synced = ::fsync(fd) == 0;
    ::close(fd);
    if (!synced) fail_writing(path);
    if (size == 0) sync_folder(path.has_parent_path() ? path.parent_path() : std::filesystem::path("."));
}

void sync_folder(const std::filesystem::path& folder) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool synced = fd >= 0 && ::fsync(fd) == 0;
    if (fd >= 0) ::close(fd);
    if (!synced) fail_writing(folder);
}

bool rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
    if (errno == EEXIST) return false;
    // file systems that do not know this kind of renaming know hard links
    if (errno != EINVAL && errno != ENOSYS) fail_writing(to);
    if (::link(from.c_str(), to.c_str()) != 0) {
        if (errno == EEXIST) return false;
        fail_writing(to);
    }
    ::unlink(from.c_str());
    return true;
}

bool write_new_text(const std::filesystem::path& path, std::string_view text) {
    std::filesystem::path aside = path;
    aside += ".part-" + std::to_string(::getpid());
    write_text_atomically(aside, text);
    try {
        if (rename_to_new(aside, path)) return true;
    } catch (...) {
        ::unlink(aside.c_str());
        throw;
    }
    ::unlink(aside.c_str());
    return false;
}

}  // namespace palpa
