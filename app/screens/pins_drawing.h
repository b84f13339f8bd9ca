#pragma once
// Pins of a shape display as they are drawn: a field of columns seen from above, lighter the higher they stand.

#include <imgui.h>
#include <string>

#include "app/screens/layout.h"
#include "app/screens/screens.h"
#include "session/tactile_moment.h"

namespace palpa::app {

// Heights of rows x columns pins, row by row from the lowest y; 0 = lowest, stroke_m = highest.
struct PinField {
    int rows = 0;
    int columns = 0;
    double stroke_m = 0.0;
    const double* height_m = nullptr;
};

// Draws the field inside `area`, as large as it fits, y upwards. Where a pin has room for it, its height stands on it in
// tenths of a millimetre. Returns the area that was used.
PanelArea draw_pin_field(const PanelArea& area, const PinField& field, float mm, ImDrawList& draw);

// Draws heights along the middle row of the field: what is wanted as bars, what was reached as ticks on them. `reached`
// may be null.
void draw_pin_section(const PanelArea& area, const PinField& wanted, const double* reached_m, float mm,
                      ImDrawList& draw);

// A small field in a corner of the tissue while its scene has a shape display; never where two surfaces are compared,
// since it would show what is to be felt.
void draw_pins_inset(const Shown& shown, const Gui& gui);

}  // namespace palpa::app
