#pragma once
// The screen of the force arm and the shape display: what is wanted, what was reached, and how well the devices follow.

#include <string>

#include "app/screens/device_state.h"
#include "app/screens/gui.h"
#include "session/tactile_moment.h"

namespace palpa::app {

// What the loop of the devices tells the screens; kept by the loop of the app.
struct TactileShown : DriveState {  // no devices: pins are only drawn
    session::TactileMoment moment;
    bool arm_leads = false;  // the arm's motion is the input, not that on the screen
    double force_limit_N = session::TactileMoment::kNone;
};

// The arm's round trips, or for how long it has not answered.
std::string link_text(const session::TactileMoment& moment);

struct Shown;
struct Wishes;
void draw_tactile_screen(const Shown& shown, Gui& gui, Wishes& wishes);

}  // namespace palpa::app
