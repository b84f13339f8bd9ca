#include <csignal>
#include <doctest/doctest.h>
#include <sys/resource.h>

#include "files/append_file.h"
#include "files/text.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

TEST_CASE("append file: rows arrive in order, an existing file is never touched") {
    const TemporaryFolder folder;
    {
        AppendFile file(folder / "log");
        for (int i = 0; i < 20000; ++i) file.append("row " + std::to_string(i) + "\n");
        CHECK(file.sync());
    }
    const std::string text = read_text(folder / "log");
    CHECK(text.substr(0, 12) == "row 0\nrow 1\n");
    CHECK(text.substr(text.size() - 10) == "row 19999\n");
    CHECK_THROWS_AS(AppendFile(folder / "log"), std::runtime_error);
    CHECK(read_text(folder / "log") == text);
}

TEST_CASE("append file: a disk that takes no more is said, and stays said") {
    const TemporaryFolder folder;
    AppendFile file(folder / "log");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    file.append(std::string(10000, 'x'));
    CHECK_FALSE(file.sync());
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK(file.failed());
    CHECK_FALSE(file.flush());
}
