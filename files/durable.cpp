#include "files/durable.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <stdio.h>
#include <string>
#include <unistd.h>

#include "files/text.h"

namespace palpa::files {
void sync_folder(const std::filesystem::path& folder) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool synced = fd >= 0 && ::fsync(fd) == 0;
    if (fd >= 0) ::close(fd);
    if (!synced) fail_writing(folder);
}

bool rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
    if (errno == EEXIST) return false;
    // file systems without this kind of renaming have hard links
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

}  // namespace palpa::files
