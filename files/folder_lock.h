#pragma once
// A folder that only one program works in at a time. The lock is the system's: it goes with the program that holds it,
// however that ends, and leaves no file behind.

#include <filesystem>
#include <string>

namespace palpa::files {

class FolderLock {
  public:
    // Takes the lock if nobody has it. Waits for nobody but a look of is_folder_locked().
    explicit FolderLock(const std::filesystem::path& folder);
    // Throws InputError if somebody has it. `other` says who that may be: "another palpa serve that collects here".
    FolderLock(const std::filesystem::path& folder, const std::string& other);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    // Where the file system has no locks, neither is true.
    bool held() const { return held_; }
    bool held_elsewhere() const { return held_elsewhere_; }  // by another FolderLock, of this program or another one

  private:
    int fd_ = -1;
    bool held_ = false;
    bool held_elsewhere_ = false;
};

// True while a FolderLock holds the folder. Changes nothing.
bool is_folder_locked(const std::filesystem::path& folder);

}  // namespace palpa::files
