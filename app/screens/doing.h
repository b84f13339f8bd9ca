#pragma once
// What the app is doing: one thing at a time, each with the data that it needs. The loop (app/live) owns it and is the
// only one to change it; the screens draw it, and ask for a change in Wishes (app/screens/screens.h).

#include <memory>
#include <variant>
#include <vector>

#include "app/screens/device_check.h"
#include "app/study/study_run.h"
#include "session/trial.h"

namespace palpa::app {

struct CalibrateForm;  // calibrate_form.h

struct Palpating {  // a trial of one's own, practice or test (session::Trial::mode)
    bool menu = false;
};

struct Reviewing {  // what a finished trial reveals
    session::Debrief debrief;
    bool menu = false;
};

struct Dot {
    float x_px, y_px, pressure;
    bool touching;
};

struct CheckingDevices {
    std::shared_ptr<DeviceCheck> check;  // never null; outlives the screen for `run --json`
    std::vector<Dot> dots;               // the last places in its test area
};

struct MeasuringScreen {};

struct Calibrating {
    std::shared_ptr<CalibrateForm> form;  // never null; its screen fills it in
};

struct BrowsingMaps {};

// A study has steps of its own (app/study/study_step.h), its trials among them. While it runs the app does nothing
// else: no menu, no truth before the end.
using Doing = std::variant<Palpating, Reviewing, CheckingDevices, MeasuringScreen, Calibrating, BrowsingMaps, StudyRun>;

inline StudyRun* study_of(Doing& doing) { return std::get_if<StudyRun>(&doing); }
inline const StudyRun* study_of(const Doing& doing) { return std::get_if<StudyRun>(&doing); }

// The menu of what has one: true if it is open. Null: there is no menu here.
const bool* menu_of(const Doing& doing);
bool* menu_of(Doing& doing);

// True while samples go to the tissue: in a trial of one's own, or of a study.
bool palpates(const Doing& doing);

// True while keys move the indenter over the tissue, or over the test area, and not from control to control.
bool keys_move_indenter(const Doing& doing);

}  // namespace palpa::app
