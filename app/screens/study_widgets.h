#pragma once
// What the screens of a study share (study_screen.cpp, study_consent_screen.cpp).

#include <string>

#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "app/study/study_run.h"

namespace palpa::app {

bool enter_pressed(const Gui& gui);

// The button that leads on; Enter does the same.
bool forward(const char* label, const Gui& gui, bool enabled = true);
void title(const std::string& text);
void gap(const Gui& gui);

// The button that leaves the study. On a tablet, which has no window to close, it leads to the rest of the app.
void leave_button(const Gui& gui, const StudyRun& run, Wishes& wishes);

// The experimenter's button on a tablet for pairing, sending and exporting.
void trials_button(const Gui& gui, const StudyRun& run, Wishes& wishes);

// The button with which a participant stops taking part; it asks before.
void stop_button(const Gui& gui, Wishes& wishes);

// study_consent_screen.cpp: draws the steps of consent and withdrawal, and what is told after practice. Returns false
// in all other steps.
bool draw_consent_step(const StudyRun& run, Gui& gui, Wishes& wishes);

}  // namespace palpa::app
