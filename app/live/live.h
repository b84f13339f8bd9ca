#pragma once
// The app on a screen: input, simulation, log and drawing on one thread.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/screens/screens.h"
#include "files/json.h"
#include "session/keeper.h"

namespace palpa::app {

// The options of `palpa run`.
struct RunOptions {
    std::string scene;
    std::string trace;  // replayed at its own pace, instead of input from a pen
    std::string log;    // folder, empty for none
    std::string participant = "01";
    int first_run = 1;          // of the log
    std::string record;         // TRACE.tsv, empty for none
    std::string screenshot;     // PNG of the last frame; empty for none
    double quit_after_s = 0.0;  // 0: until the window is closed
    int width_px = 0;           // 0: as last time
    int height_px = 0;
    bool test = false;      // nodules hidden until the end; without this and `practice`: as last time
    bool practice = false;  // nodules shown
    bool left_handed = false;
    bool guided = false;            // begin with the guided start
    Screen screen = Screen::trial;  // the screen that is open first
    // A study's protocol: its trials replace the scene, and `log` is its folder.
    std::string protocol;
    bool simulate_devices = false;  // arm and pins: starts their simulators
    bool headless = false;
    bool json = false;
};

// The app while its window is open, one turn of its loop at a time, for a system that calls the program, as a browser
// does.
class Live {
  public:
    // Throws InputError or std::runtime_error before anything is shown. `keeper` must outlive the object, or be null.
    explicit Live(const RunOptions& options, session::TrialKeeper* keeper = nullptr);
    ~Live();
    Live(const Live&) = delete;
    Live& operator=(const Live&) = delete;

    bool ready() const;  // false: the window was closed before the tissue was ready

    // Reads, simulates, logs, and shows a frame if one is due. With `now` and `nothing` it does not wait for input, and
    // with `nothing` it shows no frame. Returns false once the app is over.
    enum class Draw : std::uint8_t { when_due, now, nothing };
    bool turn(Draw draw);

    // To be called when the window goes out of sight, or comes back: ends the presses, logs the gap, and gives the
    // keeper the trial so far.
    void out_of_sight(bool hidden);
    void follow_window();  // on a desk: does so when the window is minimised, or back

    // Returns the field that takes letters now, for a screen with an on-screen keyboard; type_instead() replaces its
    // text.
    std::optional<Gui::TextField> text_field() const;
    void type_instead(const std::string& text);

    void renew_drawing();        // after the GL context was lost and restored
    files::Json report() const;  // what `run --json` would print now
    files::Json close();         // the final report; throws std::runtime_error if a file could not be written
  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Returns what `run --json` prints, or nothing if the window was closed before the tissue was ready. Throws InputError
// or std::runtime_error before the loop or after it.
std::optional<files::Json> run_live(const RunOptions& options);

// Throws InputError unless the name of a picture ends in .png.
void check_png_name(const std::string& name);

}  // namespace palpa::app
