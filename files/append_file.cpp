#include "files/append_file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <unistd.h>

#include "files/pieces.h"
#include "files/text.h"

namespace palpa::files {
namespace {

constexpr std::size_t kBuffer_bytes = 64 * 1024;

// A new file survives a power cut only once the entry in its folder is on the disk too.
bool sync_folder_of(const std::filesystem::path& path) {
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return false;
    const bool synced = ::fsync(fd) == 0;
    ::close(fd);
    return synced;
}

}  // namespace

AppendFile::AppendFile(const std::filesystem::path& path) : path_(path) {
    fd_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
    if (fd_ < 0) {
        throw std::runtime_error(path.string() + ": cannot be created: " + std::strerror(errno));
    }
    buffer_.reserve(kBuffer_bytes);
}

AppendFile::~AppendFile() {
    flush();
    ::close(fd_);
}

void AppendFile::append(std::string_view text) {
    if (buffer_.size() + text.size() > kBuffer_bytes) flush();
    buffer_.append(text);
}

bool AppendFile::flush() {
    if (!failed_ && !write_all(fd_, buffer_)) failed_ = true;
    buffer_.clear();
    return !failed_;
}

bool AppendFile::sync() {
    if (!flush()) return false;
    if (::fsync(fd_) != 0 || !sync_folder_of(path_)) failed_ = true;
    return !failed_;
}

void append_synced(const std::filesystem::path& path, std::string_view text, std::string_view end_of_cut_line) {
    const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (fd < 0) fail_writing(path);
    char last = '\n';
    const off_t size = ::lseek(fd, 0, SEEK_END);
    std::string whole(text);
    if (size > 0 && ::pread(fd, &last, 1, size - 1) == 1 && last != '\n')
        whole = std::string(end_of_cut_line) + "\n" + whole;
    const bool good = write_all(fd, whole) && ::fsync(fd) == 0;
    const int error = errno;
    // on a full disk the file stays as it was, so that a part of a line never counts
    if (!good && (size == 0 ? ::unlink(path.c_str()) : ::ftruncate(fd, size)) == 0) ::fsync(fd);
    ::close(fd);
    errno = error;
    if (!good || !sync_folder_of(path)) fail_writing(path);
}

}  // namespace palpa::files
