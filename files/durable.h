#pragma once
// Functions that write files so that they survive a kill and a power cut, and that never replace a file.

#include <filesystem>
#include <string_view>

namespace palpa::files {

// Waits until a folder's entries are on the disk. Throws std::runtime_error.
void sync_folder(const std::filesystem::path& folder);

// Renames a file unless the new name is taken; then it changes nothing and returns false. Throws std::runtime_error.
bool rename_to_new(const std::filesystem::path& from, const std::filesystem::path& to);

// Writes beside the target, syncs, then renames: the file is there whole or not at all. If the file exists, it stays as
// it is and the function returns false. The folder is not synced. Throws std::runtime_error.
bool write_new_text(const std::filesystem::path& path, std::string_view text);

}  // namespace palpa::files
