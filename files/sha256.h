#pragma once
// SHA-256 (FIPS 180-4). Logs hold it, so that anybody can check with `sha256sum` which files they were made with.

#include <filesystem>
#include <string>
#include <string_view>

namespace palpa::files {

std::string sha256_hex(std::string_view bytes);

// Says whether the text is 64 digits, 0 to 9 and a to f.
bool is_sha256_hex(std::string_view text);

// Returns "n/a" if there is no regular file. Throws InputError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace palpa::files
