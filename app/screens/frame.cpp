#include "app/screens/frame.h"

#include <type_traits>
#include <utility>

#include "app/screens/calibrate_form.h"
#include "app/screens/content_hash.h"
#include "app/screens/history_screen.h"
#include "app/screens/map_screen.h"
#include "app/screens/part_screen.h"
#include "app/screens/tactile_screen.h"
#include "app/screens/tangible_screen.h"
#include "app/screens/tissue_drawing.h"
#include "scene/advance.h"

namespace palpa::app {
namespace {

Layout layout_now(const Gui& gui, float width_px, float height_px, const Settings& settings) {
    return layout_of(width_px, height_px, gui.mm(), settings.left_handed, settings.above_finger, gui.hand_mm());
}

// Fills what is derived from the state: where the avatar is now, and what the tissue looks like.
void look_at_tissue(const ToShow& what, const glm::vec2& window_px, scene::State& state, Shown& shown) {
    const bool finished = what.trial.finished;
    shown.avatar = finished ? scene::Avatar{} : scene::avatar_at(what.scene, state, what.now_s);
    shown.view = tissue_view(what.scene, state, shown.avatar, window_px);
    shown.picture.view = shown.view;
    if (what.scene.surface) shown.picture.material = static_cast<render::Material>(what.scene.surface->material);
    if (finished) return;
    if (what.scene.surface) {
        scene::surface_now(what.scene, what.plan, state, shown.shape);
        add_surface(shown.shape, what.scene.cues, shown.avatar, shown.picture);
    }
    add_indenter(what.plan, state, shown.shape.cues, shown.avatar, shown.picture);
    shown.picture.indenter.hand_x = what.settings.left_handed ? -1.0f : 1.0f;
}

// Draws the open screen if it covers the tissue. Returns false if none does.
bool draw_covering(const Shown& shown, Gui& gui, ViewState& view, Wishes& wishes) {
    if (const auto* checking = std::get_if<CheckingDevices>(&shown.doing)) {
        draw_device_screen(shown, *checking, gui, wishes);
    } else if (std::holds_alternative<MeasuringScreen>(shown.doing)) {
        draw_scale_screen(shown, gui, view.scale, wishes);
    } else if (const auto* calibrating = std::get_if<Calibrating>(&shown.doing)) {
        draw_calibrate_screen(shown, gui, *calibrating->form, wishes);
    } else if (std::holds_alternative<BrowsingMaps>(shown.doing)) {
        draw_map_screen(shown, gui, *view.maps, wishes);
    } else if (std::holds_alternative<BrowsingHistory>(shown.doing)) {
        draw_history_screen(shown, gui, *view.history, wishes);
    } else if (std::holds_alternative<WatchingTactile>(shown.doing)) {
        draw_tactile_screen(shown, gui, wishes);
    } else if (std::holds_alternative<WatchingTangible>(shown.doing)) {
        draw_tangible_screen(shown, gui, wishes);
    } else if (const StudyRun* study = study_of(shown.doing); study != nullptr && !trial_goes_on(*study)) {
        draw_study_screen(*study, shown.now_s, gui, view.study, wishes);
    } else {
        return false;
    }
    return true;
}

// What is pressed: tissue with what lies on it, or parts.
void draw_pressed(const Shown& shown, Gui& gui, ViewState& view) {
    if (shows_parts(shown)) return draw_parts(shown, gui, view.part);
    draw_on_tissue(shown, gui);
}

void draw_panels(const Shown& shown, const Layout& layout, Gui& gui, ViewState& view, Wishes& wishes) {
    if (shown.asked) {
        draw_pressed(shown, gui, view);
        return draw_ask(shown, gui, wishes);
    }
    const bool listed_keys = view.help;
    take_keys(shown, gui, view, wishes);
    if (listed_keys || view.help) {  // the key that closes the list does nothing else
        draw_pressed(shown, gui, view);
        return draw_help(shown, gui, view);
    }
    if (draw_covering(shown, gui, view, wishes)) return;
    if (const auto* reviewing = std::get_if<Reviewing>(&shown.doing)) {
        draw_reveal_on_tissue(shown, gui, reviewing->debrief);
        draw_reveal_panel(shown, layout, *reviewing, gui, wishes);
    } else {
        draw_pressed(shown, gui, view);
        if (shows_parts(shown) && study_of(shown.doing) == nullptr)
            draw_part_panel(shown, layout, gui, view, wishes);
        else
            draw_trial_panel(shown, layout, gui, view, wishes);
    }
    const bool paused = shown.trial.paused_at_s && !shown.trial.finished && study_of(shown.doing) == nullptr;
    if (paused)
        draw_paused(shown, layout, gui, wishes);
    else if (is_guided(shown.doing))
        draw_guided(shown, layout, gui, wishes);
    const bool* menu = menu_of(shown.doing);
    if (menu != nullptr && *menu) {
        draw_menu(shown, layout, gui, view, wishes);
    } else if (view.cost) {
        draw_cost(shown, layout, gui);
    }
}

// Adds a struct of numbers, which must have no padding, to the hash.
template <class Numbers>
std::uint64_t hash_of(std::uint64_t hash, const Numbers& numbers) {
    static_assert(std::is_trivially_copyable_v<Numbers>);
    return hash_more(hash, &numbers, sizeof numbers);
}

std::uint64_t content_of(const render::TissuePicture& picture) {
    static_assert(sizeof(render::TissueView) == 22 * sizeof(float) && sizeof(render::Indenter) == 8 * sizeof(float));
    static_assert(sizeof(render::Dent) == (3 + render::kSinkPoints) * sizeof(float));
    static_assert(sizeof(render::Grip) == 8 * sizeof(float));
    const std::uint64_t view = hash_of(hash_of(1, picture.view), picture.material);
    std::uint64_t hash = hash_of(hash_of(hash_of(view, picture.dent), picture.grip), picture.indenter);
    const render::Relief& relief = picture.relief;
    hash = hash_of(hash_of(hash_of(hash, relief.n_x), relief.n_y), relief.shift_m);
    return hash_more(hash, relief.sink_m.data(), relief.sink_m.size() * sizeof(float));
}

}  // namespace

Wishes draw_frame(const ToShow& what, const Canvas& canvas, ViewState& view, scene::State& state) {
    const std::int64_t began_ns = scene::steady_ns();
    Gui& gui = canvas.gui;
    const StudyRun* study = study_of(what.doing);
    gui.keep_enter((study != nullptr && !trial_goes_on(*study)) || what.asked);
    gui.begin_frame(what.dt_s, what.asked || view.help || what.trial.paused_at_s || !keys_move_indenter(what.doing));
    const WindowSize window = gui.size_px();
    const session::Trial& trial = what.trial;
    Shown shown{what, state, view.times};
    look_at_tissue(what, {window.width, window.height}, state, shown);
    // a study's time limit runs from the trial's begin
    const double since_s = (trial.finished ? trial.now_s : what.now_s) - trial.began_s;
    shown.trial_s = study != nullptr ? std::max(0.0, since_s) : session::clock_s(trial, what.now_s);
    shown.experimenter = view.cost;
    Wishes wishes;
    draw_panels(shown, layout_now(gui, window.width, window.height, what.settings), gui, view, wishes);
    draw_stopped_banner(shown, gui);
    gui.end_frame();
    const std::int64_t built_ns = scene::steady_ns();
    view.times.built_ns = built_ns;
    view.times.cpu.add_ns(static_cast<double>(built_ns - began_ns));
    const std::uint64_t tissue = content_of(shown.picture);
    const std::uint64_t content = hash_of(gui.content(), tissue);
    view.on_screen.drawn = content != view.on_screen.content;
    if (!view.on_screen.drawn) return wishes;
    view.on_screen.content = content;
    const bool tissue_as_before = tissue == std::exchange(view.on_screen.tissue, tissue);
    canvas.tissue.draw(shown.picture, tissue_as_before);
    gui.draw();
    view.times.gl.add_ns(static_cast<double>(scene::steady_ns() - built_ns));
    return wishes;
}

platform::Sample resize_sample(const platform::Window& window, const Gui& gui, const Settings& settings,
                               double t_host_s) {
    const Layout layout =
        layout_now(gui, static_cast<float>(window.width_px()), static_cast<float>(window.height_px()), settings);
    platform::Sample sample;
    sample.t_host_s = t_host_s;
    sample.phase = platform::Phase::ui;
    sample.action = platform::Action::resize;
    sample.x_px = static_cast<double>(layout.tissue_px.x0);
    sample.y_px = static_cast<double>(layout.tissue_px.y0);
    sample.width_px = static_cast<double>(layout.tissue_px.width());
    sample.height_px = static_cast<double>(layout.tissue_px.height());
    return sample;
}

}  // namespace palpa::app
