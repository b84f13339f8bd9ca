#pragma once
// The page that the app runs in: what the app asks the browser, and what it tells the browser.

#include <cstdint>

namespace palpa::platform::browser {

// Gives the canvas as many px as its place on the screen has. Call it once a frame.
void fit_canvas();
int canvas_width_px();
int canvas_height_px();
double px_per_css_px();  // of the canvas

double now_s();  // of events too; steady
bool has_touch_screen();
bool is_secure();      // https, or this machine; without it the page gets no coalesced events
int screen_long_px();  // the same however it is turned
int screen_short_px();
bool full_screen();
void set_full_screen(bool full);  // works only shortly after the person has touched something
void set_title(const char* title);

// From now on the page sends pointers, keys, wheel and loss of the focus to the exported functions of window.cpp.
void listen();

}  // namespace palpa::platform::browser
