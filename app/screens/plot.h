#pragma once
// A small diagram: axes with ticks and titles, and places in it.

#include "app/screens/widgets.h"

namespace palpa::app {

struct Plot {
    PanelArea area;  // of the data, without ticks and titles
    double least_x = 0.0;
    double most_x = 1.0;
    double least_y = 0.0;
    double most_y = 1.0;
    bool counts_x = false;  // whole numbers along x
    // Values outside are drawn just beyond the frame.
    ImVec2 at(double x, double y) const;
};

struct PlotTitles {
    const char* top = "";
    const char* x = "";
    const char* y = "";
};

// Returns the area for the data inside `whole`, beside which ticks and titles have room.
PanelArea data_area(const PanelArea& whole, float mm);

// Draws frame, ticks with their numbers, and titles.
void draw_plot_axes(const Plot& plot, const PlotTitles& titles, float mm, ImDrawList& draw);

}  // namespace palpa::app
