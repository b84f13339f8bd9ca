#pragma once
// Inputs are regular files: a FIFO or a terminal would hold the program up until somebody writes to it, and reading a
// device node can change the device. So are results: what takes a name by renaming would replace a device node.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::files {

// "a folder", "a FIFO", "a character device"; empty for a regular file and for a name that is free. Follows links.
std::string_view irregular_kind(const std::filesystem::path& path);

// A regular file that is open for reading. Throws InputError, at once, if it is none or cannot be read.
class InputFile {
  public:
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    std::uintmax_t bytes() const { return bytes_; }  // 0 for files that are made as they are read (/proc)
    // How much was read: less than `n` at the file's end only. Throws InputError.
    std::size_t read_at(std::uintmax_t offset, char* to, std::size_t n) const;

  private:
    std::filesystem::path path_;
    int fd_ = -1;
    std::uintmax_t bytes_ = 0;
};

// For what is opened by name elsewhere (a library): throws InputError as InputFile does.
void check_input(const std::filesystem::path& path);

// The file that takes the place of `path` when a result is written: what a link leads to, else `path`. Throws
// InputError for what is there and no regular file.
std::filesystem::path output_target(const std::filesystem::path& path);

// Before any work: may a result go there? Its folder is there, and `path` is a regular file or a free name, none of
// `inputs` under whatever name (nor a file in an input that is a folder), and not what standard output or standard
// error go to. Throws InputError.
void check_output(const std::filesystem::path& path, const std::vector<std::filesystem::path>& inputs = {});

// The same for a folder of results: a folder, or a free name. `names`: of the files that it will hold.
void check_output_folder(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& inputs = {},
                         const std::vector<std::string>& names = {});

}  // namespace palpa::files
