#pragma once
// What screens show of any device that a trial drives, arm and pins or a soft device: its state, its ports, Stop and
// Release.

#include <string>
#include <vector>

#include "app/screens/gui.h"
#include "session/tactile_moment.h"

namespace palpa::app {

struct Shown;
struct Wishes;

// What the loop of the app keeps of such a device.
struct DriveState {
    std::vector<session::TactileDevice> devices;  // none: nothing is driven
    bool opening = false;                         // the devices are being opened
    bool runs = false;                            // their loop is running
    std::string problem;                          // why it does not run
};

// Values and buttons on the left, or above in an upright window, and pictures in the rest.
struct HalfScreen {
    PanelArea panel;
    PanelArea rest;
};
HalfScreen halves_of(const Gui& gui);
void cover_window(Gui& gui);  // nothing reaches the tissue

// One line for each device, which says whether it is real or simulated.
void draw_devices(const std::vector<session::TactileDevice>& devices);

// A button as large as the rest of the line, `height_mm` high: Stop (F12) while the devices may move, Release after a stop.
// Draws nothing without devices.
void draw_stop_or_release(const DriveState& drive, bool stopped, float width_px, float height_mm, const Gui& gui,
                          Wishes& wishes);

// Says over every screen that everything has been stopped or rests after a fault, for as long as it does.
void draw_stopped_banner(const Shown& shown, const Gui& gui);

// A number with its unit, or a dash.
std::string in_unit(double value, double scale, int digits, const char* unit);

}  // namespace palpa::app
