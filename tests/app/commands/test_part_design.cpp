// `palpa part edit`, `compare` and `export` as a person calls them.

#include <doctest/doctest.h>
#include <filesystem>

#include "files/json.h"
#include "files/text.h"
#include "tests/app/palpa_with.h"
#include "tests/close_to.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

const std::string kShipped = PALPA_SOURCE_DIR "/assets/parts/";
const std::string kBeam = kShipped + "beams/alternating-hshsh.json";

Json json_of(const std::string& arguments) {
    const Called called = palpa_with(arguments + " --json");
    REQUIRE_MESSAGE(called.status == 0, called.err);
    return parse_json(called.out, "stdout");
}

std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

}  // namespace

TEST_CASE("part edit: permute and its inverse give the hash again, the mass changes by V (rho2 - rho1), undo drops") {
    const TemporaryFolder folder;
    const std::string b = quoted(folder / "b.json"), c = quoted(folder / "c.json"), d = quoted(folder / "d.json");
    const std::string box = R"({"box": {"min_mm": [0, 0, 0], "max_mm": [10, 10, 10]}})";
    const Json before = json_of("part info " + kBeam);
    const Json edited =
        json_of("part edit " + kBeam + R"( --op '{"permute": )" + box + R"(, "material": "soft"}' -o )" + b);
    CHECK(edited["changed_voxels"] == Json{8 * 8 * 8});
    CHECK(edited["operations"] == 3);
    const Json after = json_of("part info " + b);
    CHECK(after["runs_sha256"] == edited["runs_sha256"]);
    CHECK(after["runs_sha256"] != before["runs_sha256"]);
    CHECK(after["mass_g"].get<double>() - before["mass_g"].get<double>() ==
          close_to(1.0 * (1.020 - 1.200)).epsilon(1e-9));
    json_of("part edit " + b + R"( --op '{"permute": )" + box + R"(, "material": "hard"}' -o )" + c);
    CHECK(json_of("part info " + c)["runs_sha256"] == before["runs_sha256"]);
    json_of("part edit " + c + " --undo 2 -o " + d);
    CHECK(json_of("part info " + d)["runs_sha256"] == before["runs_sha256"]);
    CHECK(test::contains(palpa_with("part edit " + c + " --undo 1 -o " + d).out, "3 operations"));
}

TEST_CASE("part edit: files are named without a folder, and the input is never replaced") {
    const TemporaryFolder folder;
    const std::filesystem::path here = std::filesystem::current_path();
    std::filesystem::copy_file(kBeam, folder / "a.json");
    const std::string before = read_text(folder / "a.json");
    std::filesystem::current_path(folder.path());
    const Called bare = palpa_with("part edit a.json --undo 1 -o b.json");
    const Called onto = palpa_with("part edit a.json --undo 1 -o a.json");
    std::filesystem::current_path(here);
    CAPTURE(bare.err);
    CHECK(bare.status == 0);
    CHECK(std::filesystem::exists(folder / "b.json"));
    CHECK(onto.status == 2);
    CHECK(read_text(folder / "a.json") == before);
}

TEST_CASE("part edit: what is refused writes nothing") {
    const TemporaryFolder folder;
    const std::string output = " -o " + quoted(folder / "b.json");
    struct Case {
        const char* arguments;
        const char* message;
    };
    for (const Case& c :
         {Case{"--undo 2", "fewer than the 2 operations"}, Case{"--op '{\"remove\": {\"all\": true}}'", "nothing left"},
          Case{"--op '{'", "--op"},
          Case{R"(--op '{"sculpt": {"points_mm": [[1, 2, 99]], "radius_mm": 2}}')", "a volume outside"},
          Case{R"(--op '{"remove": {"box": {"min_mm": [40, 0, 0], "max_mm": [50, 10, 10]}}}')", "2 bodies"}}) {
        CAPTURE(c.arguments);
        const Called called = palpa_with("part edit " + kBeam + " " + c.arguments + output);
        CHECK(called.status == 2);
        CAPTURE(called.err);
        CHECK(test::contains(called.err, c.message));
        CHECK_FALSE(std::filesystem::exists(folder / "b.json"));
    }
}

