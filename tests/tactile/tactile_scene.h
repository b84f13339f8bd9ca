#pragma once
// A small slab with an arm and pins, written into a folder, with its plans.

#include <memory>
#include <string>

#include "files/text.h"
#include "scene/plan.h"
#include "tactile/plan.h"
#include "tests/assets.h"
#include "tests/temporary_folder.h"

namespace palpa::test {

// 40 x 40 x 20 mm, coarse: a test under sanitizers makes it in a second. 17.5 kPa.
inline constexpr const char* kSlabPhantom = R"({
  "size_mm": [40, 40, 20], "tissue": {"young_Pa": 17500, "poisson": 0.45}, "nodules": [],
  "indenter": {"shape": "sphere", "radius_mm": 8, "contact": "rolling"},
  "depths_mm": [1], "grid": {"origin_mm": [0, 0], "spacing_mm": [1, 1], "count": [2, 2]}})";

inline constexpr const char* kArmAndPins = R"({"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json"}})";

struct TactileScene {
    TemporaryFolder folder;
    scene::Scene scene;
    std::shared_ptr<const scene::Plan> plan;

    explicit TactileScene(const std::string& tactile = kArmAndPins, double stiffness_scale = 1.0) {
        files::write_text_atomically(folder / "slab.json", kSlabPhantom);
        files::write_text_atomically(folder / "scene.json",
                                     R"({"name": "slab", "tissue": {"linear": {"phantom": "slab.json", "spacing_mm": 2},
                "stiffness_scale": )" + files::number_text(stiffness_scale) +
                                         R"(}, "tactile": )" + tactile + "}");
        scene = scene::read_scene(folder / "scene.json", kAssets);
        plan = std::make_shared<const scene::Plan>(scene::make_plan(scene));
    }
    std::shared_ptr<tactile::TactilePlan> tactile_plan() const {
        return std::make_shared<tactile::TactilePlan>(tactile::make_tactile_plan(scene, *plan));
    }
};

}  // namespace palpa::test
