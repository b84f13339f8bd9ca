#pragma once
// Libraries that read files from strangers run in a process of their own: what crashes them, or makes them
// run or grow without end, is then a message about the file.

#include <functional>
#include <string>

#include "files/npy.h"

namespace palpa::stiffnessmaps {

// What `read` returns, or throws as InputError. Throws InputError that names `file` and `library` where the
// process crashes, takes more than a minute of the processor or some gigabytes of memory. Only for callers
// with one thread.
files::NpyArray read_apart(const std::string& file, const char* library, const std::function<files::NpyArray()>& read);

}  // namespace palpa::stiffnessmaps
