#include <doctest/doctest.h>

#include "files/text.h"
#include "scene/scene.h"
#include "tests/assets.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

Scene tangible_scene(const std::string& tangible) {
    const TemporaryFolder folder;
    files::write_text_atomically(
        folder / "s.json",
        R"({"name": "n", "tissue": {"force_curve": {"stiffness_N_per_mm": 1}}, "tangible": )" + tangible + "}");
    return read_scene(folder / "s.json", kAssets);
}

std::string tangible_refused(const std::string& tangible) {
    return message_of([&] { tangible_scene(tangible); });
}

}  // namespace

TEST_CASE("tangible file: what is absent is not asked for, defaults are the documented ones, every key is read") {
    const TangibleOptions options = *tangible_scene(R"({"device": "strip.json"})").tangible;
    CHECK(options.device == kAssets / "devices" / "strip.json");
    CHECK_FALSE(options.at_m);
    CHECK(options.force_scale == 1.0);
    CHECK(options.depth_scale == 1.0);
    CHECK(options.plant.empty());
    CHECK_FALSE(read_scene(kAssets / "scenes" / "default.json", kAssets).tangible);
    const TangibleOptions all = *tangible_scene(
                                     R"({"device": "strip.json", "at_mm": [10, 20], "force_scale": 2, "depth_scale": 3,
                                         "plant": "exact"})")
                                     .tangible;
    CHECK(all.at_m->isApprox(Eigen::Vector2d(0.01, 0.02)));
    CHECK(all.force_scale == 2.0);
    CHECK(all.depth_scale == 3.0);
    CHECK(all.plant == "exact");
    CHECK_FALSE(tangible_scene(R"({"device": "strip.json", "at_mm": "touch"})").tangible->at_m);
    CHECK(tangible_scene(R"({"device": "s.json", "plant": "fine.json"})").tangible->plant ==
          (kAssets / "plants" / "fine.json").string());
}

TEST_CASE("tangible file: bad input names the key, what was found and what was expected") {
    CHECK(contains(tangible_refused("{}"), "device"));
    CHECK(contains(tangible_refused(R"({"device": "s.json", "at_mm": "here"})"), "touch"));
    CHECK(contains(tangible_refused(R"({"device": "s.json", "at_mm": [1]})"), "at_mm"));
    CHECK(contains(tangible_refused(R"({"device": "s.json", "force_scale": 0})"), "force_scale"));
    CHECK(contains(tangible_refused(R"({"device": "s.json", "plant": 3})"), "plant"));
    CHECK(contains(tangible_refused(R"({"device": "s.json", "plants": "exact"})"), "plants"));
}
