#include <csignal>
#include <doctest/doctest.h>
#include <sys/resource.h>

#include "files/append_file.h"
#include "files/text.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

template <class Do>
void with_files_of_at_most(rlim_t bytes, const Do& act) {
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{bytes, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    act();
    setrlimit(RLIMIT_FSIZE, &before);
}

}  // namespace

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
    with_files_of_at_most(4096, [&] {
        file.append(std::string(10000, 'x'));
        CHECK_FALSE(file.sync());
    });
    CHECK(file.failed());
    CHECK_FALSE(file.flush());
}

TEST_CASE("append file: a line that the disk does not take leaves the file as it was") {
    const TemporaryFolder folder;
    append_synced(folder / "table", "head\n");
    with_files_of_at_most(8, [&] {
        CHECK_THROWS_AS(append_synced(folder / "table", "one line\n"), std::runtime_error);
        CHECK_THROWS_AS(append_synced(folder / "new", "a long line\n"), std::runtime_error);
    });
    CHECK(read_text(folder / "table") == "head\n");
    CHECK_FALSE(std::filesystem::exists(folder / "new"));
}
