#pragma once
// What the sources of app/live share: everything that the app has open, and the steps of a trial.

#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/live/live.h"
#include "app/screens/doing.h"
#include "app/screens/frame.h"
#include "app/screens/screens.h"
#include "platform/hold_press.h"
#include "platform/pressure.h"
#include "platform/trace.h"
#include "session/session.h"

namespace palpa::app {

// How it stands with the trial, whatever screen is open.
struct GoesOn {};
struct WaitsForKeeper {};  // which has not stored the last one yet; no trial begins before
struct TrialStopped {      // its files can no longer be written
    std::string why;
};
using Course = std::variant<GoesOn, WaitsForKeeper, TrialStopped>;

// Everything that the app has open while its window is.
struct App {
    RunOptions options;
    Settings settings;
    std::filesystem::path settings_path;  // empty: this run keeps none
    Doing doing;                          // while the window is open, go_to() changes it; a study changes its own step
    std::optional<Wishes> asked;          // would throw away marks: done once the person is sure
    Notices notices;
    ViewState view;
    std::shared_ptr<DeviceCheck> check;  // the last one
    session::Session session;
    std::optional<scene::Scene> unprepared;  // its tissue is computed once there is a window that can say so
    std::optional<platform::Trace> trace;    // replayed
    std::size_t next_row = 0;
    double trace_shift_s = 0.0;     // window's clock - trace's clock
    std::int64_t frames = 0;        // drawn
    double drawn_s = 0.0;           // window's clock, at the last frame that was drawn
    double devices_noted_s = -1e9;  // when devices were listed last
    bool save_waits = false;        // a picture of the next frame is wanted
    platform::PressureWatch pressure;
    platform::HoldPress hold;
    std::vector<double> waiting_s;  // host times of the samples that no frame has shown yet
    Course course;
    session::TrialKeeper* keeper = nullptr;  // may be null
    double parted_s = 0.0;                   // when the keeper last had the trial so far
    bool quit = false;
};

// The app's own frame time, since software rendering has no vertical sync.
inline constexpr double kFrame_s = 1.0 / 60.0;

// Shows a problem on the screen, instead of letting its exception end the program.
template <class Work>
bool attempt(App& app, const Work& work) {
    try {
        work();
        return true;
    } catch (const std::exception& error) {
        app.notices.problems.push_back(error.what());
        return false;
    }
}

// prepare_run.cpp
void load(const RunOptions& options, App& app);  // everything that bad input can refuse, before a window is there
void know_screen(const platform::Window& window, App& app);  // how large the settings say that it is
bool prepare_chosen(platform::Window& window, Gui& gui,
                    App& app);  // what load() left unprepared; false: the window was closed

// go_to.cpp
// Leaves what the app is doing, and does `next` instead: a press or a recording of the screen before ends.
void go_to(Doing next, platform::Window& window, App& app);
void open_screen(Screen screen, platform::Window& window, App& app);
Doing back_to_trial(const App& app);  // or to what it revealed
bool trial_stopped(const App& app);
bool waits_for_keeper(const App& app);

// wishes.cpp
void keep_settings(App& app);
void carry_out(const Wishes& asked_for, platform::Window& window, Gui& gui, App& app);

// trials.cpp
platform::TraceInfo info_of(const App& app, const platform::Window& window);
double now_of(const App& app, const platform::Window& window);  // of samples
double finger_offset_mm(const App& app);                        // 0, or kFingerOffset_mm; a trace's own
files::Json result_of(const App& app);                          // what `run --json` says so far
// Ends all presses and drops their later samples: a press belongs to the trial and the screen in which it began.
void end_presses(platform::Window& window, App& app);
// Ends the presses and the trial, then puts the tissue of `scene` under the hand. A trial begins on it with begin().
void put_scene(scene::Scene scene, std::shared_ptr<const scene::Plan> plan, platform::Window& window, App& app);
// Makes the plan. If its tissue has to be computed, the window shows the progress. Returns nothing if the window was
// closed before the plan was ready.
std::shared_ptr<const scene::Plan> prepare(platform::Window& window, Gui& gui, const scene::Scene& scene);
void begin(platform::Window& window, const Gui& gui,
           App& app);  // a trial; throws InputError or std::runtime_error
void begin_anew(platform::Window& window, const Gui& gui,
                App& app);  // ends the one that goes on; waits for a keeper that is busy
void begin_when_kept(platform::Window& window, const Gui& gui, App& app);  // what begin_anew() left waiting
// Changes to another scene or profile. If anything is wrong with it, the present one stays.
void change_scene(platform::Window& window, Gui& gui, const std::string& file, const std::string& profile, App& app);
// Turns the tissue to the next of eight orientations, in an order that the seed decides, so that nobody learns where
// its nodules are. Begin a trial after it.
void turn_tissue(platform::Window& window, App& app);
void turn_if_shown(platform::Window& window,
                   App& app);         // whoever has seen where the nodules are is tested on them somewhere else
bool marks_at_stake(const App& app);  // that nobody has scored yet, in a trial that goes on
// Its files whole on the disk, and with the keeper. Returns why not, or nothing; the trial is stopped then.
std::string close_trial(App& app);
void act(platform::Action action, platform::Window& window, App& app);

// device_notes.cpp
void note_devices(const platform::Window& window, App& app);  // into app.notices

// study_trials.cpp: a study's trials instead of a scene that was chosen. app.doing is a StudyRun.
void load_study(const RunOptions& options, App& app);  // throws InputError or std::runtime_error
// What was asked for in a step, what that has led to, the end of a trial's time.
void follow_study(const std::optional<StudyWish>& wish, platform::Window& window, const Gui& gui, App& app);
void finish_study_trial(platform::Window& window, App& app);
double trial_ends_s(const App& app);  // at this time its limit ends the trial that goes on; infinity: never
bool allowed(const platform::Sample& sample, App& app);  // its condition names the device
files::Json study_json(const App& app);                  // how far it is
files::Json close_study(const Gui& gui, App& app);       // throws std::runtime_error if the study had to stop

}  // namespace palpa::app
