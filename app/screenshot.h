#pragma once

#include <filesystem>

#include "app/gui.h"
#include "app/panels.h"
#include "render/tissue.h"

namespace palpa {

// One frame: everything is built first, then handed to GL; the caller presents it.
void draw_frame(const Scene& scene, const Plan& plan, double now_s, double dt_s, TissueDrawer& tissue, Gui& gui,
                PanelOptions& options, State& state, FrameTimes& times);

void save_screen(const Window& window, const std::filesystem::path& png);

// The moment of `state`, drawn off screen; needs no display.
void draw_picture(const Scene& scene, const Plan& plan, State& state, const std::filesystem::path& png);

}  // namespace palpa
