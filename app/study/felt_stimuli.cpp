#include "app/study/felt_stimuli.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "app/study/soft_press.h"
#include "scene/plan.h"
#include "session/tactile_run.h"
#include "session/tactile_run_identify.h"

namespace palpa::app {
namespace {

// Half a period of a sine: there and back.
double force_at_N(const PressHabit& habit, double t_s) {
    return habit.force_N * std::sin(std::numbers::pi * std::clamp(t_s / habit.duration_s, 0.0, 1.0));
}

// The dent that a screen draws under such a press in the middle of the tissue.
std::vector<study::FeltMoment> seen_press(const StudyScene& scene, double stiffness_ratio, const PressHabit& habit) {
    constexpr double kFrame_s = 1.0 / 60.0;
    std::vector<study::FeltMoment> press;
    scene::TissueWork work = make_work(scene.plan->tissue);
    scene::Press asked;
    asked.p_m = scene.plan->area.centre_m;
    asked.down = true;
    asked.stiffness_scale = scene.scene.stiffness_scale * stiffness_ratio;
    for (double t_s = 0.0; t_s <= habit.duration_s; t_s += kFrame_s) {
        asked.force_N = force_at_N(habit, t_s);
        scene::Contact contact;
        answer(scene.plan->tissue, scene::StageId::depth, asked, work, contact);
        press.push_back({asked.force_N, contact.depth_m, 0.0, 0.0});
    }
    return press;
}

// The same press as rows, from above the surface until pins rest.
std::vector<devices::PressRow> rows_of(const Eigen::Vector2d& place_m, const PressHabit& habit) {
    constexpr double kStep_s = 0.005;
    constexpr double kAfter_s = 0.3;
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    std::vector<devices::PressRow> rows;
    for (double t_s = 0.0; t_s <= habit.duration_s + kAfter_s; t_s += kStep_s)
        rows.push_back({t_s, place_m.x(), place_m.y(), kNan, force_at_N(habit, t_s)});
    return rows;
}

scene::Scene stiffer_scene(const StudyScene& scene, double stiffness_ratio) {
    scene::Scene stiffer = scene.scene;
    stiffer.stiffness_scale *= stiffness_ratio;
    return stiffer;
}

// The same press on arm and pins, with simulated devices.
std::vector<study::FeltMoment> felt_press(const StudyScene& scene, double stiffness_ratio, const PressHabit& habit,
                                          const std::optional<tactile::ArmCompensation>& compensation,
                                          std::uint64_t seed) {
    const scene::Scene stiffer = stiffer_scene(scene, stiffness_ratio);
    const std::vector<devices::PressRow> rows = rows_of(scene.plan->area.centre_m, habit);
    const session::TactileRecord record =
        session::run_press(stiffer, *scene.plan, rows, {seed, std::nullopt, compensation});
    std::vector<study::FeltMoment> press;
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        study::FeltMoment moment{record.force_N[i], record.depth_m[i], 0.0,
                                 record.own_shape_per_depth * record.depth_m[i]};
        const auto pins = static_cast<std::size_t>(record.pins);
        if (pins > 0) {
            const auto first = record.height_m.begin() + static_cast<std::ptrdiff_t>(i * pins);
            const auto [low, high] = std::minmax_element(first, first + record.pins);
            moment.shape_m = *high - *low;
        }
        press.push_back(moment);
    }
    return press;
}

}  // namespace

PressHabit draw_habit(study::Random& random) {
    PressHabit habit;
    habit.force_N = std::clamp(2.0 + 0.2 * random.normal(), 1.5, 2.4);
    habit.duration_s = std::clamp(2.5 * std::exp(0.2 * random.normal()), 1.5, 4.0);
    return habit;
}

bool feels_device(const scene::Scene& scene) { return scene.tactile || scene.tangible; }

bool feels_displays(const study::Protocol& protocol, const StudyScenes& scenes, std::size_t condition) {
    const std::size_t on = study::reference_condition_of(protocol, condition).value_or(condition);
    if (!scenes[condition] || !scenes[on]) return false;
    return on != condition || feels_device(scenes[condition]->scene);
}

FeltStimuli::FeltStimuli(const StudyScenes& scenes, const PressHabit& habit, std::uint64_t seed)
    : scenes_(scenes), habit_(habit), seed_(seed) {}

const study::FeltStiffness& FeltStimuli::of(std::size_t condition, double stiffness_ratio) {
    const auto [it, fresh] = felt_.try_emplace({condition, stiffness_ratio});
    if (!fresh) return it->second;
    const StudyScene& scene = *scenes_[condition];
    if (scene.scene.tangible) {
        const scene::Scene stiffer = stiffer_scene(scene, stiffness_ratio);
        PressHabit on_device = habit_;
        on_device.force_N *= scene.scene.tangible->force_scale;
        const auto rows = rows_of(scene.plan->area.centre_m, on_device);
        return it->second = study::feel_soft_surface(press_soft_device(stiffer, *scene.plan, rows, seed_));
    }
    if (!scene.scene.tactile) return it->second = study::feel_by_eye(seen_press(scene, stiffness_ratio, habit_));
    if (!identified_) compensation_ = session::identify_simulated_arm(scene.scene, *scene.plan, seed_);
    identified_ = true;
    return it->second = study::feel_by_hand(felt_press(scene, stiffness_ratio, habit_, compensation_, seed_));
}

}  // namespace palpa::app
