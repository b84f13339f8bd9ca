#include <algorithm>
#include <doctest/doctest.h>

#include "desk/uploads.h"
#include "files/sha256.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::desk;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

const Sender kSender{"tablet", 1, "10.0.0.7"};

Uploads::Incoming::Stored send(const std::string& bytes, Uploads& uploads, const Sender& sender = kSender) {
    const auto incoming = uploads.begin(bytes.size());
    for (std::size_t i = 0; i < bytes.size(); i += 1000) incoming->add(std::string_view(bytes).substr(i, 1000));
    return incoming->finish(sha256_hex(bytes), sender);
}

template <class Call>
int status_of(Call&& call) {
    try {
        call();
    } catch (const UploadRefused& refused) {
        return refused.status;
    }
    return 0;
}

std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}
std::size_t lines_of(const fs::path& file) {
    const std::string text = read_text(file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("uploads: labels become plain") {
    CHECK(sane_label("tablet-3_a.b") == "tablet-3_a.b");
    CHECK(sane_label("../../etc/passwd") == ".._.._etc_passwd");
    CHECK(sane_label("a\tb\n\x1b[2J\xc3\xa4") == "a_b___2J__");
    CHECK(sane_label("") == "unnamed");
    CHECK(sane_label(std::string(500, 'x')).size() == 64);
}

TEST_CASE("uploads: bytes get a name of their own; again they are there already") {
    const TemporaryFolder folder;
    std::vector<std::string> notes;
    Uploads uploads(folder / "in", {}, notes);
    const std::string bytes(5000, 'a');
    const auto first = send(bytes, uploads);
    CHECK(first.fresh);
    CHECK(first.name == sha256_hex(bytes) + ".upload");
    CHECK(read_text(folder / "in" / first.name) == bytes);
    const auto again = send(bytes, uploads);
    CHECK_FALSE(again.fresh);
    CHECK(again.name == first.name);
    CHECK(lines_of(folder / "in" / "index.tsv") == 2);
    send(bytes, uploads, {"other", 2, "10.0.0.8"});  // the same from somebody else is worth a row
    CHECK(lines_of(folder / "in" / "index.tsv") == 3);
    CHECK(contains(read_text(folder / "in" / "index.tsv"),
                   "\t" + first.sha256 + "\t5000\t" + first.name + "\ttablet\t1\t10.0.0.7\n"));
    CHECK(send("", uploads).fresh);
    CHECK(files_in(folder / "in" / "aside") == 0);
}

TEST_CASE("uploads: what is too long, too short, cut off or changed leaves nothing") {
    const TemporaryFolder folder;
    std::vector<std::string> notes;
    UploadLimits limits;
    limits.upload_bytes = 1000;
    limits.total_bytes = 3000;
    Uploads uploads(folder / "in", limits, notes);
    const auto before = uploads.stored_bytes();
    CHECK(status_of([&] { uploads.begin(1001); }) == 413);
    CHECK(status_of([&] { uploads.begin(3)->add("abcd"); }) == 400);
    CHECK(status_of([&] { uploads.begin(3)->finish(sha256_hex(""), kSender); }) == 400);
    CHECK(status_of([&] {
              const auto incoming = uploads.begin(3);
              incoming->add("abc");
              incoming->finish(sha256_hex("abd"), kSender);
          }) == 422);
    uploads.begin(1000)->add("half");
    CHECK(uploads.stored_bytes() == before);
    CHECK(files_in(folder / "in") == 2);
    CHECK(files_in(folder / "in" / "aside") == 0);
    CHECK(lines_of(folder / "in" / "index.tsv") == 1);
    // announced bytes count: two at a time cannot pass the total together
    const auto one = uploads.begin(1000), two = uploads.begin(1000);
    CHECK(status_of([&] { uploads.begin(1000); }) == 507);
}

TEST_CASE("uploads: a full desk answers a repeated upload as one that it has") {
    const TemporaryFolder folder;
    std::vector<std::string> notes;
    UploadLimits limits;
    limits.total_bytes = 2000;
    Uploads uploads(folder / "in", limits, notes);
    const std::string kept(1000, 'a');
    CHECK(send(kept, uploads).fresh);
    const std::uint64_t used = uploads.stored_bytes();
    CHECK(status_of([&] { uploads.begin(1000); }) == 507);
    {
        const auto again = uploads.begin(1000, sha256_hex(kept));
        again->add(kept);
        CHECK_FALSE(again->finish(sha256_hex(kept), kSender).fresh);
    }
    CHECK(uploads.stored_bytes() == used);
    uploads.begin(1000, sha256_hex(kept))->add("cut off");
    CHECK(uploads.stored_bytes() == used);
}

TEST_CASE("uploads: after a kill asides go, and whole files find their row") {
    const TemporaryFolder folder;
    std::vector<std::string> notes;
    std::string name;
    {
        Uploads uploads(folder / "in", {}, notes);
        name = send("first", uploads).name;
    }
    CHECK(notes.empty());
    write_text_atomically(folder / "in" / "aside" / "7.part", "half");
    const std::string orphan = sha256_hex("named, then killed") + ".upload", changed = sha256_hex("x") + ".upload";
    write_text_atomically(folder / "in" / orphan, "named, then killed");
    write_text_atomically(folder / "in" / changed, "y");
    write_text_atomically(folder / "in" / "index.tsv",
                          read_text(folder / "in" / "index.tsv") + "2026-11-21T10:00:00Z\tcut");
    {
        Uploads uploads(folder / "in", {}, notes);
        CHECK(notes.size() == 4);
        CHECK(files_in(folder / "in" / "aside") == 0);
        CHECK_FALSE(send("first", uploads).fresh);
        CHECK(send("second", uploads).fresh);
    }
    const std::string index = read_text(folder / "in" / "index.tsv");
    CHECK(contains(index, orphan));
    CHECK_FALSE(contains(index, changed));
    CHECK(read_text(folder / "in" / changed) == "y");  // whatever it is, it is not ours to remove
    notes.clear();
    Uploads uploads(folder / "in", {}, notes);
    CHECK(notes.size() == 2);  // the line that was cut, and the changed file
    CHECK(contains(message_of([&] { Uploads second(folder / "in", {}, notes); }), "another palpa serve"));
}