TEST_CASE("part compare: the alternating and the layered beam, with a figure") {
    const TemporaryFolder folder;
    const std::string other = kShipped + "beams/homogeneous.json";
    const Json json = json_of("part compare " + kBeam + " " + other + " --tolerance 1e-6" +
                              (has_gnuplot() ? " -o " + quoted(folder / "f.svg") : ""));
    CHECK(json["stiffness_ratio"].get<double>() == close_to(1.0044452 / 0.4816322).epsilon(1e-5));
    CHECK(json["mass_ratio"].get<double>() == close_to(12.0 / (0.6 * 12.0 + 0.4 * 10.2)).epsilon(1e-9));
    CHECK(json["switch_force_ratio"].is_null());
    CHECK(json["felt"]["thresholds"][1]["weber_percent"] == close_to(22.0));
    CHECK(json["felt"]["thresholds"][1]["beyond"] == true);
    CHECK(json["a"]["mass_g"].get<double>() == close_to(11.28));
    if (has_gnuplot()) CHECK(std::filesystem::exists(folder / "f.svg"));
    CHECK(test::contains(palpa_with("part compare " + kBeam + " " + kBeam).out, "within the 15 %"));
    const std::string buttons =
        palpa_with("part compare " + kShipped + "button.json " + kShipped + "bare-cover.json --tolerance 0.1").out;
    CHECK(test::contains(buttons, "the spring of its button is left out"));
    CHECK_FALSE(test::contains(buttons, "people can just tell"));
    CHECK_FALSE(test::contains(buttons, "Bare cover: the spring"));
    CHECK(palpa_with("part compare " + kBeam + " " + other + " -o a.gif").status == 2);
    CHECK(palpa_with("part compare " + kBeam + " " + kShipped + "toothbrush-a.json").status == 2);
}

TEST_CASE("part export: 3MF, STL, slices and runs, each with its JSON, and the same bytes again") {
    const TemporaryFolder folder;
    const Json info = json_of("part info " + kBeam);
    const double mm3 = info["volume_mm3"].get<double>();
    for (const char* arguments : {"-o a.3mf", "-o stl --as stl", "-o slices --as slices",
                                  "-o slices2 --as slices --pitch-um 625,625,1250", "-o a.npy"}) {
        CAPTURE(arguments);
        const Called called =
            palpa_with("part export " + kBeam + " " + arguments + " --json", "cd " + folder.path().string() + " &&");
        REQUIRE_MESSAGE(called.status == 0, called.err);
        const Json json = parse_json(called.out, "stdout");
        double sum = 0.0;
        for (const Json& file : json["files"]) {
            CHECK(std::filesystem::exists(folder / file["file"].get<std::string>()));
            sum += file["volume_mm3"].get<double>();
        }
        CHECK(sum == close_to(mm3).epsilon(1e-9));
    }
    palpa_with("part export " + kBeam + " -o b.3mf", "cd " + folder.path().string() + " &&");
    CHECK(read_text(folder / "b.3mf") == read_text(folder / "a.3mf"));
    write_text_atomically(folder / "runs.json", [&] {
        Json part = read_json(kBeam);
        part["shape"] = Json::array({{{"runs", "a.npy"}}});
        return json_text(part);
    }());
    CHECK(json_of("part info " + quoted(folder / "runs.json"))["runs_sha256"] == info["runs_sha256"]);
}

TEST_CASE("part export: wrong usage ends with status 2") {
    const TemporaryFolder folder;
    for (const char* arguments : {"-o a", "-o a.3mf --as stl", "-o a --as obj", "-o a --as stl --pitch-um 1,1,1",
                                  "-o a --as slices --pitch-um 1,1", "-o a --as slices --smooth", "-o a.npy --smooth",
                                  "-o a/a.3mf", "-o a/a.npy", "-o a --as slices --pitch-um 1e5,1e5,1e5"}) {
        CAPTURE(arguments);
        const Called called =
            palpa_with("part export " + kBeam + " " + arguments, "cd " + folder.path().string() + " &&");
        CHECK(called.status == 2);
        CHECK_FALSE(called.err.empty());
        CHECK_FALSE(std::filesystem::exists(folder / "a"));
    }
}
