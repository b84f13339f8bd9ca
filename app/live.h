#pragma once
// The app on a screen: input, advance, log and drawing on one thread. And pictures without a screen.

#include <filesystem>
#include <optional>
#include <string>

#include "app/screens.h"
#include "files/json.h"

namespace palpa {

// `palpa run`, as typed.
struct RunOptions {
    std::string scene;
    std::string trace;        // replayed at its own pace instead of a pen
    std::string log;          // folder, empty for none
    std::string participant = "01";
    std::string record;       // TRACE.tsv, empty for none
    std::string screenshot;   // of the last frame
    double quit_after_s = 0.0;  // 0: until the window is closed
    int width_px = 0;         // 0: as last time
    int height_px = 0;
    bool test = false;        // nodules hidden until the end; neither: as last time
    bool practice = false;    // nodules shown
    bool left_handed = false;
    Screen screen = Screen::trial;  // that is open first
    std::string protocol;     // of a study: its trials, instead of a scene; `log` is its folder
    bool headless = false;
    bool json = false;
};

// Returns what `run --json` prints, or nothing if the window was closed before the tissue was ready. Throws InputError or std::runtime_error before the loop or after it.
std::optional<Json> run_live(const RunOptions& options);

}  // namespace palpa
