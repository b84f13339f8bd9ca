#pragma once
// The screen that calibrates pressure, as the loop sees it.

#include <memory>
#include <vector>

#include "app/screens/screens.h"

namespace palpa::app {

std::shared_ptr<CalibrateForm> make_calibrate_form();
void draw_calibrate_screen(const Shown& shown, Gui& gui, CalibrateForm& form, Wishes& wishes);

// Takes the samples and readings of one turn of the loop. form.problem says what went wrong.
void step_calibrate(const std::vector<platform::Sample>& samples, CalibrateForm& form);

// Writes what was recorded to the disk and closes the sensor. A later session of the same name can continue it.
void stop_recording(CalibrateForm& form);

// Fits a profile to the points and closes the session. form.problem says why there is none; then the session goes on.
void keep_profile(CalibrateForm& form);

}  // namespace palpa::app
