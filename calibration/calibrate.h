#pragma once
// From measured points to a profile, with everything that should be known about it.

#include <optional>
#include <string>
#include <vector>

#include "calibration/bootstrap.h"
#include "calibration/choose.h"
#include "calibration/dynamics.h"
#include "calibration/points.h"
#include "calibration/profile.h"
#include "calibration/quality.h"

namespace palpa::calibration {

struct CalibrateOptions {
    std::optional<CurveModel> model;  // none: chosen by cross-validation
    std::optional<ErrorModel> error;
    Robust robust = Robust::huber;
    std::optional<LevelField> level;  // none: pressure, or pressure_raw if levels exceed 1
    std::optional<LevelRange> range;  // none: level_range_of()
    double full_contact_area_px2 = 8000.0;
    bool remove_lag = true;
    int bootstrap_fits = 1000;  // 0: no intervals
    std::uint64_t seed = 1;
};

struct LevelsDelivered {
    std::size_t distinct = 0;
    double smallest_step = platform::kMissing;
    double widest_gap = platform::kMissing;  // between neighbours within the device's range
    double gap_from = platform::kMissing;
    int equal_gaps = 0;  // as wide as the widest, the first of which begins at gap_from
};

// Points whose prediction by a fit without them is off by more than 8 robust scales. Of two readings of one level that differ
// both are, since nothing tells which of them is right.
struct Slips {
    std::size_t count = 0;
    std::vector<double> followed_levels;  // where the curve goes after them by 5 %, or 1 % of the greatest force
};

struct Calibration {
    Profile profile;
    Candidate chosen;          // with predictions of each point by a fit without its fold
    FitPoints points;          // the points that the curve was fitted to
    Eigen::ArrayXd fitted_N;   // the curve at these points
    std::size_t n_points = 0;  // rows read
    Ends ends;
    FitQuality quality;
    std::vector<ErrorBand> bands;                       // of the predictions in `chosen`
    double median_relative_error = platform::kMissing;  // of the predictions in `chosen`
    double force_at_full_N = 0.0;
    bool by_repeats = false;  // the folds are the repeats
    Bootstrap bootstrap;
    std::optional<double> lag_s;  // that was removed
    std::optional<Hysteresis> hysteresis;
    std::optional<Drift> drift;
    LevelsDelivered levels;
    Slips slips;
    std::vector<std::string> warnings;  // in plain words: notes, ends of the range, errors, data
};

// Throws InputError for levels that cannot be of that field: shares where counts are read would give the curve's lowest force
// for ever, counts where shares are read its highest. range: of the levels.
void check_level(LevelField level, const LevelRange& range, const std::string& file);

// Fits a profile. Throws InputError if no curve that rises can be fitted; every number of the curve is finite.
Calibration calibrate(const CalibrationRows& rows, const CalibrateOptions& options);

// Returns what a person must know before trusting the profile; `notes` come first.
std::vector<std::string> warnings_of(const Calibration& calibration, const std::vector<std::string>& notes);

}  // namespace palpa::calibration
