#pragma once

#include <filesystem>

#include "app/gui.h"
#include "app/panels.h"
#include "render/tissue.h"

namespace palpa {

// Draws one frame; the caller presents it. `options.show_nodules` and `show_cost` are the panel's.
void draw_frame(const Scene& scene, const Plan& plan, State& state, double now_s, const FrameTimes& times,
                TissueDrawer& tissue, Gui& gui, PanelOptions& options);

void save_screen(const Window& window, const std::filesystem::path& png);

// The moment of `state`, drawn off screen; needs no display.
void draw_picture(const Scene& scene, const Plan& plan, State& state, const std::filesystem::path& png);

}  // namespace palpa
