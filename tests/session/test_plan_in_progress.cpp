#include <doctest/doctest.h>
#include <stdlib.h>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "session/plan_in_progress.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::mechanics;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::test;

namespace {

struct SmallBlock {
    TemporaryFolder folder;
    Scene scene;
    SmallBlock() {
        ::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
        write_text_atomically(folder / "b.json", R"({"size_mm": [40, 40, 20],
            "tissue": {"young_Pa": 20000, "poisson": 0.45},
            "indenter": {"shape": "sphere", "radius_mm": 10, "contact": "rolling"},
            "depths_mm": [1], "grid": {"origin_mm": [0, 0], "spacing_mm": [1, 1], "count": [2, 2]}})");
        scene.tissue = LinearOptions{folder / "b.json", 4e-3, std::nullopt};
        scene.profile = PALPA_SOURCE_DIR "/assets/profiles/s-pen.json";
    }
};

}  // namespace

TEST_CASE("prepare: a plan made in a worker thread is told how far it is, then taken") {
    const SmallBlock block;
    PlanInProgress work(block.scene);
    double share = 0.0;
    while (!work.wait(0.001)) {
        CHECK(work.share() >= share);
        share = work.share();
    }
    const Plan plan = work.take();
    CHECK(std::get<LinearTissue>(plan.tissue).compliance.n_touch == 11 * 11);
}

TEST_CASE("prepare: stopped at once, or left alone, it ends in order") {
    const SmallBlock block;
    {
        PlanInProgress work(block.scene);
        work.cancel();
        CHECK_THROWS_AS(work.take(), mechanics::Cancelled);
    }
    { PlanInProgress abandoned(block.scene); }
}

TEST_CASE("prepare: what cannot be prepared is thrown where the plan is taken") {
    SmallBlock block;
    block.scene.profile = "none.json";
    PlanInProgress work(block.scene);
    CHECK_THROWS_AS(work.take(), InputError);
}
