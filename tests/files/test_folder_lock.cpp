#include <doctest/doctest.h>
#include <optional>
#include <signal.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

#include "files/folder_lock.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::files;
using namespace palpa::test;

TEST_CASE("folder lock: one holder at a time, free again once the holder is gone, also by a kill") {
    const TemporaryFolder folder;
    {
        const FolderLock lock(folder.path());
        CHECK(contains(message_of([&] { const FolderLock other(folder.path()); }),
                       "found another palpa that writes into this folder"));
    }
    const pid_t child = fork();
    if (child == 0) {
        std::optional<FolderLock> held;
        held.emplace(folder.path());
        kill(getpid(), SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(WIFSIGNALED(status));
    CHECK_NOTHROW(FolderLock(folder.path()));
    CHECK_THROWS_AS(FolderLock(folder / "none"), std::runtime_error);
}
