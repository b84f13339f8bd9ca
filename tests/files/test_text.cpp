#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <random>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

TEST_CASE("text: numbers read back to the same bits") {
    constexpr std::uint64_t kSeed = 1;
    CAPTURE(kSeed);
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 20000; ++i) {
        const std::uint64_t bits = random();
        double value;
        std::memcpy(&value, &bits, sizeof value);
        if (!std::isfinite(value)) continue;
        double back = 0.0;
        REQUIRE(parse_number(number_text(value), back));
        REQUIRE(std::memcmp(&value, &back, sizeof value) == 0);
    }
    CHECK(number_text(std::nan("")) == "n/a");
}

TEST_CASE("text: what is not a number is not taken for one") {
    double out = 7.0;
    for (const char* text : {"", " ", "1,5", "1.5 ", "0x10", "1e", "++1", "+", "1.5mm", "one", "-"}) {
        CAPTURE(text);
        CHECK_FALSE(parse_number(text, out));
    }
    CHECK(parse_number("+1.5", out));
    CHECK(out == 1.5);
    CHECK(parse_number("-1e-3", out));
    CHECK(out == -1e-3);
}

TEST_CASE("text: files that cannot be read are named") {
    const TemporaryFolder folder;
    CHECK(contains(message_of([&] { read_text(folder / "absent"); }), "absent: cannot be read"));
    CHECK(contains(message_of([&] { read_text(folder.path()); }), "found a folder, expected a regular file"));
    write_text_atomically(folder / "a", "12345");
    CHECK(read_text(folder / "a") == "12345");
    CHECK(contains(message_of([&] { read_text(folder / "a", 4); }), "more than 4 bytes"));
}

TEST_CASE("text: a failed write leaves the old file and nothing else") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "a", "old");
    std::filesystem::create_directory(folder / "b");
    CHECK_THROWS_AS(write_text_atomically(folder / "b", "new"), std::runtime_error);
    CHECK_THROWS_AS(write_text_atomically(folder / "none/c", "new"), std::runtime_error);
    CHECK(read_text(folder / "a") == "old");
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 2);
}

TEST_CASE("text: a run that is killed while it writes leaves the old file and nothing else") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "a", "old");
    const std::string text(1 << 20, 'x');
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        ::signal(SIGXFSZ, SIG_DFL);  // whatever started the tests may have it ignored
        const rlimit half{text.size() / 2, text.size() / 2};
        ::setrlimit(RLIMIT_FSIZE, &half);  // SIGXFSZ ends it in the middle of the file
        write_text_atomically(folder / "a", text);
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(WIFSIGNALED(status));
    CHECK(read_text(folder / "a") == "old");
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("text: one of a thing is not named in the plural") {
    CHECK(counted(0, "trial") == "0 trials");
    CHECK(counted(1, "trial") == "1 trial");
    CHECK(counted(2, "trial") == "2 trials");
}
