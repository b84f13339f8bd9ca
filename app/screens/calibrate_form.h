#pragma once
// The screen that calibrates pressure, as the loop sees it.

#include <memory>
#include <vector>

#include "app/screens/screens.h"

namespace palpa::app {

std::shared_ptr<CalibrateForm> make_calibrate_form();
void draw_calibrate_screen(const Shown& shown, Gui& gui, CalibrateForm& form, Wishes& wishes);

// Samples and readings of one turn of the loop. What goes wrong is told in form.problem.
void step_calibrate(const std::vector<platform::Sample>& samples, CalibrateForm& form);

// Puts what was recorded on the disk and closes the sensor. A session of the same name can be gone on with.
void stop_recording(CalibrateForm& form);

}  // namespace palpa::app
