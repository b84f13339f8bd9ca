#pragma once
// The scenes that a protocol names, loaded once; what a trial changes in them.

#include <memory>
#include <vector>

#include "scene/plan.h"
#include "study/order.h"
#include "study/trial_log.h"

namespace palpa::app {

// The scene of a condition. StudyScenes holds one for each condition of the protocol; it is empty where there is no
// scene (by hand, forced choices without one).
struct StudyScene {
    scene::Scene scene;
    std::shared_ptr<const scene::Plan> plan;  // turning and flipping do not change it
};
using StudyScenes = std::vector<std::optional<StudyScene>>;

// Throws InputError that names the protocol, the condition and what is wrong with its scene, map or profile.
StudyScenes load_study_scenes(const study::Protocol& protocol);

// Hashes of the files that a trial is made from: profile, and map or phantom.
files::Json identity_of(const std::optional<StudyScene>& scene);

// The label of this trial, for its events and its settings.
study::TrialLabel label_of(const study::Protocol& protocol, const study::PlannedParticipant& who,
                           const study::PlannedTrial& trial, const files::Json& identity);

// The scene as this trial shows it.
scene::Scene scene_of(const StudyScene& scene, const study::PlannedTrial& trial);

}  // namespace palpa::app
