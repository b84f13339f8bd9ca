#pragma once
// The screen of the force arm and the shape display: what is wanted, what was reached, and how well the devices follow.

#include <optional>
#include <string>
#include <vector>

#include "app/screens/gui.h"
#include "session/tactile_moment.h"

namespace palpa::app {

// What the loop of the devices tells the screens; kept by the loop of the app.
struct TactileShown {
    session::TactileMoment moment;
    std::vector<session::TactileDevice> devices;  // none: pins are only drawn
    bool opening = false;                         // the devices are being opened
    bool runs = false;                            // their loop is running
    bool arm_leads = false;                       // the arm's motion is the input, not that on the screen
    double force_limit_N = session::TactileMoment::kNone;
    std::string problem;  // why the loop does not run
};

struct Shown;
struct Wishes;
void draw_tactile_screen(const Shown& shown, Gui& gui, Wishes& wishes);

// Says over every screen that everything has been stopped, for as long as it is.
void draw_stopped_banner(const Shown& shown, const Gui& gui);

}  // namespace palpa::app
