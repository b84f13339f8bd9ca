#include <doctest/doctest.h>
#include <limits>

#include "scene/cues.h"
#include "scene/plan.h"
#include "tests/assets.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::scene;
using namespace palpa::test;

TEST_CASE("cues: each grows with depth, and none is drawn without a depth") {
    const DrawnCues cues{0.7, 0.6, 0.5, false};
    const CueValues shallow = cues_at(cues, 4e-3, 1e-3);
    const CueValues deep = cues_at(cues, 4e-3, 6e-3);
    CHECK(shallow.footprint_m == close_to(4.7e-3));
    CHECK(deep.footprint_m == close_to(8.2e-3));
    CHECK(shallow.crease == close_to(0.2));
    CHECK(deep.crease == close_to(0.45));
    CHECK(deep.drawn_depth_m == close_to(9e-3));
    for (const double depth_m : {0.0, -1e-3, std::numeric_limits<double>::quiet_NaN()}) {
        const CueValues none = cues_at(cues, 4e-3, depth_m);
        CHECK(none.footprint_m == 0.0);
        CHECK(none.crease == 0.0);
        CHECK(none.drawn_depth_m == 0.0);
    }
}

TEST_CASE("cues: a strength of zero equals absence") {
    const CueValues none = cues_at({}, 4e-3, 5.3e-3);
    CHECK(none.footprint_m == 0.0);
    CHECK(none.crease == 0.0);
    CHECK(none.drawn_depth_m == 5.3e-3);
}

TEST_CASE("cues: a plan has a stage for each that is asked for, and none for a strength of zero") {
    Scene scene = scene_of_map(kAssets / "maps/silicone.map", kAssets);
    scene.cues = {0.7, 0.0, 0.5, true};
    const Plan plan = make_plan(scene);
    REQUIRE(plan.frame_stages.size() == 3);
    CHECK(plan.frame_stages[1].id == StageId::footprint);
    CHECK(plan.frame_stages[2].id == StageId::depth_gain);
    CHECK(plan.frame_stages[2].error == "drawn 1.5 times as deep as the tissue gives way");
    scene.cues = {0.0, 0.0, 0.0, true};
    CHECK(make_plan(scene).frame_stages.size() == 1);
}
