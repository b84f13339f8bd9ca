#pragma once
// The guided calibration. It shows a form to connect a sensor, then what to press next, what was captured so far and
// how well a curve fits it; at the end it stores a profile among the user's own.

#include <future>
#include <memory>
#include <optional>
#include <string>

#include "app/screens/calibrate_form.h"
#include "app/screens/gui.h"
#include "app/screens/screens.h"
#include "calibration/calibrate.h"
#include "calibration/record/acquisition.h"

namespace palpa::app {

// What the guide has computed for a recording, and the number that the person types from a scale.
struct Guide {
    std::optional<calibration::Calibration> fit;  // through the points so far, without intervals
    std::size_t fitted = 0;                       // number of points that it was, or is now, fitted to
    // the next fit, in its own thread: choosing among all models takes longer than a frame
    std::future<std::optional<calibration::Calibration>> next_fit;
    double shown_gf = 0.0;  // reading of the scale, as typed
    bool again = true;      // the field for the reading has the keys in the next frame
    bool typing = false;    // the field has them now
    int frames_since_focus = 0;
    bool pressed = false;  // the pen was down in the last frame
    std::string note;
    bool makes_profile = true;  // false: it only records, and has no button for a profile
};

struct GuideWishes {
    bool stop = false;
    bool keep = false;  // make a profile of the recording
};

// Fits the curve again if the number of points has changed: the curve that a profile of these points would get. The new
// curve comes some frames later.
void refresh_fit(const calibration::Recording& recording, Guide& guide);

GuideWishes draw_guide(calibration::Recording& recording, Gui& gui, Guide& guide);

struct CalibrateForm {
    int kind = 0;  // 0: readings of a scale are typed; 1: Net F/T; 2: load cell on a serial port
    char address[128] = "192.168.1.1";
    char port[128] = "/dev/ttyUSB0";
    double counts_per_N = 1e6;
    double N_per_count = 0.0;  // differs from cell to cell, so there is no default
    char name[64] = "my-pen";  // of the profile
    std::unique_ptr<calibration::Recording> recording;
    Guide guide;
    std::string problem;
    std::size_t refused_at = 0;  // number of points from which no profile could be made; the guide's note says why
};

// What has to be typed before a recording with this sensor can begin; empty if nothing.
const char* number_to_type(const CalibrateForm& form);

}  // namespace palpa::app
