#include "app/screens/frame.h"

#include <type_traits>

#include "app/screens/calibrate_form.h"
#include "app/screens/content_hash.h"
#include "app/screens/map_screen.h"
#include "app/screens/tissue_drawing.h"
#include "scene/advance.h"

namespace palpa::app {
namespace {

Layout layout_now(const Gui& gui, float width_px, float height_px, const Settings& settings) {
    return layout_of(width_px, height_px, gui.mm(), settings.left_handed, settings.above_finger);
}

struct Surface {
    render::Dent dent;
    render::Relief relief;
};

Surface surface_of(const scene::Scene& scene, const scene::Plan& plan, const scene::Avatar& avatar,
                   scene::State& state) {
    Surface surface;
    if (!scene.surface) return surface;
    scene::SurfaceShape shape;
    scene::surface_now(scene, plan, state, shape);
    if (shape.curve) surface.dent = dent_of(*shape.curve, avatar);
    if (shape.n_x > 0) surface.relief = relief_of(shape, avatar);
    return surface;
}

void draw_panels(const Shown& shown, const Layout& layout, Gui& gui, Screens& screens, Wishes& wishes) {
    if (screens.asked) {
        draw_on_tissue(shown, gui);
        return draw_ask(shown, gui, screens, wishes);
    }
    take_keys(shown, gui, screens, wishes);
    if (screens.screen == Screen::devices) return draw_device_screen(shown, gui, screens, wishes);
    if (screens.screen == Screen::scale) return draw_scale_screen(shown, gui, screens, wishes);
    if (screens.screen == Screen::calibrate && screens.calibrate)
        return draw_calibrate_screen(shown, gui, *screens.calibrate, wishes);
    if (screens.screen == Screen::maps && screens.maps) return draw_map_screen(shown, gui, *screens.maps, wishes);
    if (screens.screen == Screen::study && screens.study)
        return draw_study_screen(shown.now_s, gui, *screens.study, wishes);
    if (screens.screen == Screen::reveal) {
        draw_reveal_on_tissue(shown, gui, screens.debrief);
        draw_reveal_panel(shown, layout, gui, screens, wishes);
    } else {
        draw_on_tissue(shown, gui);
        draw_trial_panel(shown, layout, gui, screens, wishes);
    }
    if (screens.menu) {
        draw_menu(shown, layout, gui, screens, wishes);
    } else if (screens.cost) {
        draw_cost(shown, layout, gui);
    }
}

template <class Numbers>  // without gaps between them
std::uint64_t hash_of(std::uint64_t hash, const Numbers& numbers) {
    static_assert(std::is_trivially_copyable_v<Numbers>);
    return hash_more(hash, &numbers, sizeof numbers);
}

std::uint64_t content_of(const render::TissueView& view, const Surface& surface, const render::Ball& ball,
                         const Gui& gui) {
    static_assert(sizeof(render::TissueView) == 14 * sizeof(float) && sizeof(render::Ball) == 5 * sizeof(float));
    static_assert(sizeof(render::Dent) == (3 + render::kSinkPoints) * sizeof(float));
    std::uint64_t hash = hash_of(hash_of(hash_of(gui.content(), view), surface.dent), ball);
    const render::Relief& relief = surface.relief;
    hash = hash_of(hash_of(hash_of(hash, relief.n_x), relief.n_y), relief.shift_m);
    return hash_more(hash, relief.sink_m.data(), relief.sink_m.size() * sizeof(float));
}

}  // namespace

Wishes draw_frame(const scene::Scene& scene, const scene::Plan& plan, const session::Trial& trial,
                  const Settings& settings, double now_s, double dt_s, render::TissueDrawer& tissue, Gui& gui,
                  Screens& screens, scene::State& state, FrameTimes& times, OnScreen& on_screen) {
    const std::int64_t began_ns = scene::steady_ns();
    const bool keys_to_panels =
        screens.menu || screens.asked || (screens.screen != Screen::trial && screens.screen != Screen::devices);
    gui.keep_enter(screens.screen == Screen::study || screens.asked);
    gui.begin_frame(dt_s, keys_to_panels);
    const WindowSize window = gui.size_px();
    Shown shown{scene, plan, state, trial, settings, times, {}, {}, 0.0, now_s};
    shown.avatar = trial.finished ? scene::Avatar{} : scene::avatar_at(scene, state, now_s);
    shown.view = tissue_view(scene, state, window.width, window.height);
    shown.trial_s = trial.finished ? trial.now_s - trial.began_s : std::max(0.0, now_s - trial.began_s);
    Wishes wishes;
    draw_panels(shown, layout_now(gui, window.width, window.height, settings), gui, screens, wishes);
    const Surface surface = trial.finished ? Surface{} : surface_of(scene, plan, shown.avatar, state);
    render::Ball ball = ball_of(plan, state, shown.avatar);
    if (trial.finished) ball.radius_m = 0.0f;
    gui.end_frame();
    const std::int64_t built_ns = scene::steady_ns();
    times.built_ns = built_ns;
    times.cpu.add_ns(static_cast<double>(built_ns - began_ns));
    const std::uint64_t content = content_of(shown.view, surface, ball, gui);
    on_screen.drawn = content != on_screen.content;
    if (!on_screen.drawn) return wishes;
    on_screen.content = content;
    tissue.draw(shown.view, surface.dent, surface.relief, ball);
    gui.draw();
    times.gl.add_ns(static_cast<double>(scene::steady_ns() - built_ns));
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
