#pragma once
// The force that a person presses with, on the screen or on a device.

#include "app/screens/gui.h"
#include "app/screens/screens.h"

namespace palpa::app {

// True if the motion of a force arm or of a soft device is the input, and not that on the screen.
bool device_leads(const Shown& shown);
bool device_runs(const Shown& shown);  // that device is connected and moves

// What the person presses with, and how deep into the tissue: on the screen, or on the device that leads.
double felt_force_N(const Shown& shown);
double felt_depth_m(const Shown& shown);

// What the line below the bar says of a contact: what the person does wrong, if anything. The limits of the tissue model
// concern the experimenter alone.
const char* contact_note(const scene::Contact& contact, bool experimenter);

// Draws the bar, with the limit of the force where there is one.
void draw_force_bar(const Shown& shown, float height_px, const Gui& gui);

}  // namespace palpa::app
