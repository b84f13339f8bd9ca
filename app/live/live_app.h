#pragma once
// What the sources of app/live share: everything that the app has open, and the steps of a trial.

#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/live/device_control.h"
#include "app/live/live.h"
#include "app/live/tactile_driver.h"
#include "app/live/tangible_driver.h"
#include "app/screens/doing.h"
#include "app/screens/frame.h"
#include "app/screens/pins_preview.h"
#include "app/screens/screens.h"
#include "app/screens/tactile_screen.h"
#include "app/screens/tangible_screen.h"
#include "platform/hold_press.h"
#include "platform/pressure.h"
#include "platform/trace.h"
#include "session/plan_in_progress.h"
#include "session/session.h"

namespace palpa::app {

// The state of the trial, whatever screen is open.
struct GoesOn {};
struct WaitsForKeeper {};  // the keeper is still storing the last trial; no trial begins before
struct TrialStopped {      // the trial's files can no longer be written
    std::string why;
    double at_s = 0.0;  // when the clock stopped
};
using Course = std::variant<GoesOn, WaitsForKeeper, TrialStopped>;

// Arm and pins of the scene.
struct TactileControl : DeviceControl<TactileDriver, TactileShown> {
    std::shared_ptr<PinsPreview> preview;  // for pins that are only drawn; null: there are none
};
using TangibleControl = DeviceControl<TangibleDriver, TangibleShown>;  // the soft device of the scene

// Designs of parts that are being changed.
struct PartControl {
    bool looked = false;                             // for files of earlier edits
    std::unique_ptr<session::PlanInProgress> cells;  // the plan with finite cells, while they are computed
    scene::Scene wanted;                             // its scene
    struct Done {
        std::size_t design;
        std::filesystem::path before;  // the design's file before the edit
    };
    std::vector<Done> done;
    struct Undone {
        std::size_t design;
        files::Json operation;
    };
    std::vector<Undone> undone;                           // the last one is done again first
    std::optional<parts::Method> method;                  // that the person has chosen
    std::map<std::size_t, std::filesystem::path> copies;  // by the number of the design that was changed
};

struct FramesSoFar {
    std::int64_t count = 0;
    FrameTimes times;
};

// Everything that the app has open while its window is open.
struct App {
    RunOptions options;
    Settings settings;
    std::filesystem::path settings_path;   // empty: this run keeps none
    Settings kept_settings;                // as they were last read or saved
    Doing doing;                           // while the window is open, go_to() changes it; a study changes its own step
    bool guided = false;                   // the present trial is of the guided start
    std::filesystem::path history_folder;  // empty: no results are kept
    std::optional<Wishes> asked;           // would throw away marks or answers: done once the person has confirmed
    Notices notices;
    ViewState view;
    std::shared_ptr<DeviceCheck> check;  // the last device check
    session::Session session;
    std::optional<scene::Scene> unprepared;  // its tissue is computed once a window can show the progress
    std::optional<platform::Trace> trace;    // replayed
    std::size_t next_row = 0;
    double trace_shift_s = 0.0;        // window's clock - trace's clock
    std::int64_t frames = 0;           // number of frames drawn
    FramesSoFar before_trial;          // when the present trial began
    double drawn_s = 0.0;              // window's clock when the last frame was drawn
    bool hidden = false;               // out of sight
    bool over_unseen = false;          // the time of a study's trial was over when the app came back into sight
    double devices_noted_s = -1e9;     // window's clock when the devices were last listed
    bool save_waits = false;           // a picture of the next frame is to be saved
    platform::PressureWatch pressure;  // what pens and fingers have sent; nothing while a trace is replayed
    platform::HoldPress hold;
    std::vector<double> waiting_s;  // host times of the samples that no frame has shown yet
    Course course;
    std::string lost;  // why a trial, this or an earlier one, could not be written; for the exit status
    session::TrialKeeper* keeper = nullptr;  // may be null
    TactileControl tactile;
    TangibleControl tangible;
    PartControl parts;
    double parted_s = 0.0;         // when the keeper was last given the trial so far
    std::size_t parted_marks = 0;  // how many marks it had then
    bool quit = false;
};

// The app's own frame time, since software rendering has no vertical sync.
inline constexpr double kFrame_s = 1.0 / 60.0;

// Runs `work`. Shows its exception as a problem on the screen, instead of letting it end the program, and returns
// false.
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
// Does everything that bad input can make fail, before there is a window. Throws InputError or std::runtime_error.
void load(const RunOptions& options, App& app);
// Reads the scale of the window's screen from the settings.
void know_screen(const platform::Window& window, App& app);
// Prepares the tissue that load() left unprepared. Returns false if the window was closed.
bool prepare_chosen(platform::Window& window, Gui& gui, App& app);

// go_to.cpp
// Ends what the app is doing, with any press or recording of its screen, and does `next` instead.
void go_to(Doing next, platform::Window& window, App& app);
void open_screen(Screen screen, platform::Window& window, App& app);
Doing back_to_trial(const App& app);  // Palpating, or Reviewing if the trial is finished
bool trial_stopped(const App& app);
bool waits_for_keeper(const App& app);

// wishes.cpp
void keep_settings(App& app);
void carry_out(const Wishes& asked_for, platform::Window& window, Gui& gui, App& app);

// trials.cpp
platform::TraceInfo info_of(const App& app, const platform::Window& window);
double now_of(const App& app, const platform::Window& window);  // on the clock of the samples
double finger_offset_mm(const App& app);                        // 0 or kFingerOffset_mm; in a replay, that of the trace
files::Json result_of(const App& app);                          // what `run --json` would print now
void begin_figures(App& app);  // a trial begins: the figures of frames in its files are its own
// Ends all presses and drops their later samples: a press belongs to the trial and the screen in which it began.
void end_presses(platform::Window& window, App& app);
// Ends the presses and the trial, then replaces the tissue by that of `scene`. begin() begins a trial on it.
void put_scene(scene::Scene scene, std::shared_ptr<const scene::Plan> plan, platform::Window& window, App& app);
// Makes the plan. If its tissue has to be computed, the window shows the progress. Returns nothing if the window was
// closed before the plan was ready.
std::shared_ptr<const scene::Plan> prepare(platform::Window& window, Gui& gui, const scene::Scene& scene);
// Begins a trial. Throws InputError or std::runtime_error.
void begin(platform::Window& window, const Gui& gui, App& app);
// Ends the present trial and begins a new one, or leaves it waiting for a keeper that is busy.
void begin_anew(platform::Window& window, const Gui& gui, App& app);
void begin_when_kept(platform::Window& window, const Gui& gui, App& app);  // begins what begin_anew() left waiting
// Changes to another scene or profile. Returns false if it cannot be prepared: the present one stays.
bool change_scene(platform::Window& window, Gui& gui, const std::string& file, const std::string& profile, App& app);
// Begins the guided start: a practice trial on the default scene.
void begin_guided(platform::Window& window, Gui& gui, App& app);
// Ends it. What was begun goes on as a practice trial; after its result, a new one begins.
void leave_guided(platform::Window& window, const Gui& gui, App& app);
// Turns the tissue of a scene that asks for it (mapping.random_turn) one of eight ways at random.
void draw_turn(scene::Scene& scene);
// Turns the tissue to the next of eight orientations, in an order that the seed decides, so that nobody learns where
// its nodules are. A trial must be begun after it.
void turn_tissue(platform::Window& window, App& app);
// Turns the tissue if the person has seen where the nodules are, so that the next test has them somewhere else.
void turn_if_shown(platform::Window& window, App& app);
// True if the present trial has marks that are not scored yet, or the study's form answers that are not logged yet.
bool not_touched(const App& app);  // neither the screen in this trial nor, where it leads, the device
bool work_at_stake(const App& app);
// Takes a change of the window's size, or of the hand's side, as a sample: a replay must map positions in the same way. A
// trial that is over takes no samples any more, but what it reveals stays in the window.
void note_resize(const platform::Window& window, const Gui& gui, App& app);
// Closes the files of the trial and hands them to the keeper. If they could not be written, stops the trial and returns
// why, else "".
std::string close_trial(const platform::Window& window, App& app);
void act(platform::Action action, platform::Window& window, App& app);

// part_live.cpp
// Carries out an edit of a part, or takes the last one back. What cannot be done becomes a problem on the screen.
void change_part(const PartWish& wish, platform::Window& window, const Gui& gui, App& app);
void forget_parts(App& app);  // before another scene
void note_method(App& app);   // which the person has just chosen: it stays when the parts are changed
void follow_parts(platform::Window& window, const Gui& gui, App& app);  // once per turn of the loop

// driven_devices.cpp: the devices of the scene, arm and pins or a soft device.
// Calls visit(control) for each kind of device.
template <class AnyApp, class Visit>
void for_each_device(AnyApp& app, const Visit& visit) {
    visit(app.tactile);
    visit(app.tangible);
}
// Notes what the session's scene asks of devices, and drives nothing.
void know_devices(App& app);
bool devices_ready(App& app);  // the devices run, or could not be opened (DriveState::problem), or there are none
void begin_devices(App& app);  // the trial does not wait for its devices, and goes on without them
void rest_devices(App& app);
void follow_devices(double now_s, App& app);  // once per turn of the loop
void stop_devices(App& app);                  // F12: at once, and until release_devices()
void release_devices(App& app);
bool devices_failed(double now_s, const App& app);  // one has stopped, or a fault does not pass
bool devices_driven(const App& app);                // a trial drives one, or opens it

// tactile_live.cpp and tangible_live.cpp: what is of each kind alone, for driven_devices.cpp and study_devices.cpp.
void know_tactile(App& app);
void know_tangible(App& app);
// Begins to open the scene's devices, unless they are stopped. `rows`: file for the rows of their loop; may be empty.
void drive_tactile(const std::filesystem::path& rows, App& app);
void drive_tangible(const std::filesystem::path& rows, App& app);
void follow_tactile(double now_s, App& app);
void follow_tangible(double now_s, App& app);

// device_notes.cpp
void note_devices(const platform::Window& window, App& app);  // into app.notices

// study_devices.cpp: the devices of a study's trial.
bool devices_stopped(
    const App& app);             // stopped, or could not be opened: somebody has to read it before the trial begins
void forget_problems(App& app);  // why they could not be opened
void note_missing(const App& app, StudyRun& run);  // what they lack, or why they were stopped
// Begins to open them, once for each trial that is due. Returns true when they run, or there are none.
bool study_devices_ready(App& app);
void name_devices(const App& app, study::TrialLabel& label);  // in the trial's settings

// study_trials.cpp: the trials of a study; app.doing is a StudyRun.
void load_study(const RunOptions& options, App& app);  // throws InputError or std::runtime_error
// Carries out what was asked for in a step and its consequences, and ends a trial whose time is over.
void follow_study(const std::optional<StudyWish>& wish, platform::Window& window, const Gui& gui, App& app);
void finish_study_trial(platform::Window& window, App& app);
// Interrupts a trial that is to be finished, so that it is repeated, if its pen's pressure has never varied (short taps of a pen
// without a sensor look so) or its touches gave no force for want of a level. Returns true if it did.
bool repeat_if_unproven(platform::Window& window, App& app);
// Whether what leads is the motion on a device, not that on the screen.
bool felt_elsewhere(const App& app);
// Returns when the time limit ends the present trial; infinity: never.
double trial_ends_s(const App& app);
// The app goes out of sight, or comes back: a trial whose time is over meanwhile says nothing about the person.
void note_sight(bool hidden, double now_s, App& app);
bool allowed(const platform::Sample& sample, App& app);  // the due condition allows the sample's device
files::Json study_json(const App& app);                  // the progress
// Throws std::runtime_error if the study had to stop.
files::Json close_study(const platform::Window& window, const Gui& gui, App& app);

}  // namespace palpa::app
