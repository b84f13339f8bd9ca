#pragma once
// Runs libraries that read files from strangers in a process of their own: if a file crashes them, or makes them run or
// grow without end, that becomes a message about the file.

#include <functional>
#include <string>

#include "files/npy.h"

namespace palpa::stiffnessmaps {

// Returns what `read` returns, or throws its InputError. Throws InputError that names `file` and `library` if the
// process crashes or needs more than a minute of processor time or 4 GiB of memory; std::runtime_error if it cannot be
// started. Only for callers with one thread.
files::NpyArray read_apart(const std::string& file, const char* library, const std::function<files::NpyArray()>& read);

}  // namespace palpa::stiffnessmaps
