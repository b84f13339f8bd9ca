#pragma once
// What stands on top of the tissue: force bar, numbers, the lag between pen and avatar.

#include <string>
#include <vector>

#include "app/gui.h"
#include "render/tissue.h"
#include "scene/scene.h"
#include "scene/state.h"

namespace palpa {

struct PanelOptions {
    bool show_nodules = false;
    bool show_cost = false;
    std::vector<std::string> messages;  // about the devices, in plain words
};

// Times of the frame loop, for the cost lines.
struct FrameTimes {
    Meter latency;    // sample to the end of the frame that shows it
    Meter cpu;        // a frame up to the calls of GL
    Meter gl;         // the calls of GL; with software rendering that is where the drawing is done
    double frames_per_s = 0.0;
};

// Pen mark, lag line and nodules (if asked for), over the tissue.
void draw_marks(const TissueView& view, const Plan& plan, const State& state, const Avatar& avatar, bool nodules,
                float scale);

// A bar in the middle of the screen, while nothing else can be shown.
void draw_progress(const std::string& what, double share);

void draw_panel(const Scene& scene, const Plan& plan, const State& state, const Avatar& avatar,
                const FrameTimes& times, Gui& gui, PanelOptions& options);

}  // namespace palpa
