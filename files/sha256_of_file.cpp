#include <algorithm>

#include "files/sha256.h"
#include "files/text.h"

namespace palpa::files {

bool is_sha256_hex(std::string_view text) {
    return text.size() == 64 && std::all_of(text.begin(), text.end(),
                                            [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

std::string sha256_of_file(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error) ? sha256_hex(read_text(file)) : "n/a";
}

}  // namespace palpa::files
