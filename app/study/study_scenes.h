#pragma once
// The scenes that a protocol names, loaded once, and what a trial changes in them.

#include <memory>
#include <vector>

#include "scene/plan.h"
#include "study/order.h"
#include "study/trial_log.h"

namespace palpa::app {

// The scene of a condition. StudyScenes holds one for each condition of the protocol, empty if the condition has none
// (by hand, or forced choices without one).
struct StudyScene {
    scene::Scene scene;
    std::shared_ptr<const scene::Plan> plan;  // turning and flipping do not change it
};
using StudyScenes = std::vector<std::optional<StudyScene>>;

// No browser reports the counts of a pen: trials whose calibration profile reads them would be repeated there for ever. Throws
// InputError that names the condition.
void refuse_counts(const study::Protocol& protocol, const StudyScenes& scenes);

// Notes in the protocol which conditions' answers are typed in, for want of a device that the scene drives.
void note_typed_in(const StudyScenes& scenes, study::Protocol& protocol);

// Loads the scenes. Throws InputError that names the protocol, the condition and what is wrong with its scene, map or
// profile. Conditions with the same scene and profile share one plan.
StudyScenes load_study_scenes(const study::Protocol& protocol);

// Returns the hashes of the files that a trial is made from: profile, and map or phantom.
files::Json identity_of(const std::optional<StudyScene>& scene);
std::vector<files::Json> identities_of(const StudyScenes& scenes);  // by condition; each file is read once

// Returns the label of a trial, for its events and its settings.
study::TrialLabel label_of(const study::Protocol& protocol, const study::PlannedParticipant& who,
                           const study::PlannedTrial& trial, const files::Json& identity);

// Returns the scene as this trial shows it.
scene::Scene scene_of(const StudyScene& scene, const study::PlannedTrial& trial);

}  // namespace palpa::app
