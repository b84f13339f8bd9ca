#pragma once
// What live.cpp and live_study.cpp share: everything that the app has open, and the steps of a trial.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/live.h"
#include "app/screens.h"
#include "app/session.h"
#include "platform/hold_press.h"
#include "platform/pressure.h"
#include "platform/trace.h"

namespace palpa {

// Everything that the app has open while its window is.
struct App {
    RunOptions options;
    Settings settings;
    std::filesystem::path settings_path;  // empty: this run keeps none
    Screens screens;
    Session session;
    std::optional<Trace> trace;  // replayed
    std::size_t next_row = 0;
    double trace_shift_s = 0.0;  // window's clock - trace's clock
    FrameTimes times;
    std::int64_t frames = 0;
    PressureWatch pressure;
    HoldPress hold;
    std::vector<double> waiting_s;  // host times of the samples that no frame has shown yet
    std::string stopped;            // why the trial cannot go on
    TrialKeeper* keeper = nullptr;  // may be null
    double looked_s = 0.0;          // when devices were listed last
    double parted_s = 0.0;          // when the keeper last had the trial so far
    bool begin_waits = false;       // for the keeper to have the last trial
    bool quit = false;
};

// live.cpp
TraceInfo info_of(const App& app, const Window& window);
double now_of(const App& app, const Window& window);  // of samples
double finger_offset_mm(const App& app);              // 0, or kFingerOffset_mm
bool close_trial(App& app);  // its files whole on the disk, and with the keeper; false: app.stopped says why not
void act(Action action, double now_s, App& app);

// live_trial.cpp
void turn_tissue(App& app);    // the eight turns in an order that the seed decides, so that nobody learns where its nodules are
void turn_if_shown(App& app);  // whoever has seen where the nodules are is tested on them somewhere else
void end_press(double now_s, App& app);  // that goes on when something else takes the screen
bool marks_at_stake(const App& app);     // that nobody has scored yet, in a trial that goes on

// live_devices.cpp
void note_devices(const Window& window, App& app);  // into app.screens

// live_study.cpp: a study's trials instead of a scene that was chosen. `app.screens.study` is there.
void load_study(const RunOptions& options, App& app);  // throws InputError or std::runtime_error
void follow_study(const Window& window, const Gui& gui, App& app);  // what a screen has led to, the end of a trial's time
void finish_study_trial(App& app);
bool allowed(const Sample& sample, App& app);  // its condition names the device
Json study_json(const App& app);               // how far it is
Json close_study(const Gui& gui, App& app);    // throws std::runtime_error if the study had to stop

}  // namespace palpa
