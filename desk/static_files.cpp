#include "desk/static_files.h"

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "desk/request_head.h"

namespace palpa::desk {
namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// Decodes the escapes of one name. Returns false if the name is not allowed.
bool plain_name(std::string_view escaped, std::string& out) {
    out.clear();
    for (std::size_t i = 0; i < escaped.size(); ++i) {
        char c = escaped[i];
        if (c == '%') {
            const int high = i + 2 < escaped.size() ? hex_digit(escaped[i + 1]) : -1;
            const int low = i + 2 < escaped.size() ? hex_digit(escaped[i + 2]) : -1;
            if (high < 0 || low < 0) return false;
            c = static_cast<char>(16 * high + low);
            i += 2;
        }
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '/' || c == '\\') return false;
        out.push_back(c);
    }
    return !out.empty() && out.front() != '.';
}

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto first = static_cast<unsigned char>(text[i]);
        const std::size_t more = first < 0x80                    ? 0
                                 : first >= 0xc2 && first < 0xe0 ? 1
                                 : first >= 0xe0 && first < 0xf0 ? 2
                                 : first >= 0xf0 && first < 0xf5 ? 3
                                                                 : 9;
        if (i + more >= text.size()) return false;
        for (std::size_t k = 1; k <= more; ++k) {
            if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
        }
        i += more + 1;
    }
    return true;
}

}  // namespace

std::optional<std::vector<std::string>> names_of_path(std::string_view target) {
    target = target.substr(0, target.find_first_of("?#"));
    if (target.empty() || target.front() != '/' || target.size() > kLongestTarget) return std::nullopt;
    std::vector<std::string> names;
    std::string name;
    for (std::string_view rest = target.substr(1); !rest.empty();) {
        const auto end = rest.find('/');
        if (!plain_name(rest.substr(0, end), name) || !is_utf8(name)) return std::nullopt;
        names.push_back(name);
        rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    }
    if (target.back() == '/') names.push_back("index.html");
    return names;
}

StaticFile::~StaticFile() {
    if (fd_ >= 0) ::close(fd_);
}
StaticFile::StaticFile(StaticFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), bytes_(other.bytes_), etag_(std::move(other.etag_)) {}
StaticFile& StaticFile::operator=(StaticFile&& other) noexcept {
    std::swap(fd_, other.fd_);
    bytes_ = other.bytes_;
    etag_ = std::move(other.etag_);
    return *this;
}

long StaticFile::read(std::uint64_t offset, char* out, std::size_t size) const {
    while (true) {
        const ssize_t n = ::pread(fd_, out, size, static_cast<off_t>(offset));
        if (n >= 0 || errno != EINTR) return static_cast<long>(n);
    }
}

StaticFile open_static(const std::filesystem::path& folder, const std::vector<std::string>& names) {
    if (names.empty()) return {};
    // the folder itself may be a link, since its owner chose it
    int at = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (std::size_t i = 0; i < names.size() && at >= 0; ++i) {
        const bool last = i + 1 == names.size();
        // O_NONBLOCK: a named pipe must not hold the thread
        const int flags = O_RDONLY | O_NOFOLLOW | O_CLOEXEC | (last ? O_NONBLOCK | O_NOCTTY : O_DIRECTORY);
        const int next = ::openat(at, names[i].c_str(), flags);
        ::close(at);
        at = next;
    }
    if (at < 0) return {};
    struct stat status {};
    if (::fstat(at, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(at);
        return {};
    }
    const std::string etag = "\"" + std::to_string(status.st_size) + "-" + std::to_string(status.st_mtim.tv_sec) + "." +
                             std::to_string(status.st_mtim.tv_nsec) + "-" + std::to_string(status.st_ino) + "\"";
    return StaticFile(at, static_cast<std::uint64_t>(status.st_size), etag);
}

std::string mime_type(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, const char*>, 18> kTypes{{
        {"html", "text/html; charset=utf-8"},
        {"js", "text/javascript; charset=utf-8"},
        {"mjs", "text/javascript; charset=utf-8"},
        {"css", "text/css; charset=utf-8"},
        {"wasm", "application/wasm"},
        {"json", "application/json"},
        {"webmanifest", "application/manifest+json"},
        {"svg", "image/svg+xml"},
        {"png", "image/png"},
        {"jpg", "image/jpeg"},
        {"webp", "image/webp"},
        {"ico", "image/x-icon"},
        {"woff2", "font/woff2"},
        {"ttf", "font/ttf"},
        {"txt", "text/plain; charset=utf-8"},
        {"tsv", "text/tab-separated-values; charset=utf-8"},
        {"csv", "text/csv; charset=utf-8"},
        {"md", "text/markdown; charset=utf-8"},
    }};
    const auto dot = name.rfind('.');
    if (dot != std::string_view::npos) {
        for (const auto& [ending, type] : kTypes) {
            if (name.substr(dot + 1) == ending) return type;
        }
    }
    return "application/octet-stream";
}

}  // namespace palpa::desk
