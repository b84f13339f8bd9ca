#pragma once
// One frame: the tissue, the marks and notes over it, and the panels of the open screen.

#include <filesystem>

#include "app/screens/screens.h"
#include "session/session.h"

namespace palpa::app {

// What a frame is drawn with.
struct Canvas {
    Gui& gui;
    render::TissueDrawer& tissue;
};

// Builds the frame, and draws it unless it would look like what the window shows. Returns what the person asked for in
// it. The time of the surface stage is added to its meter in `state`.
Wishes draw_frame(const ToShow& what, const Canvas& canvas, ViewState& view, scene::State& state);

// Returns the sample that says which part of the window the tissue has.
platform::Sample resize_sample(const platform::Window& window, const Gui& gui, const Settings& settings,
                               double t_host_s);

// Writes what the window shows to a PNG file. Throws std::runtime_error if it cannot be written.
void save_screen(const platform::Window& window, const std::filesystem::path& png);

// Draws without a display. The scale of the controls is that of a screen with so many px per mm; NaN: of any.
class OffScreen {
  public:
    OffScreen(int width_px, int height_px, double px_per_mm = platform::kMissing, int text_percent = 100);
    const platform::Window& window() const { return window_; }
    const Gui& gui() const { return gui_; }
    // Draws the frame whether or not anything has changed.
    void draw(const ToShow& what, ViewState& view, scene::State& state);
    std::vector<unsigned char> pixels() const;  // RGB of the last frame, rows from the top

  private:
    platform::Window window_;
    Gui gui_;
    render::TissueDrawer tissue_;
};

struct Picture {
    int width_px = 0;
    int height_px = 0;
    std::filesystem::path png;
};

// Draws a picture without a display: a few frames, since panels find their size in the first, of which it saves the
// last. Returns the name of a panel that did not fit, or nothing. Throws std::runtime_error as save_screen() does.
std::string draw_picture(const ToShow& what, const Picture& picture, ViewState& view, scene::State& state);

}  // namespace palpa::app
