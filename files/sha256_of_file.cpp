#include "files/sha256.h"
#include "files/text.h"

namespace palpa::files {

std::string sha256_of_file(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error) ? sha256_hex(read_text(file)) : "n/a";
}

}  // namespace palpa::files
