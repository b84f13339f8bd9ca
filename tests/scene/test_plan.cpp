#include <algorithm>
#include <doctest/doctest.h>

#include "files/text.h"
#include "scene/plan.h"
#include "scene/tissue.h"
#include "stiffnessmaps/map_file.h"
#include "tests/assets.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

std::vector<std::string> stages_of(const char* scene) {
    const Plan plan = make_plan(read_scene(kAssets / "scenes" / scene, kAssets));
    std::vector<std::string> names;
    for (const auto* stages : {&plan.sample_stages, &plan.frame_stages}) {
        for (const Stage& stage : *stages) {
            names.push_back(name_of(stage.id));
            CHECK_FALSE(stage.fidelity.empty());
            CHECK_FALSE(stage.error.empty());
            CHECK(stage.cost_us > 0.0);
        }
    }
    return names;
}

}  // namespace

TEST_CASE("plan: the known depth of plain tissue ends below the greatest force, which a nodule answers with") {
    const Plan plan = make_plan(read_scene(kAssets / "scenes" / "default.json", kAssets));
    CHECK(plan.zone_N[1] < plan.known_N);
    CHECK(plan.known_N == doctest::Approx(2.94).epsilon(0.03));  // of plain tissue at 7 mm
    CHECK(plan.greatest_force_N > 3.6);
}

TEST_CASE("plan: only what the scene asks for, in the order of the road") {
    using Names = std::vector<std::string>;
    CHECK(stages_of("off.json") == Names{"calibration", "position", "depth", "tangential"});
    CHECK(stages_of("default.json") == Names{"calibration", "position", "depth", "tangential", "display_ratio",
                                             "texture_drag", "surface", "footprint", "crease", "depth_gain"});
    CHECK(stages_of("display-ratio.json") ==
          Names{"calibration", "position", "depth", "tangential", "display_ratio", "surface"});
    CHECK(stages_of("delay.json") == Names{"calibration", "position", "depth", "tangential", "delay", "surface"});
}

TEST_CASE("plan: a person is told what is assumed, derived or scaled") {
    Scene scene = read_scene(kAssets / "scenes/default.json", kAssets);
    scene.force_scale = 2.0;
    const Plan plan = make_plan(scene);
    const std::vector<std::string> notes = notes_of(scene, plan);
    const auto noted = [&](const char* part) {
        return std::any_of(notes.begin(), notes.end(), [&](const std::string& n) { return contains(n, part); });
    };
    CHECK(noted("simulated, not recorded"));
    CHECK(noted("Young's modulus, 47000 Pa, is ASSUMED"));
    CHECK(noted("red, above 25 %, from 1 mm"));
    CHECK(noted("phantom force: the pen's newtons are multiplied by 2"));
    CHECK(noted("derived from the normal force (work argument), not measured"));
    CHECK(std::get<MapTissue>(plan.tissue).smoothing_m == 0.0);  // no noise in a simulation
}

TEST_CASE("plan: a nodule that was placed and detected is asked for once; detected ones count where none was placed") {
    const TemporaryFolder folder;
    Map map = read_map(kAssets / "maps/silicone.map");
    const std::size_t placed = map.nodules.size();
    Nodule again = map.nodules.front();
    again.id = "D1";
    again.placed = false;
    map.nodules.push_back(again);
    write_map(map, folder / "both.map");
    map.nodules = {again};
    write_map(map, folder / "detected.map");
    Scene scene = read_scene(kAssets / "scenes/default.json", kAssets);
    scene.tissue = MapOptions{folder / "both.map"};
    const Plan both = make_plan(scene);
    CHECK(both.nodules.size() == placed);
    CHECK(std::all_of(both.nodules.begin(), both.nodules.end(), [](const Nodule& n) { return n.placed; }));
    CHECK(std::any_of(both.notes.begin(), both.notes.end(), [](const std::string& note) {
        return contains(note, "detected nodules of the map are not asked for");
    }));
    scene.tissue = MapOptions{folder / "detected.map"};
    REQUIRE(make_plan(scene).nodules.size() == 1);
    CHECK(make_plan(scene).nodules[0].id == "D1");
}

TEST_CASE("plan: a map or profile that is not there is named") {
    Scene scene = read_scene(kAssets / "scenes/default.json", kAssets);
    scene.tissue = MapOptions{"none.map"};
    CHECK(contains(message_of([&] { make_plan(scene); }), "none.map: found nothing, expected a map folder"));
    scene.profile = "none.json";
    CHECK(contains(message_of([&] { make_plan(scene); }), "none.json: cannot be read"));
}
