#include <doctest/doctest.h>
#include <optional>

#include "files/folder_lock.h"
#include "files/input_error.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::files;
using namespace palpa::test;

TEST_CASE("folder lock: a folder belongs to one at a time, and is free again afterwards") {
    const TemporaryFolder folder;
    std::optional<FolderLock> first(std::in_place, folder.path(), "another one");
    CHECK(contains(message_of([&] { FolderLock(folder.path(), "another one"); }),
                   "found another one, expected a folder of its own for each"));
    first.reset();
    CHECK_NOTHROW(FolderLock(folder.path(), "another one"));
    CHECK_THROWS_AS(FolderLock(folder / "none", "another one"), std::runtime_error);
}
