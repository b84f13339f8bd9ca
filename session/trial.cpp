#include "session/trial.h"

#include <cmath>
#include <numbers>

#include "scene/mapping.h"

namespace palpa::session {

study::Target place_of(const stiffnessmaps::Nodule& n) {
    const double angle_rad = n.angle_deg.value_or(0.0) * std::numbers::pi / 180.0;
    return {"", n.x_m, n.y_m, n.diameter_m.value_or(0.0), n.length_m.value_or(0.0), angle_rad};
}

namespace {

std::vector<study::Target> targets_of(const scene::Plan& plan) {
    std::vector<study::Target> targets;
    for (const stiffnessmaps::Nodule& n : plan.nodules) {
        targets.push_back(place_of(n));
        targets.back().id = n.id;
    }
    return targets;
}

void push_point(const PathPoint& point, Trial& trial) {
    if (trial.path.size() == kPathPoints) {  // keeps every second point, and where presses begin
        std::size_t kept = 0;
        for (std::size_t i = 0; i < trial.path.size(); ++i) {
            if (i % 2 == 0 || trial.path[i].begins) trial.path[kept++] = trial.path[i];
        }
        trial.path.resize(std::min(kept, kPathPoints - 1));
        trial.path_step_m *= 2.0;
    }
    trial.path.push_back(point);
}

// A point for each step of the way, and for each that a pen which stays goes deeper or comes up.
void add_to_path(const PressMoment& press, Trial& trial) {
    const bool begins = !trial.pressing || trial.moved_below;
    const auto depth_m = static_cast<float>(press.depth_m);
    if (!begins) {
        PathPoint& last = trial.path.back();
        const auto deeper_m = static_cast<double>(std::abs(depth_m - trial.path_depth_m));
        if (std::max((press.p_m - last.p_m).norm(), deeper_m) < trial.path_step_m) {
            last.depth_m = std::max(last.depth_m, depth_m);
            return;
        }
    }
    trial.path_depth_m = depth_m;
    push_point({press.p_m, depth_m, begins, static_cast<float>(clock_s(trial, trial.now_s))}, trial);
}

// Adds to the way and the impulse while pressing. Motion inside the dead band does not count as way, so that jitter and
// the sampling rate hardly matter.
void measure_press(const PressMoment& press, double now_s, Trial& trial) {
    constexpr double kDeadBand_m = 0.5e-3;
    if (!trial.pressing || trial.moved_below) trial.rope_m = press.p_m;
    if (trial.pressing) {
        const double dt_s = now_s - trial.pressed_at_s;
        trial.pressed_s += dt_s;
        trial.impulse_Ns += 0.5 * dt_s * (trial.pressed_N + press.force_N);
    }
    const double moved_m = (press.p_m - trial.rope_m).norm();
    if (moved_m >= kDeadBand_m) {
        trial.pressed_m += moved_m;
        trial.rope_m = press.p_m;
    }
    trial.max_force_N = std::max(trial.max_force_N, press.force_N);
    trial.pressed_at_s = now_s;
    trial.pressed_N = press.force_N;
}

// A device that reports changes alone says nothing while a press is held: its last force lasts until it is lifted.
void end_press(Trial& trial) {
    if (!trial.pressing) return;
    const double held_s = trial.now_s - trial.pressed_at_s;
    trial.pressed_s += held_s;
    trial.impulse_Ns += held_s * trial.pressed_N;
    trial.pressing = trial.by_device = false;
    PathPoint last = trial.path.back();
    last.begins = false;
    last.t_s = static_cast<float>(clock_s(trial, trial.now_s));
    if (last.t_s > trial.path.back().t_s) push_point(last, trial);  // until then it was held
}

void take_press(const scene::Plan& plan, const PressMoment& press, Trial& trial) {
    const double R_m = plan.indenter_radius_m;
    const double footprint_m = std::sqrt(R_m * std::min(press.depth_m, R_m));  // contact radius by Hertz
    study::cover(press.p_m.x(), press.p_m.y(), footprint_m, press.depth_m, trial.coverage, press.beyond);
    measure_press(press, trial.now_s, trial);
    add_to_path(press, trial);
    trial.moved_below = false;
    trial.pressing = true;
}

void observe_press(const scene::Plan& plan, const platform::Sample& sample, const scene::State& state, Trial& trial) {
    if (!state.answered) return;  // another pointer's sample, or one from the past
    const bool pressing = state.touch.down && state.touch.force_N > 0.0;
    const bool other = pressing && sample.pointer_id != trial.presser;
    if ((!pressing || other) && !trial.by_device) end_press(trial);
    if (!state.touch.down) return;
    trial.presser = sample.pointer_id;
    trial.last_px = Eigen::Vector2d(sample.x_px, sample.y_px);
    if (!trial.touched_s) trial.touched_s = trial.now_s;
    if (pressing)
        take_press(plan, {state.touch.p_m, state.contact.depth_m, state.touch.force_N, state.contact.saturated}, trial);
}

// Stops the clock, or lets it run again. A clock that has not started stays at 0.
void hold_clock(bool pause, Trial& trial) {
    if (pause && !trial.paused_at_s) trial.paused_at_s = trial.now_s;
    if (pause || !trial.paused_at_s) return;
    if (trial.touched_s) trial.paused_s += trial.now_s - std::max(*trial.touched_s, *trial.paused_at_s);
    trial.paused_at_s.reset();
}

void act(const platform::Sample& sample, const scene::State& state, Trial& trial) {
    const auto first = static_cast<int>(platform::Action::confidence_1);
    const int confidence = static_cast<int>(sample.action) - first + 1;
    if (confidence >= 1 && confidence <= 5 && !trial.marks.empty()) trial.marks.back().confidence = confidence;
    if (sample.action == platform::Action::undo && !trial.marks.empty()) trial.marks.pop_back();
    if (sample.action == platform::Action::pause || sample.action == platform::Action::resume)
        hold_clock(sample.action == platform::Action::pause, trial);
    if (sample.action == platform::Action::finish) {
        end_press(trial);
        trial.finished = true;
    }
    if (sample.action != platform::Action::mark || !std::isfinite(sample.x_px + sample.y_px)) return;
    const Eigen::Vector2d p_m = scene::tissue_of_px(state.view, {sample.x_px, sample.y_px});
    if (scene::on_tissue(state.view, p_m))
        trial.marks.push_back({p_m, 0, trial.now_s - trial.began_s, clock_s(trial, trial.now_s)});
}

Finding finding_of(const study::Coverage& coverage, bool found, double deepest_m) {
    if (found) return Finding::found;
    switch (level_of(coverage, deepest_m)) {
        case study::PalpationLevel::none:
            return Finding::not_touched;
        case study::PalpationLevel::light:
            return Finding::too_light;
        case study::PalpationLevel::medium:
        case study::PalpationLevel::deep:
            break;
    }
    return Finding::not_marked;
}

}  // namespace

Trial make_trial(const scene::Plan& plan, TrialMode mode) {
    Trial trial;
    trial.mode = mode;
    const Eigen::Vector2d corner_m = plan.area.centre_m - 0.5 * plan.area.size_m;
    trial.coverage = study::make_coverage(corner_m.x(), corner_m.y(), plan.area.size_m.x(), plan.area.size_m.y(),
                                          plan.greatest_depth_m);
    trial.path.reserve(kPathPoints);
    constexpr std::size_t kMarksWithoutAllocation = 256;
    trial.marks.reserve(kMarksWithoutAllocation);
    return trial;
}

void observe(const scene::Plan& plan, const platform::Sample& sample, const scene::State& state, Trial& trial) {
    if (trial.finished) return;
    if (!trial.began) trial.began_s = trial.now_s = sample.t_host_s;
    trial.began = true;
    trial.now_s = std::max(trial.now_s, sample.t_host_s);
    // the tissue moves below a pen that stays, so that the pen's way begins anew
    if (sample.phase == platform::Phase::ui && sample.action == platform::Action::resize) trial.moved_below = true;
    if (sample.phase == platform::Phase::ui) return act(sample, state, trial);
    observe_press(plan, sample, state, trial);
}

void observe_device(const scene::Plan& plan, const PressMoment& press, double t_host_s, Trial& trial) {
    if (trial.finished || !trial.began) return;
    trial.now_s = std::max(trial.now_s, t_host_s);
    if (!(press.force_N > 0.0)) {
        if (trial.by_device) end_press(trial);
        return;
    }
    if (!trial.touched_s) trial.touched_s = trial.now_s;
    take_press(plan, press, trial);
    trial.by_device = true;
}

double clock_s(const Trial& trial, double now_s) {
    if (!trial.touched_s) return 0.0;
    const double end_s = trial.paused_at_s ? *trial.paused_at_s : trial.finished ? trial.now_s : now_s;
    return std::max(0.0, end_s - *trial.touched_s - trial.paused_s);
}

double mean_force_N(const Trial& trial) { return trial.impulse_Ns / trial.pressed_s; }

Debrief debrief(const scene::Plan& plan, const Trial& trial) {
    Debrief out;
    const std::vector<study::Target> targets = targets_of(plan);
    std::vector<study::MarkedPlace> places;
    for (const Mark& mark : trial.marks) places.push_back({mark.p_m.x(), mark.p_m.y()});
    out.score = study::score_marks(targets, places);
    out.scored = plan.nodules_known;
    if (!out.scored) {  // a mark may well be on a nodule that nobody has named
        out.score.false_positives = 0;
        out.score.ppv = std::nan("");
    }
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const study::DeepestPress deepest = study::deepest_on(trial.coverage, targets[i]);
        out.depth_m.push_back(deepest.depth_m);
        out.beyond.push_back(deepest.beyond);
        out.findings.push_back(finding_of(trial.coverage, out.score.found_by[i] >= 0, out.depth_m.back()));
    }
    out.area = study::shares_of(trial.coverage);
    return out;
}

