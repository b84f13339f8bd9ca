#include "scene/advance.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpa::scene {
namespace {

constexpr double kLightest_N = 0.5;  // TangentialOptions::per_newton takes no force for less, which would raise noise
constexpr double kLongestGap_s = 60.0;  // of which every grid step is taken
// As a share of the profile's range: no hand presses that hard by the first sample of a touch.
constexpr double kUnbelievable = 0.9;

bool has_sensor(platform::Tool tool) { return tool == platform::Tool::pen || tool == platform::Tool::finger; }

bool is_touching(platform::Phase phase) { return phase == platform::Phase::down || phase == platform::Phase::move; }

void calibrate(const Scene& scene, const Plan& plan, const platform::Sample& sample, State& state) {
    state.touch.force_N = 0.0;
    if (!is_touching(sample.phase) || device_leads(scene)) return;
    double level = calibration::level_of(plan.profile, sample);
    if (std::isnan(level) && !has_sensor(sample.tool)) {
        // a mouse and keys have a simulated pressure, 0 ... 1, which stands for a share of the profile's range
        level = plan.profile.level_lowest + sample.pressure * (plan.profile.level_highest - plan.profile.level_lowest);
    }
    state.without_level = std::isnan(level);
    if (state.without_level) {
        ++state.counters.without_level;
        return;
    }
    // Some pens report full pressure in their first sample, whatever the force.
    const double believable =
        plan.profile.level_lowest + kUnbelievable * (plan.profile.level_highest - plan.profile.level_lowest);
    if (sample.phase == platform::Phase::down && has_sensor(sample.tool) && level > believable) {
        ++state.counters.distrusted;
        return;
    }
    state.touch.force_N = scene.force_scale * force_N(plan.profile, level, state.counters.levels_clamped);
}

void place(const platform::Sample& sample, State& state) {
    if (std::isfinite(sample.x_px) && std::isfinite(sample.y_px)) {
        state.touch.p_m = tissue_of_px(state.view, {sample.x_px, sample.y_px});
    }
    state.touch.down = is_touching(sample.phase) && on_tissue(state.view, state.touch.p_m);
    if (is_touching(sample.phase) && !state.touch.down) {
        ++state.counters.off_tissue;
        state.touch.force_N = 0.0;
    }
}

void ask(StageId stage, const Scene& scene, const Plan& plan, State& state) {
    const Press press{state.touch.p_m, state.touch.force_N, state.heading, state.touch.down, scene.stiffness_scale};
    answer(plan.tissue, stage, press, state.tissue, state.contact);
}

void sink(const Scene& scene, const Plan& plan, State& state) {
    state.contact = Contact{};
    state.contact.time_s = state.timeline.now_s;
    state.contact.p_m = state.touch.p_m;
    if (state.touch.down) state.contact.normal_N = state.touch.force_N;
    ask(StageId::depth, scene, plan, state);
    state.counters.saturated += state.contact.saturated;
    state.counters.unmeasured += !state.contact.measured;
}

void rub(const Scene& scene, const Plan& plan, State& state) {
    ask(StageId::friction, scene, plan, state);
    state.counters.skipped_slides += state.contact.skipped_slides;
}

void turn(const Scene& scene, State& state) {
    if (!state.touch.down) {
        state.heading.setZero();
        state.heading_rope_m = state.touch.p_m;
        return;
    }
    const double dead_band_m = path_of(scene).dead_band_m;  // so that jitter does not turn the heading
    const Eigen::Vector2d v = state.touch.p_m - state.heading_rope_m;
    const double length_m = v.norm();
    if (!(length_m > dead_band_m)) return;
    state.heading = v / length_m;
    state.heading_rope_m = state.touch.p_m - dead_band_m * state.heading;
}

void resist(const Scene& scene, const Plan& plan, State& state) {
    turn(scene, state);
    ask(StageId::tangential, scene, plan, state);
}

avatar::Touch timed(const State& state) {
    avatar::Touch touch = state.touch;
    touch.t_s = state.timeline.now_s;
    return touch;
}

void lag(const Scene& scene, const Plan& plan, State& state) {
    const auto rise = [&](const Eigen::Vector2d& p_m, const Eigen::Vector2d& u, double force_N, double reference_m) {
        const double df_N = rise_N(plan.tissue, {p_m, u, force_N, reference_m, scene.stiffness_scale}, state.tissue);
        return scene.tangential.per_newton ? df_N / std::max(force_N, kLightest_N) : df_N;
    };
    std::int64_t& skipped = state.counters.skipped_stations;
    skipped = 0;
    if (state.display_ratio) {
        state.avatar.lag_m =
            avatar::advance_lag(*scene.display_ratio, timed(state), rise, *state.display_ratio, plan.stations);
        skipped += state.display_ratio->path.skipped_stations;
    }
    if (state.delay) {
        const avatar::Delayed delayed =
            avatar::advance_lag(*scene.delay, timed(state), rise, *state.delay, plan.stations);
        state.avatar.lag_m = delayed.lag_m;
        state.avatar.delay_s = delayed.tau_s;
        skipped += state.delay->path.skipped_stations;
    }
}

void drag_texture(const Scene& scene, const State& state, Avatar& avatar) {
    const bool finger = state.touch.down && state.pointer_tool == platform::Tool::finger;
    avatar.texture_m =
        finger ? Eigen::Vector2d(scene.texture_drag->strength * avatar.lag_m) : Eigen::Vector2d(0.0, 0.0);
    avatar.lag_m -= avatar.texture_m;
}

void run_stage(StageId id, const Scene& scene, const Plan& plan, const platform::Sample& sample, State& state) {
    switch (id) {
        case StageId::calibration:
            return calibrate(scene, plan, sample, state);
        case StageId::position:
            return place(sample, state);
        case StageId::depth:
            return sink(scene, plan, state);
        case StageId::friction:
            return rub(scene, plan, state);
        case StageId::tangential:
            return resist(scene, plan, state);
        case StageId::display_ratio:
        case StageId::delay:
            return lag(scene, plan, state);
        case StageId::texture_drag:
            return drag_texture(scene, state, state.avatar);
        case StageId::surface:
        case StageId::footprint:
        case StageId::crease:
        case StageId::depth_gain:
            return;  // run once per frame, in surface_now()
    }
}

void note_extremes(const Avatar& avatar, double t_s, State& state) {
    if (state.contact.normal_N > state.extremes.force_N) {
        state.extremes.force_N = state.contact.normal_N;
        state.extremes.force_at_s = t_s;
    }
    state.extremes.depth_m = std::max(state.extremes.depth_m, state.contact.depth_m);
    const double lag_m = seen_lag_m(avatar);
    if (lag_m > state.extremes.lag_m) {
        state.extremes.lag_m = lag_m;
        state.extremes.lag_at_s = t_s;
    }
}

// The avatar's laws are exact at any time, so a grid step only has to note how far the avatar lags.
void run_grid_stage(StageId id, const Scene& scene, double t_s, State& state) {
    if (id == StageId::display_ratio || id == StageId::delay) note_extremes(avatar_at(scene, state, t_s), t_s, state);
}

// Takes the grid steps since the last sample, up to and including `to_s`, whether or not something touches. Steps that
// are left out while nothing touches do not count as dropped, since no tissue moved.
void walk_grid(const Scene& scene, const Plan& plan, double to_s, State& state) {
    constexpr double kMostSteps = 1e15;
    const auto last = static_cast<std::int64_t>(std::min((to_s - state.grid_began_s) * kGrid_Hz, kMostSteps));
    constexpr auto kMost = static_cast<std::int64_t>(kLongestGap_s * kGrid_Hz);
    const std::int64_t due = last - state.grid_step;
    const std::int64_t skipped = std::max<std::int64_t>(0, due - kMost);
    if (state.touch.down) state.counters.dropped_steps += skipped;
    state.counters.steps += due - skipped;
    for (std::int64_t step = state.grid_step + skipped + 1; step <= last && !plan.grid_stages.empty(); ++step) {
        const double t_s = state.grid_began_s + static_cast<double>(step) / kGrid_Hz;
        for (const StageId id : plan.grid_stages) run_grid_stage(id, scene, t_s, state);
    }
    state.grid_step = last;
}

void run_stages(const Scene& scene, const Plan& plan, const platform::Sample& sample, State& state) {
    const bool time = state.time_every > 0 && state.counters.samples % state.time_every == 0;
    if (!time) {
        for (const Stage& stage : plan.sample_stages) {
            run_stage(stage.id, scene, plan, sample, state);
            state.meters[static_cast<std::size_t>(stage.id)].count();
        }
        return;
    }
    std::int64_t before_ns = steady_ns();
    for (const Stage& stage : plan.sample_stages) {
        run_stage(stage.id, scene, plan, sample, state);
        const std::int64_t after_ns = steady_ns();
        Meter& meter = state.meters[static_cast<std::size_t>(stage.id)];
        meter.count();
        meter.add_ns(static_cast<double>(after_ns - before_ns));
        before_ns = after_ns;
    }
}

void note_palm(std::int64_t pointer_id, Palms& palms) {
    const auto end = palms.pointers.begin() + static_cast<std::ptrdiff_t>(palms.count);
    if (std::find(palms.pointers.begin(), end, pointer_id) != end || palms.count == palms.pointers.size()) return;
    palms.pointers[palms.count++] = pointer_id;
}

// Returns whether the sample belongs to a noted palm. The lift of a palm still does and ends the note; a new touch of
// the same pointer ends the note and does not.
bool is_palm(const platform::Sample& sample, Palms& palms) {
    for (std::size_t i = 0; i < palms.count; ++i) {
        if (palms.pointers[i] != sample.pointer_id) continue;
        if (sample.phase != platform::Phase::move) palms.pointers[i] = palms.pointers[--palms.count];
        return sample.phase != platform::Phase::down;
    }
    return false;
}

// Ends the touch of a finger because a pen comes down: the finger may be of the hand that holds the pen.
void take_over(const Scene& scene, const Plan& plan, State& state) {
    platform::Sample end;
    end.pointer_id = *state.pointer;
    end.tool = platform::Tool::finger;
    end.phase = platform::Phase::cancel;
    end.x_px = end.y_px = platform::kMissing;  // the touch ends where it was last
    run_stages(scene, plan, end, state);
    note_palm(*state.pointer, state.palms);
    ++state.counters.palms;
    state.pointer.reset();
}

// Decides whether the stages run for this sample, and says so in state.answered: only one pointer presses at a time.
void follow_pointer(const Scene& scene, const Plan& plan, const platform::Sample& sample, State& state) {
    const bool touching = is_touching(sample.phase);
    const bool finger_presses = state.pointer && state.pointer_tool == platform::Tool::finger;
    const bool pen_presses = state.pointer && state.pointer_tool == platform::Tool::pen;
    if (touching && sample.tool == platform::Tool::pen && finger_presses) take_over(scene, plan, state);
    state.answered = false;
    if (is_palm(sample, state.palms)) return;
    if (touching && sample.tool == platform::Tool::finger && pen_presses) note_palm(sample.pointer_id, state.palms);
    if (touching && !state.pointer) {
        state.pointer = sample.pointer_id;
        state.pointer_tool = sample.tool;
    }
    state.answered = !state.pointer || *state.pointer == sample.pointer_id;
    if (state.answered && !touching) state.pointer.reset();
}

ScreenArea area_of(const platform::Sample& resize, const State& state) {
    return {resize.width_px, resize.height_px, resize.x_px, resize.y_px, state.screen.px_per_m};
}

}  // namespace

