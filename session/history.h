#pragma once
// The results of a person's own trials, kept without being asked: one small file for each finished trial. A file is
// never overwritten, and is on the disk before the function that writes it returns.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "session/session.h"

namespace palpa::session {

struct KeptNodule {
    std::string id;
    double x_mm = 0.0;
    double y_mm = 0.0;
    double diameter_mm = 0.0;
    double length_mm = 0.0;  // of a rod with round ends; up to the diameter it is a disc
    double angle_deg = 0.0;  // of its axis, counter-clockwise from +x
    Finding finding = Finding::not_touched;
};

struct KeptMark {
    double x_mm = 0.0;
    double y_mm = 0.0;
    int confidence = 0;  // 0: the person did not say
    double time_s = 0.0;
    bool hit = false;
};

struct KeptPoint {
    double time_s = 0.0;  // of the person's clock: since the first touch, without pauses
    double x_mm = 0.0;
    double y_mm = 0.0;
    double depth_mm = 0.0;
    bool begins = false;  // the first point of a press
};

// A finished trial. Places are in the tissue's own frame; `rotate_deg` and `flip` say how it lay on the screen.
struct KeptTrial {
    std::string utc;  // when it was finished, such as 2026-11-21T09:30:00Z
    std::string scene;
    TrialMode mode = TrialMode::practice;
    int rotate_deg = 0;
    bool flip = false;
    double x_mm = 0.0;  // centre of the tissue
    double y_mm = 0.0;
    double width_mm = 0.0;
    double height_mm = 0.0;
    double known_depth_mm = 0.0;
    double clock_s = 0.0;
    int found = 0;
    int false_positives = 0;
    bool scored = true;                    // false: the tissue did not say which nodules it has
    double coverage[3] = {0.0, 0.0, 0.0};  // share pressed light, medium, deep, or deeper
    double max_force_N = 0.0;
    std::vector<KeptNodule> nodules;
    std::vector<KeptMark> marks;
    std::vector<KeptPoint> path;  // at most kKeptPoints
};
inline constexpr std::size_t kKeptPoints = 3000;

// Returns the session's finished trial.
KeptTrial kept_trial(const Session& session, const std::string& utc);

// Writes a new file into the folder, which is made if need be. Returns the file. Throws std::runtime_error.
std::filesystem::path keep_trial(const KeptTrial& trial, const std::filesystem::path& folder);

// Throws InputError that names file, key, what was found and what was expected.
KeptTrial read_kept_trial(const std::filesystem::path& file);

// Returns the files of kept trials in the folder, and nothing else that is there; of no folder, none. If it cannot be read,
// `problems` says why.
std::vector<std::filesystem::path> history_files(const std::filesystem::path& folder,
                                                 std::vector<std::string>& problems);

// Reads the trials, oldest first. A file that cannot be read is left out, and `problems` says why.
std::vector<KeptTrial> read_history(const std::vector<std::filesystem::path>& files,
                                    std::vector<std::string>& problems);

// Deletes the files, which a person has agreed to: not those that came since. Throws std::runtime_error.
void delete_history(const std::vector<std::filesystem::path>& files);

}  // namespace palpa::session
