#pragma once
// SHA-256 (FIPS 180-4): what a log names so that anybody can check with `sha256sum` which file it was made with.

#include <filesystem>
#include <string>
#include <string_view>

namespace palpa::files {

std::string sha256_hex(std::string_view bytes);

// 64 digits, 0 to 9 and a to f.
bool is_sha256_hex(std::string_view text);

// "n/a" where there is no file. Throws InputError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace palpa::files
