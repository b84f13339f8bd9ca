#pragma once
// The scenes that a protocol names, loaded once; what a trial changes in them.

#include <memory>
#include <vector>

#include "scene/plan.h"
#include "study/order.h"

namespace palpa {

// By condition of the protocol. Empty where there is no scene (by hand, forced choices without one).
struct StudyScene {
    Scene scene;
    std::shared_ptr<const Plan> plan;  // turning and flipping do not change it
};
using StudyScenes = std::vector<std::optional<StudyScene>>;

// Throws InputError that names the protocol, the condition and what is wrong with its scene, map or profile.
StudyScenes load_study_scenes(const Protocol& protocol);

// The scene as this trial shows it.
Scene scene_of(const StudyScene& scene, const PlannedTrial& trial);

}  // namespace palpa
