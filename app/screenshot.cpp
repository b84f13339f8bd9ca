#include "app/screenshot.h"

#include "app/picture.h"
#include "render/gl.h"
#include "render/png.h"
#include "scene/advance.h"

namespace palpa {

void draw_frame(const Scene& scene, const Plan& plan, double now_s, double dt_s, TissueDrawer& tissue, Gui& gui,
                PanelOptions& options, State& state, FrameTimes& times) {
    const std::int64_t began_ns = steady_ns();
    gui.begin_frame(dt_s);
    const Avatar avatar = avatar_at(scene, state, now_s);
    const TissueView view = tissue_view(scene, state);
    Dent dent;
    Relief relief;
    if (const auto* linear = std::get_if<LinearTissue>(&plan.tissue); linear != nullptr && scene.surface) {
        Eigen::VectorXd sink_m;
        surface_now(*linear, state, sink_m);
        relief = relief_of(*linear, sink_m, avatar);
    } else if (scene.surface) {
        dent = dent_of(surface_now(scene, plan, state), avatar);
    }
    const Ball ball = ball_of(plan, state, avatar);
    draw_marks(view, plan, state, avatar, options.show_nodules, gui.scale());
    draw_panel(scene, plan, state, avatar, times, gui, options);
    gui.end_frame();
    const std::int64_t built_ns = steady_ns();
    tissue.draw(view, dent, relief, ball);
    gui.draw();
    times.cpu.add_ns(static_cast<double>(built_ns - began_ns));
    times.gl.add_ns(static_cast<double>(steady_ns() - built_ns));
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
    FrameTimes times;
    for (int i = 0; i < 2; ++i) {  // panels find their size in the first frame and show in the second
        draw_frame(scene, plan, state.timeline.now_s, 1.0 / 60.0, tissue, gui, panel, state, times);
    }
    save_screen(window, png);
}

}  // namespace palpa
