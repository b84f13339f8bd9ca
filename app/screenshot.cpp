#include "app/screenshot.h"

#include "app/picture.h"
#include "render/gl.h"
#include "render/png.h"
#include "scene/advance.h"

namespace palpa {

void draw_frame(const Scene& scene, const Plan& plan, State& state, double now_s, const FrameTimes& times,
                TissueDrawer& tissue, Gui& gui, PanelOptions& options) {
    const Avatar avatar = avatar_at(scene, state, now_s);
    const TissueView view = tissue_view(scene, state);
    const Dent dent = scene.surface ? dent_of(surface_now(scene, plan, state), avatar) : Dent{};
    tissue.draw(view, dent, ball_of(plan, state, avatar));
    draw_marks(view, plan, state, avatar, options.show_nodules, gui.scale());
    draw_panel(scene, plan, state, avatar, times, gui, options);
}

void save_screen(const Window& window, const std::filesystem::path& png) {
    write_png(png, window.width_px(), window.height_px(), read_pixels(window.width_px(), window.height_px()));
}

void draw_picture(const Scene& scene, const Plan& plan, State& state, const std::filesystem::path& png) {
    WindowOptions options;
    options.visible = false;
    options.width_px = static_cast<int>(state.screen_width_px);
    options.height_px = static_cast<int>(state.screen_height_px);
    Window window(options);
    Gui gui(window);
    TissueDrawer tissue;
    PanelOptions panel;
    const FrameTimes times;
    for (int i = 0; i < 2; ++i) {  // panels find their size in the first frame and show in the second
        gui.begin_frame(1.0 / 60.0);
        draw_frame(scene, plan, state, state.timeline.now_s, times, tissue, gui, panel);
        gui.end_frame();
    }
    save_screen(window, png);
}

}  // namespace palpa
