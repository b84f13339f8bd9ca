#pragma once
// What fuzz targets are made of. A target hands any bytes to one reader, which takes them or throws InputError.
// Whatever else gets out of it ends the process, and is a finding.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include "files/input_error.h"
#include "tests/temporary_folder.h"

// The entry of a target: libFuzzer's, or one by the target's name for the test that replays the corpora (replay.cpp).
#ifdef PALPA_FUZZ
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
#define PALPA_FUZZ_ENTRY(name) extern "C" int LLVMFuzzerTestOneInput
#else
#define PALPA_FUZZ_ENTRY(name) extern "C" int palpa_fuzz_##name
#endif

namespace palpa::fuzz {

[[noreturn]] inline void finding(const std::string& what) {
    std::fprintf(stderr, "finding: %s\n", what.c_str());
    std::abort();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    // an empty input may come as a null pointer
    return size == 0 ? std::string_view() : std::string_view(reinterpret_cast<const char*>(data), size);
}

// A message is shown on a terminal: it says something, is no flood, and what it quotes cannot steer the terminal.
inline void check_message(std::string_view message) {
    constexpr std::size_t kLongest = 100'000;  // it may list all columns of a table
    if (message.empty()) finding("a message without words");
    if (message.size() > kLongest) finding("a message of " + std::to_string(message.size()) + " bytes");
    for (const char c : message) {
        if ((static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f) {
            finding("a control character in the message: " + std::string(message));
        }
    }
}

// 0, what the entry of a target returns.
template <class Read>
int read_or_refuse(Read&& read) {
    try {
        read();
    } catch (const files::InputError& error) {
        check_message(error.what());
    }
    return 0;
}

// A file in memory, for readers that take a path.
class MemoryFile {
  public:
    explicit MemoryFile(const char* name) : fd_(::memfd_create(name, MFD_CLOEXEC)) {
        if (fd_ < 0) finding("no file in memory");
    }
    ~MemoryFile() { ::close(fd_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    const std::filesystem::path& with(std::string_view bytes) {
        const bool written = ::ftruncate(fd_, 0) == 0 &&
                             ::pwrite(fd_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
        if (!written) finding("a file in memory that cannot be written");
        return path_;
    }
    const std::filesystem::path& path() const { return path_; }

  private:
    int fd_;
    std::filesystem::path path_ = "/proc/self/fd/" + std::to_string(fd_);
};

// A folder whose files are links to files in memory, for readers that take several files. Gone when the process ends
// without a finding.
class MemoryFolder {
  public:
    void add(const std::string& name, const MemoryFile& file) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::filesystem::create_symlink(file.path(), folder_ / name);
    }
    const std::filesystem::path& path() const { return folder_.path(); }

  private:
    test::TemporaryFolder folder_;
};

// An input of several files: `count` parts, separated by lines "====". Parts that are not there are empty.
inline std::vector<std::string_view> parts_of(std::string_view bytes, std::size_t count) {
    constexpr std::string_view kBetween = "\n====\n";
    std::vector<std::string_view> parts(count);
    for (std::size_t i = 0; i < count && !bytes.empty(); ++i) {
        const auto end = i + 1 < count ? bytes.find(kBetween) : std::string_view::npos;
        parts[i] = bytes.substr(0, end);
        bytes = end == std::string_view::npos ? std::string_view() : bytes.substr(end + kBetween.size());
    }
    return parts;
}

}  // namespace palpa::fuzz
