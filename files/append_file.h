#pragma once
// A file that only grows, so that participants' data are never lost: it is created only if it does not exist yet, only
// appended to, and synced on request (file and folder).

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

    // Appends to a buffer of 64 KiB, which is flushed when it is full, so that a row seldom costs a system call. The
    // buffer allocates nothing for rows up to its size.
    void append(std::string_view text);

    // Hands the buffer to the system. Returns false once anything could not be written (disk full).
    bool flush();

    // Flushes, and waits until the file and the entry in its folder are on the disk. Returns false as flush() does.
    bool sync();

    // True once anything could not be written or synced.
    bool failed() const { return failed_; }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    int fd_ = -1;
    std::string buffer_;
    bool failed_ = false;
};

// Appends whole lines to a file that may exist already; if the file's last line was cut off, the text begins on a new
// line, and `end_of_cut_line` comes before that. The text is on the disk when the function returns. Throws
// std::runtime_error with the system's reason; the file is then as it was.
void append_synced(const std::filesystem::path& path, std::string_view text, std::string_view end_of_cut_line = "");

}  // namespace palpa::files
