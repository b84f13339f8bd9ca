#pragma once
// The page that the app runs in: what the app asks the browser, and what it tells the browser.

#include <cstdint>

namespace palpa::platform::browser {

// Gives the canvas as many px as its area of the screen has. To be called once a frame.
void fit_canvas();
int canvas_width_px();
int canvas_height_px();
double px_per_css_px();  // of the canvas

double now_s();  // steady; the clock of events too
bool has_touch_screen();
bool is_secure();      // https, or this machine; otherwise the page gets no coalesced events
int screen_long_px();  // the same in both orientations
int screen_short_px();
bool full_screen();
void set_full_screen(bool full);  // works only shortly after the person has touched something
void set_title(const char* title);

// From now on the page sends pointers, keys, wheel and loss of the focus to the exported functions of window.cpp.
void listen();

}  // namespace palpa::platform::browser
