#pragma once
// A file that only grows. Data of people are never lost: created only if it does not exist, appended to,
// synced on request (file and folder).

#include <filesystem>
#include <string>
#include <string_view>

namespace palpa::files {

class AppendFile {
  public:
    // Creates the file; throws std::runtime_error if it exists already or cannot be created.
    explicit AppendFile(const std::filesystem::path& path);
    ~AppendFile();
    AppendFile(const AppendFile&) = delete;
    AppendFile& operator=(const AppendFile&) = delete;

    // Buffers up to 64 KiB, so that a row costs no system call. The buffer never grows beyond its reserve.
    void append(std::string_view text);

    // Hands the buffer to the system. Returns false once anything could not be written (disk full).
    bool flush();

    // flush() and wait until it is on the disk, the folder's entry included.
    bool sync();

    bool failed() const { return failed_; }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    int fd_ = -1;
    std::string buffer_;
    bool failed_ = false;
};

// Whole lines at the end of a file that may be there already; after a line that was cut off a new one begins. On the
// disk when it returns. Throws std::runtime_error.
void append_synced(const std::filesystem::path& path, std::string_view text);

}  // namespace palpa::files
