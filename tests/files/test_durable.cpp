#include <doctest/doctest.h>

#include "files/durable.h"
#include "files/text.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace fs = std::filesystem;

TEST_CASE("durable: a folder that is not there is said") {
    const TemporaryFolder folder;
    sync_folder(folder.path());
    CHECK_THROWS_AS(sync_folder(folder / "none"), std::runtime_error);
}

TEST_CASE("durable: a name that is taken keeps its file") {
    const TemporaryFolder folder;
    CHECK(write_new_text(folder / "a", "first"));
    CHECK_FALSE(write_new_text(folder / "a", "second"));
    CHECK(read_text(folder / "a") == "first");
    write_text_atomically(folder / "b", "other");
    CHECK_FALSE(rename_to_new(folder / "b", folder / "a"));
    CHECK(read_text(folder / "b") == "other");
    CHECK(rename_to_new(folder / "b", folder / "c"));
    CHECK_FALSE(fs::exists(folder / "b"));
    CHECK(read_text(folder / "c") == "other");
    CHECK_THROWS_AS(write_new_text(folder / "none" / "a", "x"), std::runtime_error);
    CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 2);  // nothing is left aside
}
