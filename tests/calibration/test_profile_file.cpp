#include "calibration/profile_file.h"

#include <doctest/doctest.h>

#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::test;

namespace {

std::string with(const std::string& from, const std::string& to) {
    std::string text = R"({"device": {"pen": "p"}, "model": "exponential", "parameters": {"a_N": 0.1, "b": 4.2},
                          "level": "pressure", "level_range": [0, 1]})";
    if (const auto at = text.find(from); !from.empty() && at != std::string::npos) text.replace(at, from.size(), to);
    return text;
}

std::string said(const std::string& text) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json", text);
    return message_of([&] { read_profile(folder / "p.json"); });
}

}  // namespace

TEST_CASE("hard case 3: profiles that are no usable curve are refused by key") {
    CHECK(said(with("", "")) == "");
    CHECK(contains(said(with("0.1", "-0.1")), "p.json: parameters.a_N: found -0.1"));
    CHECK(contains(said(with("4.2", "0")), "parameters.b: found 0"));
    CHECK(contains(said(with("4.2", "null")), "parameters.b: found null"));
    CHECK(contains(said(with("[0, 1]", "[1, 0]")), "expected the lower level first"));
    CHECK(contains(said(with("[0, 1]", "[0, 0]")), "expected the lower level first"));
    CHECK(contains(said(with("[0, 1]", "[0, 1023]")), "N at the highest level"));
    CHECK(contains(said(with("exponential", "linear")), "model: found 'linear'"));
    CHECK(contains(said(with("\"pressure\"", "\"force\"")), "level: found 'force'"));
    CHECK(contains(said(with("\"pressure\"", "\"contact_area\"")), "full_contact_area_px2: found nothing"));
    CHECK(contains(said(with("4.2}", "4.2")), "p.json"));
    CHECK(contains(said(with("\"model\"", "\"modle\": 1, \"model\"")), "modle: found an unknown key"));
}

TEST_CASE("profile file: points need as many levels as forces") {
    const std::string points = R"("points": {"level": [0, 0.5], "force_N": [0.1]}, "model")";
    CHECK(contains(said(with("\"model\"", points)), "points.force_N: found an array of 1, expected an array of 2 numbers"));
}
