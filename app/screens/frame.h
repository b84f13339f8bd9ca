#pragma once
// One frame: the tissue, the marks and notes over it, and the panels of the open screen.

#include <filesystem>

#include "app/screens/screens.h"
#include "session/session.h"

namespace palpa::app {

// What the window shows.
struct OnScreen {
    std::uint64_t content =
        0;               // what it was drawn from (content_hash.h); 0: nobody knows, so that the next frame is drawn
    bool drawn = false;  // by the last draw_frame()
};

// Builds the frame, and draws it unless it would look like what is on the screen. Returns what the person asked for in
// it. The time of the surface stage is added to its meter in `state`.
Wishes draw_frame(const scene::Scene& scene, const scene::Plan& plan, const session::Trial& trial,
                  const Settings& settings, double now_s, double dt_s, render::TissueDrawer& tissue, Gui& gui,
                  Screens& screens, scene::State& state, FrameTimes& times, OnScreen& on_screen);

// The sample that tells which part of the window the tissue has.
platform::Sample resize_sample(const platform::Window& window, const Gui& gui, const Settings& settings,
                               double t_host_s);

// Writes what the window shows as a PNG. Throws std::runtime_error if it cannot be written.
void save_screen(const platform::Window& window, const std::filesystem::path& png);

// Does the same without a display: draws a few frames (panels find their size in the first) and saves the last one.
// Returns the name of a panel that did not fit, or nothing.
std::string draw_picture(const scene::Scene& scene, const scene::Plan& plan, const session::Trial& trial,
                         const Settings& settings, const Screens& screens, int width_px, int height_px,
                         scene::State& state, const std::filesystem::path& png);

}  // namespace palpa::app
