#pragma once
// Runs calls of this program as processes of their own, several at a time. A solver that is not thread-safe (MUMPS)
// uses a second core this way, and the memory of a call is freed when it ends.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpa::stiffnessmaps {

using Arguments = std::vector<std::string>;

// Runs all calls, `at_a_time` at once; `meanwhile` is called about ten times a second. If a call fails, no further one
// starts, and std::runtime_error is thrown once the running ones have ended; the failed call has reported why on
// stderr. Children end with their parent (Linux).
void run_jobs(const std::vector<Arguments>& calls, int at_a_time, const std::function<void()>& meanwhile);

// A lock on a file, held until destroyed. Another process waits for it or, with `wait` false, does not get it. Where
// the file system has no locks, every process gets it.
class FileLock {
  public:
    FileLock(const std::filesystem::path& file, bool wait);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;
    bool held() const { return held_; }

  private:
    int fd_ = -1;
    bool held_ = true;
};

}  // namespace palpa::stiffnessmaps
