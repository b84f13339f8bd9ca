#include <cstring>
#include <doctest/doctest.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "files/json.h"
#include "files/npy.h"
#include "files/regular_file.h"
#include "files/table.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

void make_fifo(const fs::path& path) {
    if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error(path.string() + ": no FIFO");
}

void make_socket(const fs::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
    const bool bound = ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::close(fd);
    if (!bound) throw std::runtime_error(path.string() + ": no socket");
}

std::string input_refusal(const fs::path& path) {
    return message_of([&] { const InputFile opened(path); });
}
std::string output_refusal(const fs::path& path, const std::vector<fs::path>& inputs = {}) {
    return message_of([&] { check_output(path, inputs); });
}

}  // namespace

TEST_CASE("regular file: an input that is none is refused at once, by kind") {
    const TemporaryFolder folder;
    make_fifo(folder / "fifo");
    make_socket(folder / "socket");
    fs::create_symlink(folder / "fifo", folder / "link");
    CHECK(input_refusal(folder / "fifo") == (folder / "fifo").string() + ": found a FIFO, expected a regular file");
    CHECK(contains(input_refusal(folder / "link"), "found a FIFO"));
    CHECK(contains(input_refusal(folder / "socket"), "found a socket"));
    CHECK(contains(input_refusal(folder.path()), "found a folder"));
    CHECK(contains(input_refusal("/dev/zero"), "found a character device"));
    CHECK(contains(input_refusal(folder / "none"), "none: cannot be read: No such file"));
    // what reads goes that way
    CHECK(contains(message_of([&] { read_text(folder / "fifo"); }), "found a FIFO"));
    CHECK(contains(message_of([&] { read_json(folder / "fifo"); }), "found a FIFO"));
    CHECK(contains(message_of([&] { read_tsv(folder / "fifo"); }), "found a FIFO"));
    CHECK(contains(message_of([&] { read_npy(folder / "fifo"); }), "found a FIFO"));
}

TEST_CASE("regular file: parts are read where they stand, links are followed") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "a", "0123456789");
    fs::create_symlink(folder / "a", folder / "link");
    const InputFile file(folder / "link");
    CHECK(file.bytes() == 10);
    std::string part(4, '?');
    CHECK(file.read_at(3, part.data(), 4) == 4);
    CHECK(part == "3456");
    CHECK(file.read_at(8, part.data(), 4) == 2);
    CHECK(part == "8956");
    CHECK(file.read_at(20, part.data(), 4) == 0);
    CHECK(contains(read_text("/proc/self/status"), "Pid:"));  // says that it has no bytes
}

TEST_CASE("regular file: an output replaces a regular file alone") {
    const TemporaryFolder folder;
    make_fifo(folder / "fifo");
    make_socket(folder / "socket");
    fs::create_symlink("/dev/null", folder / "null");
    fs::create_symlink(folder / "none", folder / "dangling");
    write_text_atomically(folder / "there", "old");
    CHECK(output_refusal(folder / "there").empty());
    CHECK(output_refusal(folder / "new").empty());
    for (const auto& [name, kind] : {std::pair{"fifo", "a FIFO"},
                                     {"socket", "a socket"},
                                     {"null", "a character device"},
                                     {".", "a folder"},
                                     {"dangling", "a link to nothing"}}) {
        const fs::path path = folder / name;
        CAPTURE(path);
        const std::string expected = path.string() + ": found " + kind + ", expected a regular file or a new name";
        CHECK(output_refusal(path) == expected);
        CHECK(message_of([&] { write_text_atomically(path, "x"); }) == expected);
        CHECK(message_of([&] { write_text_whole(path, "x"); }) == expected);
        CHECK(message_of([&] { write_npy(path, {1}, {1.0f}); }) == expected);
    }
    CHECK(fs::is_fifo(folder / "fifo"));
    CHECK(fs::is_symlink(folder / "null"));
    CHECK(contains(output_refusal(folder / "no/where"), "found no folder"));
    CHECK(contains(output_refusal(""), "found an empty name"));
}

TEST_CASE("regular file: an output through a link changes what it leads to, not the link") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "there", "old");
    fs::create_symlink("there", folder / "link");
    write_text_atomically(folder / "link", "new");
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(read_text(folder / "there") == "new");
}

TEST_CASE("regular file: what lies in the way of the file that is written beside goes, unread") {
    const TemporaryFolder folder;
    make_fifo(folder / ("a.part-" + std::to_string(::getpid())));
    write_text_atomically(folder / "a", "new");
    CHECK(read_text(folder / "a") == "new");
}

