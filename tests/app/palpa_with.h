#pragma once
// The program, called from a shell.

#include "tests/shell.h"

namespace palpa::test {

// `before` stands in front of the program, as a pipe into it or a limit on it does.
inline Called palpa_with(const std::string& arguments, const std::string& before = "") {
    return shell(before + " timeout 300 " PALPA_PROGRAM " " + arguments);
}

// A command line that sends SIGTERM to `command` once `file` is there, and ends with its status.
inline std::string stopped_once(const std::string& file, const std::string& command) {
    return command + " & p=$!; while [ ! -e " + file + " ] && kill -0 $p; do sleep 0.05; done; kill $p; wait $p";
}

}  // namespace palpa::test
