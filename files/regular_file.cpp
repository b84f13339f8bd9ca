#include "files/regular_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

#include "files/input_error.h"

namespace palpa::files {
namespace {

namespace fs = std::filesystem;

std::string_view kind_of(mode_t mode) {
    if (S_ISREG(mode)) return "";
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a FIFO";
    if (S_ISSOCK(mode)) return "a socket";
    if (S_ISCHR(mode)) return "a character device";
    if (S_ISBLK(mode)) return "a block device";
    return "something else";
}

[[noreturn]] void refuse_input(const fs::path& path, std::string_view kind) {
    throw bad_input(path.string(), "", kind, "a regular file");
}

bool is_same(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

bool is_same(const struct stat& a, const fs::path& b) {
    struct stat status {};
    return ::stat(b.c_str(), &status) == 0 && is_same(a, status);
}

bool is_in(const struct stat& file, const fs::path& input) {
    std::error_code error;
    if (!fs::is_directory(input, error)) return is_same(file, input);
    const std::vector<fs::path> entries = listed_entries(input);
    return std::any_of(entries.begin(), entries.end(), [&](const fs::path& entry) { return is_same(file, entry); });
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

void check_folder_of(const fs::path& path) {
    std::error_code error;
    const fs::path folder = folder_of(path);
    if (!fs::is_directory(folder, error))
        throw bad_input(path.string(), "", "no folder " + folder.string(), "a folder that is there");
}

void check_may_write(const fs::path& folder, const fs::path& path) {
    if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
        throw bad_input(path.string(), "", "the folder " + folder.string() + ", to which nothing can be written",
                        "one that may be written to");
}

// Whether a file that exists lies in a study's folder, or among one participant's files there.
bool is_of_study(const fs::path& file) {
    std::error_code error;
    for (fs::path folder = fs::canonical(file, error).parent_path(); !error; folder = folder.parent_path()) {
        if (fs::exists(folder / "study.json", error)) return true;
        const bool inside = folder.filename() == "beh" || folder.filename().string().starts_with("sub-");
        if (!inside || !folder.has_relative_path()) return false;
    }
    return false;
}

}  // namespace

std::vector<fs::path> listed_entries(const fs::path& folder) {
    std::vector<fs::path> out;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        out.push_back(entry->path());
    std::sort(out.begin(), out.end());
    return out;
}

std::string_view irregular_kind(const fs::path& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 ? kind_of(status.st_mode) : "";
}

InputFile::InputFile(const fs::path& path) : path_(path) {
    // an irregular file is not even opened: opening alone can rewind a tape or reset a board
    if (const auto kind = irregular_kind(path); !kind.empty()) refuse_input(path, kind);
    fd_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd_ < 0) throw InputError(path.string() + ": cannot be read: " + std::strerror(errno));
    // the name may stand for another file than a moment ago, so the opened file is checked too
    struct stat status {};
    const bool known = ::fstat(fd_, &status) == 0;
    if (known && S_ISREG(status.st_mode)) {
        bytes_ = static_cast<std::uintmax_t>(status.st_size);
        return;
    }
    ::close(fd_);
    refuse_input(path, known ? kind_of(status.st_mode) : "something else");
}

InputFile::~InputFile() { ::close(fd_); }

std::size_t InputFile::read_at(std::uintmax_t offset, char* to, std::size_t n) const {
    std::size_t done = 0;
    while (done < n) {
        const ssize_t got = ::pread(fd_, to + done, n - done, static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw InputError(path_.string() + ": cannot be read to its end: " + std::strerror(errno));
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

void check_input(const fs::path& path) { const InputFile opened(path); }

fs::path output_target(const fs::path& path) {
    constexpr const char* kExpected = "a regular file or a new name";
    if (path.empty()) throw bad_input("output", "", "an empty name", "a file's name");
    if (const auto kind = irregular_kind(path); !kind.empty()) throw bad_input(path.string(), "", kind, kExpected);
    std::error_code error;
    if (!fs::is_symlink(path, error)) return path;
    const fs::path target = fs::canonical(path, error);
    if (error) throw bad_input(path.string(), "", "a link to nothing", kExpected);
    return target;
}

void check_output(const fs::path& path, const std::vector<fs::path>& inputs) {
    const fs::path target = output_target(path);
    check_folder_of(path);
    check_may_write(folder_of(target), path);
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return;
    if (is_of_study(path))
        throw bad_input(path.string(), "", "a file of a study", "another name: what people gave is never replaced");
    for (const fs::path& input : inputs) {
        if (is_in(status, input))
            throw bad_input(path.string(), "", "the input " + input.string(),
                            "another file: an input is never replaced");
    }
    for (const int fd : {STDOUT_FILENO, STDERR_FILENO}) {
        struct stat stream {};
        if (::fstat(fd, &stream) == 0 && is_same(status, stream)) {
            throw bad_input(path.string(), "",
                            fd == STDOUT_FILENO ? "where standard output goes" : "where standard error goes",
                            "another file");
        }
    }
}

void check_output_folder(const fs::path& folder, const std::vector<fs::path>& inputs,
                         const std::vector<std::string>& names) {
    if (folder.empty()) throw bad_input("output", "", "an empty name", "a folder's name");
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (fs::exists(status) && !fs::is_directory(status)) {
        const auto kind = irregular_kind(folder);
        throw bad_input(folder.string(), "", "no folder but " + std::string(kind.empty() ? "a file" : kind),
                        "a folder or a new name");
    }
    fs::path there = folder;
    while (there.has_relative_path() && !fs::exists(there, error)) there = there.parent_path();
    check_may_write(there.empty() ? "." : there, folder);
    if (!fs::exists(status)) return;
    for (const std::string& name : names) check_output(folder / name, inputs);
}

void check_own_results(const fs::path& folder, const std::string& mark, const std::vector<std::string>& names) {
    std::error_code none;
    if (fs::exists(folder / mark, none)) return;
    for (const std::string& name : names) {
        if (!fs::exists(fs::symlink_status(folder / name, none))) continue;
        throw bad_input((folder / name).string(), "", "a file that is no earlier result (no " + mark + " beside it)",
                        "a folder without one, since a result of this name is written");
    }
}

void check_new(const fs::path& path) {
    std::error_code error;
    if (fs::exists(fs::symlink_status(path, error)))
        throw bad_input(path.string(), "", "something of that name", "a new name (nothing is overwritten)");
}

}  // namespace palpa::files
