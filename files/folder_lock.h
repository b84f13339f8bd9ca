#pragma once
// A lock on a folder, so that two programs do not write their results into one at the same time. The system frees it when
// the program ends, however it ends.

#include <filesystem>

namespace palpa::files {

class FolderLock {
  public:
    // Takes the lock without waiting. Throws InputError if another FolderLock, of this or of another program, holds it,
    // std::runtime_error if the folder cannot be opened. Where the file system has no locks, and in a browser, whose files
    // belong to one page, everybody gets it.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int fd_ = -1;
};

}  // namespace palpa::files
