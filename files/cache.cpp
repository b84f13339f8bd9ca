#include "files/cache.h"

#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "files/sha256.h"
#include "files/text.h"

namespace palpa::files {
namespace {

static_assert(std::endian::native == std::endian::little, "words are read as they lie in the file");
static_assert(sizeof(double) == sizeof(std::uint64_t));

constexpr std::uint64_t kCacheMagic = 0x4548434141504c41ull;
constexpr std::uint64_t kVersion = 1;
constexpr std::size_t kWord = sizeof(std::uint64_t);
constexpr std::size_t kHeaderWords = 4;  // magic, version, fingerprint, number of arrays

std::uint64_t word_at(std::string_view bytes, std::size_t i) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + i * kWord, kWord);
    return word;
}

void append_word(std::uint64_t word, std::string& out) {
    char bytes[kWord];
    std::memcpy(bytes, &word, kWord);
    out.append(bytes, kWord);
}

// FNV-1a by words, with the upper half folded down after each: every step is one-to-one, so that a single changed word
// always changes the sum.
std::uint64_t checksum(std::string_view bytes, std::size_t n_words) {
    std::uint64_t hash = 14695981039346656037ull;
    for (std::size_t i = 0; i < n_words; ++i) {
        hash = (hash ^ word_at(bytes, i)) * 1099511628211ull;
        hash ^= hash >> 32;
    }
    return hash;
}

std::optional<CachedArrays> parse(std::string_view bytes, std::uint64_t fingerprint) {
    const std::size_t words = bytes.size() / kWord;
    if (bytes.size() % kWord != 0 || words < kHeaderWords + 1) return std::nullopt;
    if (word_at(bytes, 0) != kCacheMagic || word_at(bytes, 1) != kVersion || word_at(bytes, 2) != fingerprint) {
        return std::nullopt;
    }
    if (checksum(bytes, words - 1) != word_at(bytes, words - 1)) return std::nullopt;
    const std::uint64_t count = word_at(bytes, 3);
    std::size_t left = words - kHeaderWords - 1;
    if (count > left) return std::nullopt;
    left -= count;
    CachedArrays arrays;
    std::size_t at = (kHeaderWords + count) * kWord;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t size = word_at(bytes, kHeaderWords + i);
        if (size > left) return std::nullopt;
        left -= size;
        arrays.emplace_back(size);
        if (size > 0) std::memcpy(arrays.back().data(), bytes.data() + at, size * kWord);
        at += size * kWord;
    }
    if (left != 0) return std::nullopt;
    return arrays;
}

}  // namespace

std::filesystem::path cache_folder() {
    const char* const xdg = std::getenv("XDG_CACHE_HOME");
    if (xdg != nullptr && std::filesystem::path(xdg).is_absolute()) return std::filesystem::path(xdg) / "palpa";
    const char* const home = std::getenv("HOME");
    if (home != nullptr && std::filesystem::path(home).is_absolute()) {
        return std::filesystem::path(home) / ".cache" / "palpa";
    }
    return {};
}

std::uint64_t fingerprint_of(const Json& key) {
    return std::stoull(sha256_hex(json_text(key)).substr(0, 16), nullptr, 16);
}

std::filesystem::path cache_file(const std::filesystem::path& folder, std::uint64_t fingerprint) {
    char name[32];
    std::snprintf(name, sizeof name, "%016llx.cache", static_cast<unsigned long long>(fingerprint));
    return folder / name;
}

std::optional<CachedArrays> read_cache(const std::filesystem::path& folder, std::uint64_t fingerprint) {
    if (folder.empty()) return std::nullopt;
    try {
        return parse(read_text(cache_file(folder, fingerprint)), fingerprint);
    } catch (const std::exception&) {  // missing, a folder, too large or unreadable
        return std::nullopt;
    }
}

std::string write_cache(const std::filesystem::path& folder, std::uint64_t fingerprint, const CachedArrays& arrays) {
    if (folder.empty()) return "cache: neither XDG_CACHE_HOME nor HOME names a folder; nothing is kept";
    std::string bytes;
    for (const std::uint64_t word : {kCacheMagic, kVersion, fingerprint, std::uint64_t{arrays.size()}})
        append_word(word, bytes);
    for (const auto& array : arrays) append_word(array.size(), bytes);
    for (const auto& array : arrays) bytes.append(reinterpret_cast<const char*>(array.data()), array.size() * kWord);
    append_word(checksum(bytes, bytes.size() / kWord), bytes);
    try {
        std::filesystem::create_directories(folder);
        write_text_atomically(cache_file(folder, fingerprint), bytes);
    } catch (const std::exception& error) {
        return std::string("cache: ") + error.what() + "; the result is used but not kept";
    }
    return "";
}

}  // namespace palpa::files