TEST_CASE("regular file: an output is none of the inputs under any name, nor standard output") {
    const TemporaryFolder folder;
    fs::create_directory(folder / "in.map");
    write_text_atomically(folder / "in", "input");
    write_text_atomically(folder / "in.map/normal_N.npy", "input");
    write_text_atomically(folder / "other", "");
    fs::create_symlink("in", folder / "link");
    fs::create_hard_link(folder / "in", folder / "hard");
    fs::create_symlink("in.map", folder / "map_link");
    const std::vector<fs::path> inputs{"", folder / "none", folder / "in", folder / "map_link"};
    for (const char* name :
         {"in", "link", "hard", "./in", "in.map/../in", "in.map/normal_N.npy", "map_link/normal_N.npy"}) {
        CAPTURE(name);
        CHECK(contains(output_refusal(folder / name, inputs), "found the input"));
    }
    for (const char* name : {"other", "new", "in.map/new.png"}) CHECK(output_refusal(folder / name, inputs).empty());
    const int kept = ::dup(STDOUT_FILENO);
    std::FILE* file = std::fopen((folder / "other").c_str(), "w");
    ::dup2(::fileno(file), STDOUT_FILENO);
    const std::string refusal = output_refusal(folder / "other");
    ::dup2(kept, STDOUT_FILENO);
    ::close(kept);
    std::fclose(file);
    CHECK(contains(refusal, "found where standard output goes"));
}

TEST_CASE(
    "regular file: a folder of results is a folder or a new name, and holds none of the inputs under a result's name") {
    const TemporaryFolder folder;
    make_fifo(folder / "fifo");
    write_text_atomically(folder / "trials.tsv", "input");
    const auto refusal = [&](const fs::path& path) {
        return message_of([&] { check_output_folder(path, {folder / "trials.tsv"}, {"report.md", "trials.tsv"}); });
    };
    CHECK(contains(refusal(folder / "fifo"), "found no folder but a FIFO, expected a folder or a new name"));
    CHECK(contains(refusal(folder / "trials.tsv"), "found no folder but a file"));
    CHECK(contains(refusal(folder.path()), "trials.tsv: found the input"));
    CHECK(refusal(folder / "new").empty());
    CHECK(contains(refusal(""), "found an empty name"));
}

TEST_CASE("regular file: no result replaces a file that a study's folder has already") {
    const TemporaryFolder folder;
    fs::create_directories(folder / "log/sub-01/beh");
    fs::create_directories(folder / "log/report");
    fs::create_directories(folder / "sub-01");
    for (const char* name : {"log/study.json", "log/participants.tsv", "log/sub-01/answers.json",
                             "log/sub-01/beh/run-01_events.tsv", "log/report/report.md", "sub-01/own.json"})
        write_text_atomically(folder / name, "kept");
    fs::create_symlink(folder / "log/participants.tsv", folder / "link.tsv");
    for (const char* name : {"log/study.json", "log/participants.tsv", "log/sub-01/answers.json",
                             "log/sub-01/beh/run-01_events.tsv", "link.tsv"}) {
        CAPTURE(name);
        CHECK(contains(message_of([&] { check_output(folder / name); }), "found a file of a study"));
    }
    for (const char* name : {"log/new.json", "log/report/report.md", "sub-01/own.json"}) {
        CAPTURE(name);
        CHECK(message_of([&] { check_output(folder / name); }) == "");
    }
}

TEST_CASE("regular file: a result that cannot be written to its folder is refused before any work") {
    const TemporaryFolder folder;
    fs::create_directories(folder / "own");
    fs::permissions(folder.path(), fs::perms{0755});
    fs::permissions(folder / "own", fs::perms{0555});
    const bool root = ::geteuid() == 0;  // who may write everywhere
    constexpr uid_t kNobody = 65534;
    if (root) REQUIRE(::seteuid(kNobody) == 0);
    const std::string file = message_of([&] { check_output(folder / "own/new.json"); });
    const std::string deep = message_of([&] { check_output_folder(folder / "own/a/b"); });
    const std::string same = message_of([&] { check_output_folder(folder / "own"); });
    if (root) REQUIRE(::seteuid(0) == 0);
    fs::permissions(folder / "own", fs::perms::owner_all);
    for (const std::string& message : {file, deep, same}) CHECK(contains(message, "to which nothing can be written"));
    CHECK(message_of([&] { check_output_folder(folder / "own/a/b"); }) == "");
}
