#pragma once
// Calls a program as a person does, and keeps what it says.

#include <cstdlib>
#include <string>
#include <sys/wait.h>

#include "files/text.h"
#include "tests/temporary_folder.h"

namespace palpa::test {

struct Called {
    int status = 0;  // -1 if a signal ended it
    std::string out;
    std::string err;
};

// A command line of the shell, without input. One that hangs ends after ten minutes with status 124, so that the test can
// say which it was.
inline Called shell(const std::string& command) {
    const TemporaryFolder folder;
    files::write_text_atomically(folder / "command", command + "\n");
    const std::string whole = "timeout -k 10 600 sh " + (folder / "command").string() + " >" +
                              (folder / "out").string() + " 2>" + (folder / "err").string() + " </dev/null";
    const int status = std::system(whole.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, files::read_text(folder / "out"),
            files::read_text(folder / "err")};
}

inline bool has_gnuplot() { return shell("command -v gnuplot").status == 0; }

}  // namespace palpa::test
