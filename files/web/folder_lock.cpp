// The files of a page belong to that page alone.

#include "files/folder_lock.h"

namespace palpa::files {

FolderLock::FolderLock(const std::filesystem::path&) {}
FolderLock::~FolderLock() = default;

}  // namespace palpa::files
