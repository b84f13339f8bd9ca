#include <doctest/doctest.h>
#include <string>

#include "files/input_error.h"
#include "tangible/device_file.h"
#include "tests/assets.h"

using namespace palpa;
using namespace palpa::tangible;

namespace {

// The message with which a changed device of the assets is refused; "" if it is not.
std::string refusal(const char* file, const char* patch) {
    files::Json json = files::read_json(test::kAssets / "devices" / file);
    json.merge_patch(files::Json::parse(patch));
    json.erase("wires");  // its names need not fit here
    try {
        parse_soft_device(json, "bad.json", test::kAssets / "devices");
    } catch (const files::InputError& error) {
        return error.what();
    }
    return "";
}

bool has(const std::string& message, const char* part) { return message.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("device files: the strip and the accordion have the paper's counts") {
    const SoftDevice strip = read_soft_device(test::kAssets / "devices" / "strip.json");
    CHECK(strip.body.body.mesh.nodes_m.cols() == 765);
    CHECK(strip.body.body.mesh.cells.cols() == 400);
    const SoftDevice accordion = read_soft_device(test::kAssets / "devices" / "accordion.json");
    CHECK(std::abs(static_cast<double>(accordion.body.body.mesh.nodes_m.cols()) / 858.0 - 1.0) < 0.03);
    CHECK(std::abs(static_cast<double>(accordion.body.body.mesh.cells.cols()) / 2743.0 - 1.0) < 0.03);
    CHECK(accordion.actuators.size() == 4);
}

TEST_CASE("device files: each way to be wrong names file, key, what was found and what was expected") {
    struct Bad {
        const char* file;
        const char* patch;
        const char* key;
        const char* found;
    };
    for (
        const Bad& bad :
        {Bad{"strip.json", R"({"lenght_mm": 3})", "lenght_mm", ""},
         Bad{"strip.json",
             R"({"cables": [{"name": "left", "path": [{"at_mm": [0, 0, 30]}, {"guide_mm": [0, 0, 60]}], "upper_N": 5},
                                          {"name": "right", "path": [{"face": "xmax"}, {"guide_mm": [90, 0, -40]}], "upper_N": 5}]})",
             "cables[0].path[0].at_mm", "away from the body"},
         Bad{"strip.json",
             R"({"cables": [{"name": "left", "path": [{"face": "xmin"}, {"guide_mm": [-90, 0, -40]}], "lower_N": 6, "upper_N": 5},
                                          {"name": "right", "path": [{"face": "xmax"}, {"guide_mm": [90, 0, -40]}], "upper_N": 5}]})",
             "lower_N", "6"},
         Bad{"accordion.json",
             R"({"supports": null, "cavities": [{"name": "air", "face": "inside", "upper_Pa": 5000}]})", "cavities",
             "open cavity"},
         Bad{"accordion.json", R"({"ties": [{"actuators": ["front", "air"], "force": true}]})", "ties",
             "tied to the cavity"},
         Bad{"accordion.json", R"({"ties": [{"actuators": ["front", "behind"], "force": true}]})", "ties", "behind"},
         Bad{"strip.json", R"({"effector": {"centre_mm": [80, 0]}})", "effector", "beside the body"},
         Bad{"strip.json", R"({"materials": {"silicone": null, "gel": {"young_Pa": 1000, "poisson": 0.4}}})",
             "materials", "linear"}}) {
        CAPTURE(bad.patch);
        const std::string message = refusal(bad.file, bad.patch);
        CAPTURE(message);
        CHECK(has(message, "bad.json"));
        CHECK(has(message, bad.key));
        CHECK(has(message, bad.found));
        CHECK(has(message, "expected"));
    }
    CHECK(refusal("strip.json", "{}").empty());
}
