#pragma once
// What simulated participants feel of a surface, where it depends on how it is displayed: on an arm and pins, on a soft
// device, or as a dent on a screen. The displays are run, with simulated devices in virtual time, and so their faults are
// felt too: pins at the end of their stroke, servos that are late, friction of the arm, a soft device at its limits.

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "app/study/study_scenes.h"
#include "session/tactile_run_identify.h"
#include "study/simulated_touch.h"

namespace palpa::app {

// How a simulated person presses: to this force and back, so fast. ASSUMED: below the 2.5 N that practice teaches.
struct PressHabit {
    double force_N = 2.0;
    double duration_s = 2.5;
};
PressHabit draw_habit(study::Random& random);

// True if what this scene shows is felt on a device, and not only seen.
bool feels_device(const scene::Scene& scene);

// True if the answers to pairs of this condition follow from what the displays show: both its surfaces have a scene,
// and either of them is on driven devices, or they are on different displays (choice.reference_on).
bool feels_displays(const study::Protocol& protocol, const StudyScenes& scenes, std::size_t condition);

// The surfaces of one simulated participant, each displayed once. The arm is identified and compensated before the first
// press, as palpa tactile identify does.
class FeltStimuli {
  public:
    // `scenes` must outlive this. seed: of the simulated devices.
    FeltStimuli(const StudyScenes& scenes, const PressHabit& habit, std::uint64_t seed);

    // The scene of this condition, so many times as stiff. Needs a scene.
    const study::FeltStiffness& of(std::size_t condition, double stiffness_ratio);

  private:
    const StudyScenes& scenes_;
    PressHabit habit_;
    std::uint64_t seed_;
    bool identified_ = false;
    std::optional<tactile::ArmCompensation> compensation_;
    std::map<std::pair<std::size_t, double>, study::FeltStiffness> felt_;
};

}  // namespace palpa::app
