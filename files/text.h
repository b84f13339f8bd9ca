#pragma once
// Whole files as text; fields of a line; numbers to and from text, independent of the locale.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::files {

// Reads a whole file. Throws InputError if it cannot be read, is not a regular file, or is larger than `limit_bytes`.
std::string read_text(const std::filesystem::path& path, std::size_t limit_bytes = std::size_t{1} << 31);

// Writes beside the target, syncs, then renames: the file is there whole or not at all. Throws std::runtime_error with
// the system's reason, InputError if `path` exists and is not a regular file.
void write_text_atomically(const std::filesystem::path& path, std::string_view text);

// Does the same without waiting for the disk: after a kill the file is there whole or not at all, but after a power cut
// it may be damaged.
void write_text_whole(const std::filesystem::path& path, std::string_view text);

// Waits until an existing file is on the disk. Throws std::runtime_error.
void sync_file(const std::filesystem::path& path);

// Throws std::runtime_error that names the path and the reason in errno.
[[noreturn]] void fail_writing(const std::filesystem::path& path);

// Splits a line at its separators; a line without a separator is one field.
std::vector<std::string_view> fields_of(std::string_view line, char separator);

// Reads the whole of `text` as a finite or non-finite double ("1e-3", "nan"); returns false if any part of it is not
// a number. A leading '+' is accepted, a decimal comma is not.
bool parse_number(std::string_view text, double& out);

// Shortest text that reads back as the same double; NaN becomes "n/a".
void append_number(double value, std::string& out);
std::string number_text(double value);

// Four significant digits, for messages and tables.
std::string short_number(double value);

// "1 trial", "2 trials": for nouns whose plural ends in s.
std::string counted(std::int64_t n, const char* noun);

}  // namespace palpa::files
