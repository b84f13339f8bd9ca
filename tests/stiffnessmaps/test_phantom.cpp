#include <doctest/doctest.h>

#include "files/text.h"
#include "stiffnessmaps/phantom.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

std::string refusal_of_phantom(const std::string& from, const std::string& to) {
    std::string text = read_text(PALPA_SOURCE_DIR "/assets/phantoms/silicone.json");
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json", text);
    return message_of([&] { read_phantom(folder / "p.json"); });
}

}  // namespace

TEST_CASE("phantom: absurd blocks are refused by key") {
    CHECK(refusal_of_phantom("120, 120, 25", "120, 120, 25") == "");
    CHECK(contains(refusal_of_phantom("120, 120, 25", "120, 120"), "size_mm: found an array of 2"));
    CHECK(contains(refusal_of_phantom("0.49, ", "0.5, "), "tissue.poisson: found 0.5"));
    CHECK(contains(refusal_of_phantom("47000", "-1"), "tissue.young_Pa: found -1"));
    CHECK(
        contains(refusal_of_phantom("35, 35, 11", "35, 35, 24"), "nodules[0].centre_mm: found 24 with a radius of 5"));
    CHECK(contains(refusal_of_phantom("\"id\": \"B\"", "\"id\": \"A\""), "nodules[1].id: found 'A' twice"));
    CHECK(contains(refusal_of_phantom("[2, 3, 4, 5, 6, 7]", "[2, 3, 40]"), "depths_mm: found 40"));
    CHECK(contains(refusal_of_phantom("[2, 3, 4, 5, 6, 7]", "[3, 2]"), "expected ascending depths"));
    CHECK(contains(refusal_of_phantom("159, 59", "159.5, 59"), "grid.count: found 159.5"));
    CHECK(contains(refusal_of_phantom("rolling", "jumping"), "indenter.contact: found 'jumping'"));
    CHECK(contains(refusal_of_phantom("\"sphere\"", "\"cylinder\""), "length_mm"));
    CHECK(refusal_of_phantom("\"sphere\"", "\"cylinder\", \"length_mm\": 20") == "");
    CHECK(contains(refusal_of_phantom("\"sphere\"", "\"cylinder\", \"length_mm\": 0"), "indenter.length_mm: found 0"));
    CHECK(contains(refusal_of_phantom("\"sphere\"", "\"sphere\", \"length_mm\": 20"),
                   "indenter.length_mm: found 20, expected none: a sphere has no length"));
}
