#pragma once
// What the app shows, screen by screen. The functions draw from their arguments and return what the person asked for in
// Wishes; the loop (app/live) carries it out. A picture can therefore be drawn without a window on a screen.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scene_choices.h"
#include "app/screens/device_check.h"
#include "app/screens/gui.h"
#include "app/screens/settings.h"
#include "render/tissue.h"
#include "scene/scene.h"
#include "session/trial.h"

namespace palpa::app {

enum class Screen : std::uint8_t { trial, reveal, devices, scale, calibrate, study, maps };

// Times of the frame loop.
struct FrameTimes {
    scene::Meter latency;       // sample to the end of the frame that shows it
    scene::Meter ready;         // sample to the moment when that frame is ready to be drawn: without the rasteriser
    std::int64_t built_ns = 0;  // that moment, steady clock
    scene::Meter cpu;           // a frame up to the calls of GL
    scene::Meter gl;            // the calls of GL; with software rendering that is where the drawing is done
    double frames_per_s = 0.0;
};

struct Dot {
    float x_px, y_px, pressure;
    bool touching;
};

struct CalibrateForm;  // calibrate_form.h
struct MapBrowser;     // map_screen.h
struct StudyRun;       // study_run.h

struct Wishes {
    std::optional<platform::Action> action;  // mark, confidence, undo, finish
    std::optional<std::string> scene;        // file
    std::optional<std::string> profile;      // file; empty: the scene's own
    std::optional<Screen> screen;
    std::optional<session::TrialMode> mode;
    std::optional<bool> left_handed;
    std::optional<bool> above_finger;
    std::optional<double> px_per_mm;  // of this screen, measured; NaN: forget it
    bool again = false;               // the same tissue once more
    bool next = false;                // turned another way
    bool save_picture = false;
    bool full_screen = false;  // the other way round
    bool press_by_hold = false;
    bool trials = false;   // show what is kept
    bool studies = false;  // let the person choose one
    bool quit = false;
    bool sure = false;  // of throwing away the marks of the trial that goes on
};

// What is open, and what a person has typed so far. A replay does not need it.
struct Screens {
    Screen screen = Screen::trial;
    bool menu = false;
    bool cost = false;
    std::vector<Choice> scenes;
    std::vector<Choice> profiles;
    std::vector<std::string> device_notes;  // about pens, fingers, pressure
    std::vector<std::string> problems;      // what went wrong, newest last, until it is dismissed
    std::string note;                       // what went well ("saved ..."), for a while
    std::string note_seen;                  // the note that is shown,
    double note_since_s = 0.0;              // and since when
    std::optional<Wishes> asked;            // what would throw away marks: done once the person is sure
    bool offer_hold = false;                // a pen or finger without pressure: offer to press by time
    std::string screen_name;                // key of Settings::px_per_mm
    double px_per_mm = platform::kMissing;  // of this screen; NaN: not measured
    double card_px_per_mm = 3.78;           // while it is being measured
    std::string trials_note;                // what is kept, and what the desk has
    bool keeps_trials = false;              // in the browser: a screen of its own, no way to quit
    session::Debrief debrief;               // of the finished trial
    std::vector<platform::PointerDevice> devices;
    bool devices_listed = false;         // those are all; false, in a browser: others may come with their first sample
    std::shared_ptr<DeviceCheck> check;  // what they sent while the device check was open
    std::vector<Dot> dots;               // the last places in its test area
    std::shared_ptr<CalibrateForm> calibrate;  // while its screen is open
    std::shared_ptr<MapBrowser> maps;          // likewise
    std::shared_ptr<StudyRun> study;           // the app runs a study: no menu, no truth before the end
};

// All that a screen is drawn from.
struct Shown {
    const scene::Scene& scene;
    const scene::Plan& plan;
    const scene::State& state;
    const session::Trial& trial;
    const Settings& settings;
    const FrameTimes& times;
    scene::Avatar avatar;
    render::TissueView view;
    double trial_s = 0.0;
    double now_s = 0.0;
};

// Draws marks, lag, pen and (in practice) nodules over the tissue.
void draw_on_tissue(const Shown& shown, const Gui& gui);

void draw_trial_panel(const Shown& shown, const Layout& layout, Gui& gui, Screens& screens, Wishes& wishes);
void draw_menu(const Shown& shown, const Layout& layout, Gui& gui, Screens& screens, Wishes& wishes);
void draw_cost(const Shown& shown, const Layout& layout, Gui& gui);
void draw_reveal_on_tissue(const Shown& shown, const Gui& gui, const session::Debrief& debrief);
void draw_reveal_panel(const Shown& shown, const Layout& layout, Gui& gui, Screens& screens, Wishes& wishes);
void draw_device_screen(const Shown& shown, Gui& gui, Screens& screens, Wishes& wishes);
void add_dot(const platform::Sample& sample, Screens& screens);
void draw_study_screen(double now_s, Gui& gui, StudyRun& run, Wishes& wishes);
void draw_scale_screen(const Shown& shown, Gui& gui, Screens& screens, Wishes& wishes);

// While marks are at stake: puts wishes that would throw them away into screens.asked, and returns the other wishes.
Wishes ask_first(Wishes wishes, Screens& screens);
void draw_ask(const Shown& shown, Gui& gui, Screens& screens, Wishes& wishes);

// Takes the note off the screen when it has been there for a while.
void age_note(double now_s, Screens& screens);

// Takes the keys; everything on the screens can be done with them.
void take_keys(const Shown& shown, const Gui& gui, Screens& screens, Wishes& wishes);

// Draws a progress bar in the middle of the screen, while nothing else can be shown.
void draw_progress(const std::string& what, double share);

}  // namespace palpa::app
