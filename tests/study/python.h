#pragma once
// An independent program's numbers: Python with the named module, where it is installed.

#include <cstdlib>
#include <filesystem>
#include <string>

#include "files/text.h"
#include "tests/temporary_folder.h"

namespace palpa::test {

// The first Python that has them, or "". A Python of the person's own may hide the system's, which scripts/setup equips.
inline std::string python_with(const std::string& modules) {
    for (const std::string python : {"python3", "/usr/bin/python3"}) {
        const std::string command = "timeout 60 " + python + " -c 'import " + modules + "' >/dev/null 2>&1";
        if (std::system(command.c_str()) == 0) return python;
    }
    return "";
}

// Exit status 0? The script stands in `folder` as script.py and runs there; what it says goes to said.txt.
inline bool run_python(const std::string& python, const TemporaryFolder& folder, const std::string& script) {
    files::write_text_atomically(folder / "script.py", script);
    const std::string command =
        "cd " + folder.path().string() + " && timeout 120 " + python + " script.py >said.txt 2>&1";
    return std::system(command.c_str()) == 0;
}

}  // namespace palpa::test