files::Json trial_json(const scene::Plan& plan, const Trial& trial) {
    const Debrief result = debrief(plan, trial);
    files::Json json;
    json["mode"] = name_of(trial.mode);
    json["finished"] = trial.finished;
    json["duration_s"] = trial.now_s - trial.began_s;
    json["clock_s"] = clock_s(trial, trial.now_s);
    json["tp"] = result.score.true_positives;
    json["fp"] = result.score.false_positives;
    json["fn"] = result.score.false_negatives;
    json["sensitivity"] = files::number_or_null(result.score.sensitivity);
    json["ppv"] = files::number_or_null(result.score.ppv);
    json["path_mm"] = 1e3 * trial.pressed_m;
    json["mean_force_N"] = files::number_or_null(mean_force_N(trial));
    json["marks"] = files::Json::array();
    for (std::size_t i = 0; i < trial.marks.size(); ++i) {
        const Mark& mark = trial.marks[i];
        const study::MarkScore& score = result.score.marks[i];
        constexpr const char* kKinds[] = {"hit", "again", "false"};
        json["marks"].push_back(
            {{"x_mm", 1e3 * mark.p_m.x()},
             {"y_mm", 1e3 * mark.p_m.y()},
             {"confidence", mark.confidence > 0 ? files::Json(mark.confidence) : files::Json(nullptr)},
             {"onset_s", mark.onset_s},
             {"kind", result.scored ? kKinds[static_cast<int>(score.kind)] : "not scored"},
             {"distance_mm", score.target < 0 ? files::Json(nullptr) : files::Json(1e3 * score.distance_m)}});
    }
    json["nodules"] = files::Json::array();
    for (std::size_t i = 0; i < plan.nodules.size(); ++i) {
        json["nodules"].push_back({{"id", plan.nodules[i].id},
                                   {"finding", name_of(result.findings[i])},
                                   {"deepest_mm", 1e3 * result.depth_m[i]}});
    }
    for (const study::PalpationLevel level :
         {study::PalpationLevel::light, study::PalpationLevel::medium, study::PalpationLevel::deep}) {
        json["area_at_least"][name_of(level)] = result.area.at_least[static_cast<int>(level)];
    }
    return json;
}

const char* name_of(TrialMode mode) { return mode == TrialMode::practice ? "practice" : "test"; }

const char* name_of(Finding finding) {
    switch (finding) {
        case Finding::found:
            return "found";
        case Finding::not_touched:
            return "not touched";
        case Finding::too_light:
            return "pressed too lightly";
        case Finding::not_marked:
            return "pressed, not marked";
    }
    return "";
}

}  // namespace palpa::session
