#pragma once
// The program, called from a shell.

#include "tests/shell.h"

namespace palpa::test {

// `before` stands in front of the program, as a pipe into it or a limit on it does.
inline Called palpa_with(const std::string& arguments, const std::string& before = "") {
    return shell(before + " timeout 300 " PALPA_PROGRAM " " + arguments);
}

}  // namespace palpa::test
