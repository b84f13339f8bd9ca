// What the pixels of the app's own frames say about the shipped scenes.

#include <doctest/doctest.h>
#include <filesystem>
#include <string>

#include "files/json.h"
#include "files/text.h"
#include "tests/app/palpa_with.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

const std::string kScenes = PALPA_SOURCE_DIR "/assets/scenes/";
const std::string kSmall = " --width-px 640 --height-px 400";

// It draws some 80 frames, a few seconds of computing, which a busy machine stretches.
Json visibility(const std::string& arguments) {
    const Called called = shell("timeout 250 " PALPA_PROGRAM " bench visibility " + arguments + " --json");
    CHECK(called.err.empty());
    REQUIRE(called.status == 0);
    return parse_json(called.out, "stdout");
}

}  // namespace

TEST_CASE("bench visibility: in the training scene every nodule is seen under 1, 2 and 3 N, and nothing beside them") {
    for (const char* force_N : {"1", "2", "3"}) {
        CAPTURE(force_N);
        const bool small = std::string(force_N) != "2";  // a quarter of the pixels, in a quarter of the time
        const Json seen = visibility((small ? kSmall : "") + " --force-N " + force_N);
        REQUIRE(seen["nodules"].size() == 3);
        for (const Json& nodule : seen["nodules"]) {
            CAPTURE(nodule.dump());
            CHECK(nodule["visible"] == true);
            // what the pixels say is what the avatar does, so many px for each mm; deep in a dent its shading, which moves
            // with it, is taken for up to half as much again
            const double moved_mm = nodule["motion_px"].get<double>() / (small ? 3.14 : 6.27);
            CHECK(moved_mm > 0.85 * nodule["lag_mm"].get<double>());
            CHECK(moved_mm < (std::string(force_N) == "3" ? 1.5 : 1.15) * nodule["lag_mm"].get<double>());
        }
        CHECK(seen["beside_visible"] == false);
    }
}

TEST_CASE("bench visibility: a finger sees them by the texture that it drags along") {
    const Json seen = visibility(kSmall + " --finger");
    for (const Json& nodule : seen["nodules"]) CHECK(nodule["visible"] == true);
    CHECK(seen["beside_visible"] == false);
}

TEST_CASE("bench visibility: without effects nothing is seen, and the picture is still") {
    const Json seen = visibility(kScenes + "off.json" + kSmall);
    for (const Json& nodule : seen["nodules"]) {
        CHECK(nodule["visible"] == false);
        CHECK(nodule["motion_px"] == 0.0);
        CHECK(nodule["depth_change"].get<double>() > 0.05);
    }
}

TEST_CASE("bench visibility: a larger or nearer screen shows the same motion at a larger angle; frames can be kept") {
    const TemporaryFolder folder;
    const std::string small = kScenes + "display-ratio.json" + kSmall;
    const Json far = visibility(small + " --pictures " + (folder / "p").string());
    const Json near = visibility(small + " --distance-cm 20");
    const auto angle = [](const Json& seen) { return seen["nodules"][0]["motion_arcmin"].get<double>(); };
    CHECK(angle(far) > 1.0);
    CHECK(angle(near) == close_to(2.0 * angle(far)).epsilon(1e-3));
    CHECK(std::filesystem::file_size(folder / "p/A-with.png") > 1000);
    CHECK(read_text(folder / "p/A-with.png") != read_text(folder / "p/A-without.png"));
}

TEST_CASE("bench visibility: --help tells how the strokes and the screen are set") {
    const Called help = palpa_with("bench visibility --help");
    CHECK(help.status == 0);
    CHECK(contains(help.out, "Usage: palpa bench visibility"));
    for (const char* option :
         {"--force-N", "--speed-mm-per-s", "--distance-cm", "--px-per-mm", "--finger", "--pictures"})
        CHECK(contains(help.out, option));
}

TEST_CASE("bench visibility: a force that the profile cannot reach is refused") {
    const Called called = palpa_with("bench visibility --force-N 8");
    CHECK(called.status == 2);
    CHECK(contains(called.err, "--force-N: found 8, expected at most 6.777, the greatest force of the profile s-pen"));
    const Called nothing = palpa_with("bench visibility button");
    CHECK(nothing.status == 2);
    CHECK(contains(nothing.err, "found a tissue without nodules"));
}

TEST_CASE("bench visibility: Ctrl-C ends it, as it does any command that keeps nothing") {
    CHECK(
        shell("timeout --preserve-status -s INT 4 " PALPA_PROGRAM " bench visibility --width-px 2560 --height-px 1600")
            .status == 130);
}