void put_on_screen(const Scene& scene, const Plan& plan, const ScreenArea& screen, State& state) {
    constexpr double kMost_px = 1e6;
    const bool sized =
        screen.width_px >= 1.0 && screen.height_px >= 1.0 && screen.width_px < kMost_px && screen.height_px < kMost_px;
    if (!sized || !(std::abs(screen.x_px) < kMost_px && std::abs(screen.y_px) < kMost_px)) return;
    state.screen = screen;
    state.view = make_view(scene.mapping, plan.area, screen);
}

State start(const Scene& scene, const Plan& plan, const ScreenArea& screen) {
    State state;
    put_on_screen(scene, plan, screen, state);
    if (scene.display_ratio) state.display_ratio.emplace();
    if (scene.delay) state.delay.emplace();
    state.tissue = make_work(plan.tissue);
    return state;
}

void advance(const Scene& scene, const Plan& plan, const platform::Sample& sample, State& state) {
    ++state.counters.samples;
    state.answered = false;
    if (sample.phase == platform::Phase::ui) {
        if (sample.action == platform::Action::resize) put_on_screen(scene, plan, area_of(sample, state), state);
        if (sample.action == platform::Action::method) state.method = next_method(plan.tissue, state.tissue);
        return;
    }
    if (!std::isfinite(sample.x_px) || !std::isfinite(sample.y_px)) {
        ++state.counters.not_numbers;
        if (is_touching(sample.phase)) return;  // a lift counts without a position
    }
    const bool first = !state.timeline.started;
    const bool in_order = platform::move_to(sample, state.timeline);
    // a lift from the past counts, as one at the present time
    if (!in_order && is_touching(sample.phase)) return;
    if (first) state.grid_began_s = state.timeline.now_s;
    walk_grid(scene, plan, state.timeline.now_s, state);
    follow_pointer(scene, plan, sample, state);
    if (!state.answered) return;
    run_stages(scene, plan, sample, state);
    state.counters.inexact += state.contact.inexact;
    state.avatar.p_m = state.touch.p_m - state.avatar.lag_m;
    note_extremes(state.avatar, state.timeline.now_s, state);
}

