#pragma once
// Results on disk that can be computed again: arrays of doubles under a number that stands for everything
// they depend on (a fingerprint, e.g. of mechanics/compliance.h).
//
// A file is 64-bit words, little-endian: magic, format version, fingerprint, number of arrays, the size of
// each, the values, and a checksum over all words before it. Whatever is not exactly that is not used.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa::files {

using CachedArrays = std::vector<std::vector<double>>;

// $XDG_CACHE_HOME/palpa, or ~/.cache/palpa; empty when neither is known. A relative XDG_CACHE_HOME counts as
// none, as the XDG base directory specification asks.
std::filesystem::path cache_folder();

// FOLDER/0123456789abcdef.cache
std::filesystem::path cache_file(const std::filesystem::path& folder, std::uint64_t fingerprint);

// Nothing when there is no such file, or when it is damaged, cut, of another version or of another
// fingerprint. Never throws for what a file holds; nothing is allocated on its word alone.
std::optional<CachedArrays> read_cache(const std::filesystem::path& folder, std::uint64_t fingerprint);

// Makes the folder, writes beside the file, renames over whatever was there. Returns a warning to show, ""
// when it is stored: a full disk costs time at the next start, not the run.
std::string write_cache(const std::filesystem::path& folder, std::uint64_t fingerprint, const CachedArrays& arrays);

}  // namespace palpa::files
