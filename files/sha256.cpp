// Uses OpenSSL, which has the processor's own instructions; files/web/sha256.cpp does the same for browsers.

#include "files/sha256.h"

#include <array>
#include <openssl/evp.h>
#include <stdexcept>

namespace palpa::files {

std::string sha256_hex(std::string_view bytes) {
    std::array<unsigned char, 32> hash{};
    if (EVP_Digest(bytes.data(), bytes.size(), hash.data(), nullptr, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("OpenSSL cannot compute SHA-256; its configuration may forbid it");
    std::string hex;
    for (const unsigned char byte : hash) {
        hex.push_back("0123456789abcdef"[byte >> 4]);
        hex.push_back("0123456789abcdef"[byte & 0xf]);
    }
    return hex;
}

}  // namespace palpa::files
