#pragma once
// Writing that survives a kill and a power cut, and replaces nothing.

#include <filesystem>
#include <string_view>

namespace palpa::files {

// Waits until a folder's entries are on the disk. Throws std::runtime_error.
void sync_folder(const std::filesystem::path& folder);

// Gives a file its name unless that is taken: then false, and nothing has changed. Throws std::runtime_error.
bool rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to);

// Writes beside the target, syncs, then renames: the file is there whole or not at all. What is there already stays:
// then false. Its folder is not synced. Throws std::runtime_error.
bool write_new_text(const std::filesystem::path& path, std::string_view text);

}  // namespace palpa::files
