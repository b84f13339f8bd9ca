#pragma once
// One trial: a person palpates, marks what feels stiff, says how sure they are, and is shown what was there. All of it
// follows from the samples, so a trace replays it.

#include <cstdint>
#include <vector>

#include "files/json.h"
#include "platform/sample.h"
#include "scene/state.h"
#include "study/coverage.h"
#include "study/score.h"

namespace palpa::session {

enum class TrialMode : std::uint8_t { practice, test };  // nodules shown, or hidden until the end

struct Mark {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    int confidence = 0;  // 1 unsure ... 5 sure; 0: not said
    double onset_s = 0.0;
};

struct PathPoint {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    float depth_m = 0.0f;
    bool begins = false;  // of a press
};

struct Trial {
    TrialMode mode = TrialMode::practice;
    bool began = false;
    bool finished = false;
    double began_s = 0.0;  // host time of the first sample
    double now_s = 0.0;    // host time of the last sample; stands still once finished
    std::vector<Mark> marks;
    study::Coverage coverage;
    std::vector<PathPoint> path;  // at most kPathPoints; thinned by half when full
    double path_step_m = 0.5e-3;
    bool pressing = false;
    double pressed_m = 0.0;  // way while pressing, jitter left out
    double pressed_s = 0.0;
    double impulse_Ns = 0.0;  // force over that time
    double max_force_N = 0.0;
    Eigen::Vector2d rope_m = Eigen::Vector2d::Zero();
    double pressed_at_s = 0.0;  // time of the last sample that pressed
    double pressed_N = 0.0;
    std::optional<Eigen::Vector2d> last_px;  // where the tissue was last pressed: where a mark goes
};
inline constexpr std::size_t kPathPoints = 20000;

Trial make_trial(const scene::Plan& plan, TrialMode mode);

// Call it after advance() with the same sample.
void observe(const scene::Plan& plan, const platform::Sample& sample, const scene::State& state, Trial& trial);

// Over the time that the pen presses; NaN if it never did.
double mean_force_N(const Trial& trial);

// Why a nodule was found or not, for the person.
enum class Finding : std::uint8_t { found, not_touched, too_light, not_marked };

struct Debrief {
    study::Score score;
    std::vector<Finding> findings;  // by nodule
    std::vector<double> depth_m;    // deepest press over each nodule
    study::CoverageShares area;
};
Debrief debrief(const scene::Plan& plan, const Trial& trial);

// What `run --json` reports of a trial.
files::Json trial_json(const scene::Plan& plan, const Trial& trial);

const char* name_of(TrialMode mode);
const char* name_of(Finding finding);

}  // namespace palpa::session
