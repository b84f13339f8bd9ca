#pragma once
// Inputs must be regular files: a FIFO or a terminal would block the program until somebody writes to it, and reading a
// device node can change the device. Results must be regular files too: a result gets its name by renaming, which would
// replace a device node.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::files {

// Returns "a folder", "a FIFO", "a character device" and so on; empty for a regular file and for a free name. Follows
// links.
std::string_view irregular_kind(const std::filesystem::path& path);

// Lists a folder for a screen, in the order of the names: what could be read, also where it is not there or fails meanwhile.
std::vector<std::filesystem::path> listed_entries(const std::filesystem::path& folder);

// A regular file, open for reading. The constructor throws InputError, without waiting, if the file is not a regular
// one or cannot be read.
class InputFile {
  public:
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    std::uintmax_t bytes() const { return bytes_; }  // 0 for files that are generated as they are read (/proc)
    // Reads up to `n` bytes. Returns their number, which is less than `n` only at the file's end. Throws InputError.
    std::size_t read_at(std::uintmax_t offset, char* to, std::size_t n) const;

  private:
    std::filesystem::path path_;
    int fd_ = -1;
    std::uintmax_t bytes_ = 0;
};

// Checks a file that other code (a library) opens by its name. Throws InputError as InputFile does.
void check_input(const std::filesystem::path& path);

// Returns the file that is replaced when a result is written to `path`: the target of a link, else `path` itself.
// Throws InputError if it exists and is not a regular file.
std::filesystem::path output_target(const std::filesystem::path& path);

// Checks, before any work, whether a result may go to `path`: its folder must exist and may be written to, and `path` must
// be a regular file or a free name. It must not be one of `inputs` under any name (nor a file in an input that is a
// folder), not the file to which standard output or standard error go, and no file that a study's folder has already (in itself,
// or in those of its participants). Throws InputError.
void check_output(const std::filesystem::path& path, const std::vector<std::filesystem::path>& inputs = {});

// Checks the same for a folder of results, which must be a folder or a free name. `names`: the files that it will hold.
void check_output_folder(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& inputs = {},
                         const std::vector<std::string>& names = {});

// Checks, before any work, that results of these names would replace none but earlier results: in a folder without the
// file `mark`, which is written first of all, such names are a person's own. Throws InputError.
void check_own_results(const std::filesystem::path& folder, const std::string& mark,
                       const std::vector<std::string>& names);

// Checks, before any work, that there is nothing of this name: for logs, maps and recordings, which are never overwritten.
// Throws InputError.
void check_new(const std::filesystem::path& path);

}  // namespace palpa::files
