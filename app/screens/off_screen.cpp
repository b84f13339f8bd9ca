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

namespace {

platform::WindowOptions unseen(int width_px, int height_px) {
    platform::WindowOptions options;
    options.visible = false;
    options.width_px = width_px;
    options.height_px = height_px;
    return options;
}

}  // namespace

OffScreen::OffScreen(int width_px, int height_px, double px_per_mm, int text_percent)
    : window_(unseen(width_px, height_px)), gui_(window_) {
    gui_.set_scale(control_scale(px_per_mm, static_cast<float>(width_px), static_cast<float>(height_px)),
                   0.01f * static_cast<float>(text_percent));
}

void OffScreen::draw(const ToShow& what, ViewState& view, scene::State& state) {
    view.on_screen.content = 0;
    draw_frame(what, {gui_, tissue_}, view, state);
}

std::vector<unsigned char> OffScreen::pixels() const {
    return render::read_pixels(window_.width_px(), window_.height_px());
}

std::string draw_picture(const ToShow& what, const Picture& picture, ViewState& view, scene::State& state) {
    OffScreen screen(picture.width_px, picture.height_px, what.notices.px_per_mm, what.settings.text_percent);
    for (int i = 0; i < 3; ++i) screen.draw(what, view, state);
    save_screen(screen.window(), picture.png);
    return screen.gui().overflow();
}

}  // namespace palpa::app
