#pragma once
// The page that the app lives in: what the browser is asked, and what it is told.

#include <cstdint>

namespace palpa::platform::browser {

// The canvas is given as many px as its place on the screen has. Call it once a frame.
void fit_canvas();
int canvas_width_px();
int canvas_height_px();
double px_per_css_px();  // of the canvas

double now_s();  // of events too; steady
bool has_touch_screen();
bool is_secure();      // https, or this machine: else events between frames are kept from the page
int screen_long_px();  // the same however it is turned
int screen_short_px();
bool full_screen();
void set_full_screen(bool full);  // works only shortly after somebody has touched something
void set_title(const char* title);

// Pointers, keys, wheel and loss of the focus are sent to the exported functions of window.cpp from now on.
void listen();

}  // namespace palpa::platform::browser
