#include <doctest/doctest.h>
#include <set>

#include "scene/stages.h"

using namespace palpa;
using namespace palpa::scene;

TEST_CASE("stages: the table holds each stage, with a cost and a sentence for each form") {
    std::set<StageId> held;
    for (const StageFigures& row : kStageFigures) {
        CAPTURE(row.error);
        held.insert(row.id);
        CHECK(row.cost_us > 0.0);
        CHECK_FALSE(row.error.empty());
        CHECK(row.per_frame == (row.id >= StageId::surface));
    }
    CHECK(held.size() == kStageCount);
}

TEST_CASE("stages: a stage takes cost and error from its row, and the figures fill the gaps") {
    const Stage stage = stage_of(StageForm::depth_recorded_map, "map m", {"12.5"});
    CHECK(stage.id == StageId::depth);
    CHECK_FALSE(stage.per_frame);
    CHECK(stage.fidelity == "map m");
    CHECK(stage.error ==
          "about 12.5 mN of noise in the map (more where the tissue changes between its places, less where its cells "
          "share recorded ones)");
    CHECK(stage.cost_us == figures_of(StageForm::depth_recorded_map).cost_us);
    CHECK(stage_of(StageForm::surface_nodes, "nodes").per_frame);
}
