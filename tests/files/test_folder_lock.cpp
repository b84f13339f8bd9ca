#include <csignal>
#include <doctest/doctest.h>
#include <optional>
#include <sys/wait.h>
#include <unistd.h>

#include "files/folder_lock.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::files;
using namespace palpa::test;

TEST_CASE("folder lock: one holds it, a look changes nothing, and the next takes it when the first is gone") {
    const TemporaryFolder folder;
    CHECK_FALSE(is_folder_locked(folder.path()));
    std::optional<FolderLock> first(std::in_place, folder.path());
    REQUIRE(first->held());
    CHECK(is_folder_locked(folder.path()));
    {
        const FolderLock second(folder.path());
        CHECK_FALSE(second.held());
        CHECK(second.held_elsewhere());
    }
    CHECK(first->held());
    CHECK(is_folder_locked(folder.path()));
    first.reset();
    CHECK_FALSE(is_folder_locked(folder.path()));
    CHECK(FolderLock(folder.path()).held());
}

TEST_CASE("folder lock: who comes second may be refused in words") {
    const TemporaryFolder folder;
    std::optional<FolderLock> first(std::in_place, folder.path(), "another one");
    CHECK(contains(message_of([&] { FolderLock(folder.path(), "another one"); }),
                   "found another one, expected a folder of its own for each"));
    first.reset();
    CHECK_NOTHROW(FolderLock(folder.path(), "another one"));
}

TEST_CASE("folder lock: of a program that was killed, nothing is left") {
    const TemporaryFolder folder;
    int ready[2];
    REQUIRE(::pipe(ready) == 0);
    const pid_t other = ::fork();
    if (other == 0) {
        const FolderLock lock(folder.path());
        const char held = lock.held() ? 'y' : 'n';
        if (::write(ready[1], &held, 1) == 1) ::pause();
        ::_exit(1);
    }
    char held = 'n';
    CHECK(::read(ready[0], &held, 1) == 1);
    CHECK(held == 'y');
    CHECK(is_folder_locked(folder.path()));
    ::kill(other, SIGKILL);
    ::waitpid(other, nullptr, 0);
    CHECK_FALSE(is_folder_locked(folder.path()));
    ::close(ready[0]);
    ::close(ready[1]);
}

TEST_CASE("folder lock: where there is no folder, nobody has it") {
    const TemporaryFolder folder;
    const FolderLock lock(folder / "none");
    CHECK_FALSE(lock.held());
    CHECK_FALSE(lock.held_elsewhere());
    CHECK_FALSE(is_folder_locked(folder / "none"));
}
