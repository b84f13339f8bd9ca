#pragma once
// A small slab with an arm and pins, written into a folder, with its plans.

#include <memory>
#include <string>

#include "files/text.h"
#include "scene/plan.h"
#include "tactile/plan.h"
#include "tests/assets.h"
#include "tests/tactile/slab_phantom.h"
#include "tests/temporary_folder.h"

namespace palpa::test {

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
