#include "files/append_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace palpa {
namespace {

constexpr std::size_t kBuffer_bytes = 64 * 1024;

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
    std::string_view rest = buffer_;
    while (!rest.empty() && !failed_) {
        const ssize_t n = ::write(fd_, rest.data(), rest.size());
        if (n > 0) {
            rest.remove_prefix(static_cast<std::size_t>(n));
        } else if (n < 0 && errno != EINTR) {
            failed_ = true;
        }
    }
    buffer_.clear();
    return !failed_;
}

bool AppendFile::sync() {
    if (!flush()) return false;
    if (::fsync(fd_) != 0) failed_ = true;
    const auto folder = path_.has_parent_path() ? path_.parent_path() : std::filesystem::path(".");
    const int folder_fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder_fd < 0 || ::fsync(folder_fd) != 0) failed_ = true;
    if (folder_fd >= 0) ::close(folder_fd);
    return !failed_;
}

}  // namespace palpa
