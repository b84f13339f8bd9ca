#include "files/folder_lock.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <sys/file.h>
#include <unistd.h>

#include "files/input_error.h"

namespace palpa::files {

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& other)
    : fd_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (fd_ >= 0 && ::flock(fd_, LOCK_EX | LOCK_NB) == 0) return;
    const int error = errno;
    if (fd_ >= 0) ::close(fd_);
    if (error == EWOULDBLOCK) throw bad_input(folder.string(), "", other, "a folder of its own for each");
    throw std::runtime_error(folder.string() + ": cannot be locked: " + std::strerror(error));
}

FolderLock::~FolderLock() { ::close(fd_); }

}  // namespace palpa::files
