#pragma once
// Files of a folder as a web server hands them out: from the path of a request to an open file, never outside the folder.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::desk {

// Returns the names in the path of a request ("/a/b%20c?x" gives a, "b c"); a path that ends with '/' gets index.html.
// Returns nothing for a path that does not begin with '/', has bad or forbidden escapes (NUL, other control characters,
// '/', '\'), empty names or names that begin with a dot (so no `..`), is not UTF-8, or is longer than 1024 bytes.
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
    // An ETag that changes whenever the file does, made of its size, time of change and inode.
    const std::string& etag() const { return etag_; }
    // Reads up to `size` bytes from `offset` on. Returns 0 at the end, -1 if the file cannot be read.
    long read(std::uint64_t offset, char* out, std::size_t size) const;

  private:
    int fd_ = -1;
    std::uint64_t bytes_ = 0;
    std::string etag_;
};

// Returns a file that is not open if there is no such regular file. Links below `folder` are not followed.
StaticFile open_static(const std::filesystem::path& folder, const std::vector<std::string>& names);

// Returns the media type by the ending of the name, such as "application/wasm"; "application/octet-stream" if unknown.
std::string mime_type(std::string_view name);

}  // namespace palpa::desk
