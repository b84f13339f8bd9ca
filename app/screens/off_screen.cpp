// Writes what the window shows to a file, with or without a display.

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

std::string draw_picture(const ToShow& what, const Picture& picture, ViewState& view, scene::State& state) {
    platform::WindowOptions options;
    options.visible = false;
    options.width_px = picture.width_px;
    options.height_px = picture.height_px;
    platform::Window window(options);
    Gui gui(window);
    render::TissueDrawer tissue;
    gui.set_scale(control_scale(what.notices.px_per_mm, static_cast<float>(picture.width_px),
                                static_cast<float>(picture.height_px)),
                  0.01f * static_cast<float>(what.settings.text_percent));
    for (int i = 0; i < 3; ++i) draw_frame(what, {gui, tissue}, view, state);
    save_screen(window, picture.png);
    return gui.overflow();
}

}  // namespace palpa::app
