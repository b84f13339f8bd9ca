// Writes what is on the screen to a file, with a window or without a display.

#include "app/screens/frame.h"
#include "files/text.h"
#include "render/gl.h"
#include "render/png.h"

namespace palpa::app {

void save_screen(const platform::Window& window, const std::filesystem::path& png) {
    const int width_px = window.width_px();
    const int height_px = window.height_px();
    files::write_text_whole(png, render::png_bytes(width_px, height_px, render::read_pixels(width_px, height_px)));
}

std::string draw_picture(const scene::Scene& scene, const scene::Plan& plan, const session::Trial& trial,
                         const Settings& settings, const Screens& screens, int width_px, int height_px,
                         scene::State& state, const std::filesystem::path& png) {
    platform::WindowOptions options;
    options.visible = false;
    options.width_px = width_px;
    options.height_px = height_px;
    platform::Window window(options);
    Gui gui(window);
    render::TissueDrawer tissue;
    FrameTimes times;
    Screens open = screens;
    std::string overflow;
    OnScreen on_screen;
    gui.set_scale(control_scale(screens.px_per_mm, static_cast<float>(width_px), static_cast<float>(height_px)));
    for (int i = 0; i < 3; ++i) {
        draw_frame(scene, plan, trial, settings, state.timeline.now_s, 1.0 / 60.0, tissue, gui, open, state, times,
                   on_screen);
        overflow = gui.overflow();
    }
    save_screen(window, png);
    return overflow;
}

}  // namespace palpa::app
