#pragma once
// The app on a screen: input, advance, log and drawing on one thread. And pictures without a screen.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/screens/screens.h"
#include "files/json.h"
#include "session/keeper.h"

namespace palpa::app {

// `palpa run`, as typed.
struct RunOptions {
    std::string scene;
    std::string trace;  // replayed at its own pace instead of a pen
    std::string log;    // folder, empty for none
    std::string participant = "01";
    int first_run = 1;          // of the log
    std::string record;         // TRACE.tsv, empty for none
    std::string screenshot;     // of the last frame
    double quit_after_s = 0.0;  // 0: until the window is closed
    int width_px = 0;           // 0: as last time
    int height_px = 0;
    bool test = false;      // nodules hidden until the end; neither: as last time
    bool practice = false;  // nodules shown
    bool left_handed = false;
    Screen screen = Screen::trial;  // that is open first
    std::string protocol;           // of a study: its trials, instead of a scene; `log` is its folder
    bool headless = false;
    bool json = false;
};

// The app while its window is open, a turn at a time: for a system that calls, as a browser does.
class Live {
  public:
    // Throws InputError or std::runtime_error before there is anything to see. `keeper` outlives it, or is null.
    explicit Live(const RunOptions& options, session::TrialKeeper* keeper = nullptr);
    ~Live();
    Live(const Live&) = delete;
    Live& operator=(const Live&) = delete;

    bool ready() const;  // false: the window was closed before the tissue was

    // Reads, simulates, logs, and shows a frame if one is due. `now` and `nothing` do not wait for input.
    // Returns false once the app is over.
    enum class Draw : std::uint8_t { when_due, now, nothing };
    bool turn(Draw draw);

    // The window has gone out of sight, or come back: presses end, the gap is logged, what there is is kept.
    void out_of_sight(bool hidden);

    // The field that takes letters now, for a screen that brings its own keyboard.
    std::optional<Gui::TextField> text_field() const;
    void type_instead(const std::string& text);

    void renew_drawing();        // the GL context was lost, and is back
    files::Json report() const;  // as `run --json` so far
    files::Json close();         // throws std::runtime_error if a file could not be written
  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Returns what `run --json` prints, or nothing if the window was closed before the tissue was ready. Throws InputError or std::runtime_error before the loop or after it.
std::optional<files::Json> run_live(const RunOptions& options);

}  // namespace palpa::app
