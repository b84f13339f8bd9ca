#pragma once
// A cache on disk for results that can be computed again: arrays of doubles under a fingerprint, a number that stands
// for everything they depend on (for example that of mechanics/compliance.h).
//
// A file consists of 64-bit words, little-endian: magic, format version, fingerprint, number of arrays, the size of
// each, the values, and a checksum over all words before it. A file that deviates from this form is not used.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/json.h"

namespace palpa::files {

using CachedArrays = std::vector<std::vector<double>>;

// Returns $XDG_CACHE_HOME/palpa, or ~/.cache/palpa; empty if neither variable is an absolute path. A relative
// XDG_CACHE_HOME is ignored, as the XDG base directory specification requires.
std::filesystem::path cache_folder();

// Returns the first 64 bits of the SHA-256 of the key's text.
std::uint64_t fingerprint_of(const Json& key);

// Returns FOLDER/0123456789abcdef.cache.
std::filesystem::path cache_file(const std::filesystem::path& folder, std::uint64_t fingerprint);

// Returns nothing if there is no such file, or if it is damaged, cut off, of another version or of another fingerprint.
// The content of a file never makes the function throw, and sizes in the file are checked before memory is allocated.
std::optional<CachedArrays> read_cache(const std::filesystem::path& folder, std::uint64_t fingerprint);

// Creates the folder, writes beside the file, and renames over an older file. Returns a warning to show, or "" if the
// arrays are stored: a full disk costs time at the next start, not the run.
std::string write_cache(const std::filesystem::path& folder, std::uint64_t fingerprint, const CachedArrays& arrays);

}  // namespace palpa::files
