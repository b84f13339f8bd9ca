#include "files/folder_lock.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <sys/file.h>
#include <unistd.h>

#include "files/input_error.h"

namespace palpa::files {

FolderLock::FolderLock(const std::filesystem::path& folder) {
    fd_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd_ < 0) throw std::runtime_error(folder.string() + ": cannot be opened: " + std::strerror(errno));
    if (::flock(fd_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(fd_);
    throw bad_input(folder.string(), "", "another palpa that writes into this folder",
                    "one program at a time: end the other first, or take another folder");
}

FolderLock::~FolderLock() { ::close(fd_); }

}  // namespace palpa::files
