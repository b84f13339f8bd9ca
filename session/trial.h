#pragma once
// One trial: a person palpates, marks what feels stiff, says how sure they are, and is shown what was there. Everything
// here follows from the samples, so that a trace replays it.

#include <cstdint>
#include <vector>

#include "files/json.h"
#include "platform/sample.h"
#include "scene/state.h"
#include "study/coverage.h"
#include "study/score.h"

namespace palpa::session {

enum class TrialMode : std::uint8_t { practice, test };  // practice shows the nodules, a test hides them until its end

struct Mark {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    int confidence = 0;    // 1 unsure ... 5 sure; 0 if the person did not say
    double onset_s = 0.0;  // since the trial began
    double clock_s = 0.0;  // of the person's clock
};

struct PathPoint {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    float depth_m = 0.0f;  // greatest depth up to the next point
    bool begins = false;   // the first point of a press
    float t_s = 0.0f;      // of the person's clock
};

struct Trial {
    TrialMode mode = TrialMode::practice;
    bool began = false;
    bool finished = false;
    double began_s = 0.0;               // host time of the first sample
    double now_s = 0.0;                 // latest host time of a sample; stands still once finished
    std::optional<double> touched_s;    // host time of the first touch, when the clock starts
    std::optional<double> paused_at_s;  // host time since when the clock is stopped
    double paused_s = 0.0;              // time between the first touch and now for which the clock was stopped
    std::vector<Mark> marks;
    study::Coverage coverage;
    std::vector<PathPoint> path;  // at most kPathPoints; when full, every second point within a press is dropped
    float path_depth_m = 0.0f;    // of the last point, when it was added
    double path_step_m =
        0.5e-3;             // least distance, along or in depth, between its points; doubles when the path is thinned
    bool pressing = false;  // a press is going on; it ends when the pen leaves the tissue
    std::int64_t presser = 0;  // its pointer; a pen that takes over from a finger begins another
    bool by_device = false;    // that press is of a device that leads, and the pen does not end it
    double pressed_m = 0.0;    // length of the way while pressing, without jitter
    double pressed_s = 0.0;    // time spent pressing
    double impulse_Ns = 0.0;   // integral of the force over that time
    double max_force_N = 0.0;
    bool moved_below = false;  // the tissue moved below the pen since the last sample: its way begins anew
    Eigen::Vector2d rope_m = Eigen::Vector2d::Zero();  // place up to which pressed_m is counted
    double pressed_at_s = 0.0;                         // host time of the last sample that pressed
    double pressed_N = 0.0;                            // its force
    std::optional<Eigen::Vector2d> last_px;            // where the tissue was last touched, which is where a mark goes
};
inline constexpr std::size_t kPathPoints = 20000;

Trial make_trial(const scene::Plan& plan, TrialMode mode);

// Takes one sample, after advance() with the same sample. Does nothing once the trial is finished.
void observe(const scene::Plan& plan, const platform::Sample& sample, const scene::State& state, Trial& trial);

// A press at one moment: its place on the tissue, depth and force; no force: none.
struct PressMoment {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    double depth_m = 0.0;
    double force_N = 0.0;
    bool beyond = false;  // harder than the tissue is known for there: the depth is only the one it is known to
};
// Takes the press of a device that leads, as an arm does, at a host time. Does nothing before the trial has begun and once it is finished.
void observe_device(const scene::Plan& plan, const PressMoment& press, double t_host_s, Trial& trial);

// Returns what the person's clock shows at a host time: the time since the first touch, without pauses. 0 before the
// first touch.
double clock_s(const Trial& trial, double now_s);

// Returns the mean force over the time spent pressing; NaN if no time was.
double mean_force_N(const Trial& trial);

// Whether a nodule was found, and if not, why; for the person.
enum class Finding : std::uint8_t { found, not_touched, too_light, not_marked };

struct Debrief {
    study::Score score;
    bool scored = true;             // false: which nodules there are is not known, so that no mark is right or wrong
    std::vector<Finding> findings;  // of each nodule of the plan
    std::vector<double> depth_m;    // of the deepest press over each nodule
    std::vector<bool> beyond;       // whether that press was beyond the depth to which the tissue is known there
    study::CoverageShares area;
};
Debrief debrief(const scene::Plan& plan, const Trial& trial);

// Where a nodule is, for study/score.h; without its id.
study::Target place_of(const stiffnessmaps::Nodule& nodule);

// Returns what `palpa run --json` reports of a trial.
files::Json trial_json(const scene::Plan& plan, const Trial& trial);

const char* name_of(TrialMode mode);
const char* name_of(Finding finding);

}  // namespace palpa::session
