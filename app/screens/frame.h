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

// Builds the frame, and draws it unless it would look like what is on the screen. Returns what the person asked for in
// it. The time of the surface stage is added to its meter in `state`.
Wishes draw_frame(const ToShow& what, const Canvas& canvas, ViewState& view, scene::State& state);

// The sample that tells which part of the window the tissue has.
platform::Sample resize_sample(const platform::Window& window, const Gui& gui, const Settings& settings,
                               double t_host_s);

// Writes what the window shows as a PNG. Throws std::runtime_error if it cannot be written.
void save_screen(const platform::Window& window, const std::filesystem::path& png);

struct Picture {
    int width_px = 0;
    int height_px = 0;
    std::filesystem::path png;
};

// Does the same without a display: draws a few frames (panels find their size in the first) and saves the last one.
// Returns the name of a panel that did not fit, or nothing.
std::string draw_picture(const ToShow& what, const Picture& picture, ViewState& view, scene::State& state);

}  // namespace palpa::app
