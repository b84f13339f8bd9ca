#pragma once
// Files of a folder as a web server hands them out: from a request's path to an open file, and nothing outside.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::desk {

// The names in the path of a request ("/a/b%20c?x" gives a, "b c"); what ends with '/' gets index.html. Nothing for
// a path that is not plain: not from '/', bad or forbidden escapes (NUL, other control characters, '/', '\'), empty
// names, names that begin with a dot (so no `..`), what is not UTF-8 or longer than 1024 bytes.
std::optional<std::vector<std::string>> names_of_path(std::string_view target);

// A regular file, open for reading.
class StaticFile {
  public:
    StaticFile() = default;
    StaticFile(int fd, std::uint64_t bytes, std::string etag) : fd_(fd), bytes_(bytes), etag_(std::move(etag)) {}
    ~StaticFile();
    StaticFile(StaticFile&& other) noexcept;
    StaticFile& operator=(StaticFile&& other) noexcept;

    bool is_open() const { return fd_ >= 0; }
    std::uint64_t bytes() const { return bytes_; }
    // Changes whenever the file does: made of size, time of change and inode.
    const std::string& etag() const { return etag_; }
    // Up to `size` bytes from `offset` on; 0 at the end, -1 if it cannot be read.
    long read(std::uint64_t offset, char* out, std::size_t size) const;

  private:
    int fd_ = -1;
    std::uint64_t bytes_ = 0;
    std::string etag_;
};

// Not open if there is no such regular file. Links are not followed, at no place of the way below `folder`.
StaticFile open_static(const std::filesystem::path& folder, const std::vector<std::string>& names);

// By the name's ending: "application/wasm"; "application/octet-stream" for unknown ones.
std::string mime_type(std::string_view name);

}  // namespace palpa::desk
