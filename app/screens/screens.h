#pragma once
// What the app shows, screen by screen. The functions draw what the loop (app/live) gives them, and return what the
// person asked for in Wishes, which the loop carries out. A picture can therefore be drawn without a window on a
// display.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scene_choices.h"
#include "app/screens/doing.h"
#include "app/screens/gui.h"
#include "app/screens/part_view.h"
#include "app/screens/settings.h"
#include "render/tissue.h"
#include "scene/scene.h"
#include "session/trial.h"

struct ImDrawList;

namespace palpa::app {

enum class Screen : std::uint8_t {
    trial,
    devices,
    scale,
    calibrate,
    maps,
    history,
    tactile,
    tangible
};  // screens that a person can ask for

struct Wishes {
    std::optional<platform::Action> action;  // mark, confidence, undo, finish, pause, resume
    std::optional<std::string> scene;        // file
    std::optional<std::string> profile;      // file; empty: the scene's own
    std::optional<Screen> screen;            // trial: back to it, or to what it revealed
    std::optional<bool> menu;                // true: open it; false: close it
    std::optional<session::TrialMode> mode;
    std::optional<bool> left_handed;
    std::optional<bool> above_finger;
    std::optional<bool> side_view;
    std::optional<double> px_per_mm;  // of this screen, measured; NaN: forget it
    std::optional<StudyWish> study;
    std::optional<PartWish> part;
    std::optional<bool> guided;  // true: begin the guided start; false: leave it
    std::optional<bool> keep_results;
    std::optional<int> text_percent;
    bool delete_results = false;  // of all trials, for good
    bool again = false;           // another trial on the same tissue
    bool next = false;            // another trial on the tissue turned another way
    bool save_picture = false;
    bool full_screen = false;  // enter or leave full screen
    bool press_by_hold = false;
    bool trials = false;           // show the trials that the keeper holds
    bool studies = false;          // let the person choose a study
    bool understood = false;       // dismiss the problems that are shown
    bool stop_devices = false;     // arm, pins and soft device, at once
    bool release_devices = false;  // after a stop or a fault that stays
    bool quit = false;
    bool sure = false;  // confirms that the marks of the present trial may be thrown away,
    bool stay = false;  // or that they may not
};

// What the app tells beside the tissue, and what there is to choose from.
struct Notices {
    std::vector<Choice> scenes;
    std::vector<Choice> profiles;
    std::vector<std::string> device_notes;    // about pens and fingers, to be read before the first press
    std::vector<std::string> pressure_notes;  // of a pen or finger without a sensor, which only its press shows
    std::vector<std::string> problems;        // the newest last, until they are dismissed
    std::string note;                         // good news ("saved ..."), shown for a while
    std::string note_seen;                    // the note that is shown,
    double note_since_s = 0.0;                // and since when
    bool trial_stopped = false;               // its files can no longer be written: nothing is marked or finished
    bool offer_hold = false;                  // offer to press by time to a pen or finger without pressure
    std::string screen_name;                  // key of Settings::px_per_mm
    double px_per_mm = platform::kMissing;    // of this screen; NaN: not measured
    std::string trials_note;                  // what the keeper holds, and what the desk has
    bool keeps_trials = false;                // in the browser: a screen of its own for trials, and no way to quit
    std::vector<platform::PointerDevice> devices;
    // `devices` is complete. False in a browser, where other devices may come with their first sample.
    bool devices_listed = false;
};

// Times of the frame loop.
struct FrameTimes {
    scene::Meter latency;  // from a sample to the end of the frame that shows it
    // From a sample to the moment when that frame is ready to be drawn, without the rasteriser.
    scene::Meter ready;
    std::int64_t built_ns = 0;  // this moment, steady clock
    scene::Meter cpu;           // of a frame up to the calls of GL
    scene::Meter gl;            // the calls of GL, which include the drawing with software rendering
    double frames_per_s = 0.0;
};

// What the window shows.
struct OnScreen {
    // Hash of what was drawn (content_hash.h); 0: unknown, so that the next frame is drawn.
    std::uint64_t content = 0;
    bool drawn = false;        // by the last draw_frame()
    std::uint64_t tissue = 0;  // the same of the tissue alone, without panels
};

// What is being typed in the present step of a study.
struct StudyForm {
    int step = -1;     // StudyRun::entered; another step begins with an empty form
    bool anew = true;  // and its page at its top
    std::string code;
    std::string offered;  // the code that the field began with
    // How many codes the step had refused when the field last got the focus.
    int refused = -1;
    std::vector<std::string> answers;  // to the items of this step, "" = not answered
    // The last digit came before it could be told from one for the step before. Enter then says so once, and goes on
    // when it is pressed again.
    bool too_early = false;
    bool told_too_early = false;
    study::TypedAnswers typed;
    double clock_began_s = 0.0;  // of `typed`; 0: the clock is stopped
};

// The scale of the screen, px per mm, while it is being measured.
struct ScaleForm {
    double card_px_per_mm = 3.78;
    double taken_px_per_mm = 0.0;  // of the card when the field was last drawn
    double typed_px_per_mm = 0.0;  // in the field, NaN: nothing
    double held_px_per_mm = 0.0;   // of the card when it was taken hold of
};

struct MapBrowser;     // map_screen.h
struct TactileShown;   // tactile_screen.h
struct TangibleShown;  // tangible_screen.h
struct HistoryView;    // history_screen.h

enum class MenuPage : std::uint8_t { trial, settings, experimenter };

// What the screens themselves keep from frame to frame. A replay does not need it.
struct ViewState {
    bool cost = false;  // the table of performance is open: the experimenter's view
    bool help = false;  // the list of keys is open
    MenuPage menu_page = MenuPage::trial;
    ScaleForm scale;                       // while the scale of the screen is being measured
    std::shared_ptr<MapBrowser> maps;      // while its screen is open, else null
    std::shared_ptr<HistoryView> history;  // likewise
    StudyForm study;
    PartView part;  // of the scene's parts
    FrameTimes times;
    OnScreen on_screen;
};

// All that the loop gives to be drawn.
struct ToShow {
    const scene::Scene& scene;
    const scene::Plan& plan;
    const session::Trial& trial;
    const Settings& settings;
    const Notices& notices;
    const Doing& doing;
    const std::optional<Wishes>& asked;       // would throw away marks or answers: done once the person has confirmed
    double now_s = 0.0;                       // on the clock of the samples
    double dt_s = 1.0 / 60.0;                 // since the last frame
    const TactileShown* tactile = nullptr;    // null: the scene has neither arm nor pins
    const TangibleShown* tangible = nullptr;  // null: the scene has no soft device
};

// The same while a frame is built, with what is derived from it.
struct Shown : ToShow {
    const scene::State& state;
    const FrameTimes& times;
    scene::Avatar avatar{};
    scene::SurfaceShape shape{};      // of the surface, as it is
    render::TissuePicture picture{};  // of the tissue, as it is drawn
    render::TissueView view{};        // picture.view
    double trial_s = 0.0;             // as the clock shows it
    bool experimenter = false;        // ViewState::cost
};

// Draws marks, lag, pen and (in practice) nodules over the tissue.
void draw_on_tissue(const Shown& shown, const Gui& gui);

void draw_trial_panel(const Shown& shown, const Layout& layout, Gui& gui, ViewState& view, Wishes& wishes);
// Draws what went wrong, in a panel, and dismisses it: with Escape only where it is seen and no menu is closed by that.
void draw_problems(const Shown& shown, const Gui& gui, Wishes& wishes);
// Where the guided start stands; it follows from the trial alone.
enum class GuidedStep : std::uint8_t { press, slide, mark, confidence, finish };
GuidedStep guided_step(const scene::Plan& plan, const session::Trial& trial);
// Returns the place on plain tissue that the first step asks to press.
Eigen::Vector2d plain_place_m(const scene::Plan& plan);
void draw_guided(const Shown& shown, const Layout& layout, Gui& gui, Wishes& wishes);

// Covers the tissue while the clock is stopped.
void draw_paused(const Shown& shown, const Layout& layout, Gui& gui, Wishes& wishes);
// Lists the keys, over everything else.
void draw_help(const Shown& shown, Gui& gui, ViewState& view);

// What a finished trial reveals.
Reviewing review_of(const scene::Plan& plan, const session::Trial& trial, const scene::View& view, bool guided = false);

// One sentence on what to do better, from what was found, where was pressed and how deep.
std::string advice_for(const scene::Plan& plan, const session::Trial& trial, const session::Debrief& debrief,
                       const scene::View& view);

// Draws the section through the contact, if the scene has one and the person wants to see it.
void draw_side_view(const Shown& shown, const Gui& gui);

void draw_menu(const Shown& shown, const Layout& layout, Gui& gui, ViewState& view, Wishes& wishes);
void draw_cost(const Shown& shown, const Layout& layout, Gui& gui);
void draw_reveal_on_tissue(const Shown& shown, const Gui& gui, const session::Debrief& debrief);
void draw_reveal_panel(const Shown& shown, const Layout& layout, const Reviewing& reviewing, Gui& gui, Wishes& wishes);
void draw_device_screen(const Shown& shown, const CheckingDevices& checking, Gui& gui, Wishes& wishes);
void add_dot(const platform::Sample& sample, std::vector<Dot>& dots);
void draw_study_screen(const StudyRun& run, double now_s, Gui& gui, StudyForm& form, Wishes& wishes);
// How many millimetres apart the numbers of a ruler stand that do not touch one another: 10, 20, 40 or 80. `number_px`: the
// width of the widest.
int ruler_step_mm(float px_per_mm, float number_px);
void draw_scale_screen(const Shown& shown, Gui& gui, ScaleForm& form, Wishes& wishes);

// True if the form holds answers that are not logged yet.
bool answers_at_stake(const StudyForm& form);

// While marks or answers are at stake: moves wishes that would throw them away into `asked`, and returns the other wishes.
Wishes ask_first(Wishes wishes, std::optional<Wishes>& asked);
void draw_ask(const Shown& shown, Gui& gui, Wishes& wishes);

// Removes the note once it has been shown for 8 s.
void age_note(double now_s, Notices& notices);

// Takes the keys, with which everything on the screens can be done.
void take_keys(const Shown& shown, const Gui& gui, ViewState& view, Wishes& wishes);

// Draws a progress bar in the middle of the screen, while nothing else can be shown.
void draw_progress(const std::string& what, double share);

}  // namespace palpa::app
