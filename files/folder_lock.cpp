#include "files/folder_lock.h"

#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <sys/file.h>
#include <thread>
#include <unistd.h>

#include "files/input_error.h"

namespace palpa::files {
namespace {

int open_folder(const std::filesystem::path& folder) {
    return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

bool lock(int fd, int kind) { return ::flock(fd, kind | LOCK_NB) == 0; }

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : fd_(open_folder(folder)) {
    if (fd_ < 0) return;
    for (int i = 0; i < 10; ++i) {  // is_folder_locked() has it for microseconds
        held_ = lock(fd_, LOCK_EX);
        held_elsewhere_ = !held_ && errno == EWOULDBLOCK;
        if (!held_elsewhere_) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& other) : FolderLock(folder) {
    if (held_elsewhere_) throw bad_input(folder.string(), "", other, "a folder of its own for each");
}

FolderLock::~FolderLock() {
    if (fd_ >= 0) ::close(fd_);
}

bool is_folder_locked(const std::filesystem::path& folder) {
    const int fd = open_folder(folder);
    if (fd < 0) return false;
    const bool locked = !lock(fd, LOCK_SH) && errno == EWOULDBLOCK;
    ::close(fd);
    return locked;
}

}  // namespace palpa::files
