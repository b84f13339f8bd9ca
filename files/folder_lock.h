#pragma once
// Keeps a folder for one process, where two would replace each other's files.

#include <filesystem>
#include <string>

namespace palpa::files {

// The folder is kept until this is destroyed or the process ends.
class FolderLock {
  public:
    // `other` names who else may have the folder: "another palpa serve that collects here". Throws InputError if it has,
    // std::runtime_error if the folder cannot be locked.
    FolderLock(const std::filesystem::path& folder, const std::string& other);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int fd_ = -1;
};

}  // namespace palpa::files
