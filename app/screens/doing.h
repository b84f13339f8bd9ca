#pragma once
// What the app is doing: one thing at a time, each with the data that it needs. The loop (app/live) owns it, and only
// the loop changes it; the screens draw it, and ask for a change in Wishes (app/screens/screens.h).

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "app/screens/device_check.h"
#include "app/study/study_run.h"
#include "session/trial.h"

namespace palpa::app {

struct CalibrateForm;  // calibrate_form.h

struct Palpating {  // a trial outside a study, practice or test (session::Trial::mode)
    bool menu = false;
    bool guided = false;  // the guided start, on a practice trial
};

struct Reviewing {  // what a finished trial reveals
    session::Debrief debrief;
    bool menu = false;
    bool guided = false;   // the last step of the guided start
    std::string advice{};  // one sentence; empty: none
};

struct Dot {
    float x_px, y_px, pressure;
    bool touching;
};

struct CheckingDevices {
    std::shared_ptr<DeviceCheck> check;  // never null; `run --json` still reports it when the screen is closed
    std::vector<Dot> dots;               // the last positions in its test area
};

struct MeasuringScreen {};

struct Calibrating {
    std::shared_ptr<CalibrateForm> form;  // never null; its screen fills it in
};

struct BrowsingMaps {};

struct BrowsingHistory {};  // the results that were kept

struct WatchingTactile {};  // the force arm and the shape display

struct WatchingTangible {};  // the soft device

// A study has steps of its own (app/study/study_step.h), its trials among them. While it runs, the app does nothing
// else: there is no menu, and nothing is revealed before the end.
using Doing = std::variant<Palpating, Reviewing, CheckingDevices, MeasuringScreen, Calibrating, BrowsingMaps,
                           BrowsingHistory, WatchingTactile, WatchingTangible, StudyRun>;

inline StudyRun* study_of(Doing& doing) { return std::get_if<StudyRun>(&doing); }
inline const StudyRun* study_of(const Doing& doing) { return std::get_if<StudyRun>(&doing); }

// Returns the menu of what the app is doing, true if it is open; null if it has none.
const bool* menu_of(const Doing& doing);
bool* menu_of(Doing& doing);

// True during the guided start.
bool is_guided(const Doing& doing);

// True while samples go to the tissue, in a trial of a study or outside one.
bool palpates(const Doing& doing);

// True while keys move the indenter over the tissue or over the test area, and not the focus from control to control.
bool keys_move_indenter(const Doing& doing);

}  // namespace palpa::app
