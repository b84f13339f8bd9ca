#pragma once
// The screen of parts: one or two designs, pressed or pulled with the pen and changed by it.

#include "app/screens/part_view.h"
#include "app/screens/screens.h"

namespace palpa::app {

// True if the scene's tissue is one of parts.
bool shows_parts(const ToShow& what);

// Draws the designs as they are displaced now, the pen and its proxy, over the tissue's part of the window.
void draw_parts(const Shown& shown, const Gui& gui, PartView& view);

// Draws the panel with numbers and tools, and the curves; takes strokes of the tools.
void draw_part_panel(const Shown& shown, const Layout& layout, Gui& gui, ViewState& view, Wishes& wishes);

// Notes the present press of the parts for the curves, if there is one; a new press moves the one before to `last`. To be called
// with every sample, since a frame may last longer than a press, and with every frame, since a finger at rest sends none.
void note_press(const scene::State& state, double now_s, PartView& view);

// The names of the designs' materials, each once: the designs may list them in another order, or have others.
std::vector<std::string> materials_of(const scene::PartTissue& tissue);

void part_keys(const Shown& shown, const Gui& gui, PartView& view, Wishes& wishes);

}  // namespace palpa::app
