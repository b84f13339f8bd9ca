#pragma once
// The parts of the window. The controls get a column on the side away from the drawing hand, or, in a window that is
// taller than wide, a strip above the tissue; the tissue gets the rest.

#include <limits>

namespace palpa::app {

// A rectangle of the window, px.
struct PanelArea {
    float x0 = 0.0f, y0 = 0.0f, x1 = 0.0f, y1 = 0.0f;
    float width() const { return x1 - x0; }
    float height() const { return y1 - y0; }
    bool holds(float x, float y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

struct Layout {
    bool column = true;    // controls beside the tissue; false: above it
    bool controls = true;  // false: the window is too small for them, but keys still work
    PanelArea controls_px;
    PanelArea tissue_px;
};

// A finger may indent the place this far above it, so that it does not hide the avatar.
constexpr float kFingerOffset_mm = 15.0f;

// Divides the window. `mm`: px per millimetre for controls. `above_finger`: the tissue ends kFingerOffset_mm above the
// window's lower edge, so that all of it can be reached from below.
// `hand_mm`: px per millimetre of that distance, if controls are larger than usual; 0: as `mm`.
Layout layout_of(float width_px, float height_px, float mm, bool left_handed, bool above_finger = false,
                 float hand_mm = 0.0f);

// Returns the scale of controls that are `text` times as large as usual, or as large as the window has room for.
float larger_scale(float mm, float text, float width_px, float height_px);

// Returns px per millimetre for controls: the screen's own scale if it is known, else touch_px_per_mm, which the system gives
// for a touch screen (NaN: none), either reduced until the controls fit and leave the tissue room, if need be. Else that of
// a desktop screen (96 px per inch), more in larger windows, and down to 0.74 of it in small ones where the tissue then has
// its room.
float control_scale(double px_per_mm, float width_px, float height_px,
                    double touch_px_per_mm = std::numeric_limits<double>::quiet_NaN());

}  // namespace palpa::app
