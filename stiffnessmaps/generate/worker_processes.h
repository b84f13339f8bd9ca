#pragma once
// The program calls itself: a list of calls, so many at a time. A solver that is not thread-safe (MUMPS) gets
// its second core this way, and memory is given back as each call ends.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpa::stiffnessmaps {

using Arguments = std::vector<std::string>;

// `meanwhile` is called some five times a second. Throws std::runtime_error when a call fails, after the others
// that run have ended; the failed call has said why on stderr. Children end with their parent (Linux).
void run_jobs(const std::vector<Arguments>& calls, int at_a_time, const std::function<void()>& meanwhile);

// Held until destroyed; other processes wait, or pass by with `wait` false. Where the file system has no locks,
// everybody gets it.
class FolderLock {
  public:
    FolderLock(const std::filesystem::path& file, bool wait);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    bool held() const { return held_; }

  private:
    int fd_ = -1;
    bool held_ = true;
};

}  // namespace palpa::stiffnessmaps
