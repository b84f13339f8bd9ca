#pragma once
// The screen of the results that were kept: a list, a learning curve, and the path of each trial replayed.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/screens/screens.h"
#include "session/history.h"

namespace palpa::app {

struct HistoryView {
    std::filesystem::path folder;              // empty: this run keeps no results
    std::vector<std::filesystem::path> files;  // of trials, also of those that could not be read
    std::vector<session::KeptTrial> trials;    // oldest first
    std::vector<std::string> problems;         // files that could not be read
    std::size_t chosen = 0;                    // index in `trials`
    double shown_s = 0.0;                      // of the chosen trial's path, since the trial began
    bool plays = false;
    bool asks = false;  // whether everything is to be deleted
};

// Reads the folder; the newest trial is chosen, and its path is replayed.
std::shared_ptr<HistoryView> make_history_view(const std::filesystem::path& folder);

// Chooses a trial and replays its path.
void choose_trial(std::size_t index, HistoryView& history);

// The clock on the wall: "2026-11-21 10:30" of "2026-11-21T09:30:00Z" in Berlin; texts of another form stay as they are.
std::string local_time_text(const std::string& utc);

// What was found, in words; in a tissue without nodules there is nothing to find.
std::string found_text(const session::KeptTrial& trial);

// Moves the replay on by the time between frames; the whole path takes at most some seconds.
void play_on(double dt_s, HistoryView& history);

void draw_history_screen(const Shown& shown, Gui& gui, HistoryView& history, Wishes& wishes);

}  // namespace palpa::app