Avatar avatar_at(const Scene& scene, const State& state, double t_s) {
    Avatar avatar = state.avatar;
    if (!state.touch.down) return avatar;
    if (state.display_ratio) {
        const double left = avatar::pause_factor(*scene.display_ratio, *state.display_ratio, state.timeline.now_s, t_s);
        avatar.lag_m *= left;
        avatar.texture_m *= left;
    }
    if (state.delay) {
        const avatar::Delayed delayed = avatar::delayed_at(*scene.delay, *state.delay, t_s);
        avatar.lag_m = delayed.lag_m;
        avatar.delay_s = delayed.tau_s;
        if (scene.texture_drag) drag_texture(scene, state, avatar);
    }
    avatar.p_m = state.touch.p_m - avatar.lag_m;
    return avatar;
}

void surface_now(const Scene& scene, const Plan& plan, State& state, SurfaceShape& shape) {
    assert(scene.surface);
    const std::int64_t before_ns = steady_ns();
    sample_surface(plan.tissue, *scene.surface, state.contact, state.tissue, shape);
    if (!state.touch.down) shape.sink_m.setZero();
    const auto note = [&](StageId id, std::int64_t took_ns) {
        Meter& meter = state.meters[static_cast<std::size_t>(id)];
        meter.count();
        meter.add_ns(static_cast<double>(took_ns));
    };
    note(StageId::surface, steady_ns() - before_ns);
    shape.cues = {};
    shape.cues.drawn_depth_m = state.touch.down ? state.contact.depth_m : 0.0;
    if (plan.frame_stages.size() < 2) return;
    const std::int64_t cues_began_ns = steady_ns();
    shape.cues = cues_at(scene.cues, plan.indenter_radius_m, shape.cues.drawn_depth_m);
    const std::int64_t cues_took_ns = steady_ns() - cues_began_ns;  // they are computed together
    for (const Stage& stage : plan.frame_stages) {
        if (stage.id != StageId::surface) note(stage.id, cues_took_ns);
    }
}

}  // namespace palpa::scene
