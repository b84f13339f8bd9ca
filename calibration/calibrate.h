#pragma once
// From measured points to a profile, and everything that should be known about it.

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
    std::optional<LevelField> level;  // none: pressure, or pressure_raw where levels exceed 1
    std::optional<LevelRange> range;  // none: level_range_of()
    double full_contact_area_px2 = 8000.0;
    bool remove_lag = true;
    int bootstrap_fits = 1000;  // 0: no intervals
    std::uint64_t seed = 1;
};

struct LevelsDelivered {
    std::size_t distinct = 0;
    double smallest_step = platform::kMissing;
    double widest_gap = platform::kMissing;  // between neighbours, inside the measured range
    double gap_from = platform::kMissing;
};

struct Calibration {
    Profile profile;
    Candidate chosen;          // its predictions are of points left out of the fit
    FitPoints points;          // what was fitted
    Eigen::ArrayXd fitted_N;   // the curve at these points
    std::size_t n_points = 0;  // rows read
    Ends ends;
    FitQuality quality;
    std::vector<ErrorBand> bands;                       // on points left out
    double median_relative_error = platform::kMissing;  // on points left out
    double force_at_full_N = 0.0;
    bool by_repeats = false;  // how points were left out
    Bootstrap bootstrap;
    std::optional<double> lag_s;
    std::optional<Hysteresis> hysteresis;
    std::optional<Drift> drift;
    LevelsDelivered levels;
    std::size_t slips = 0;              // points that the robust fit believed least
    std::vector<std::string> warnings;  // in plain words, worst first
};

// Throws InputError if no curve that rises can be fitted; every number of the profile is finite.
Calibration calibrate(const CalibrationRows& rows, const CalibrateOptions& options);

// What a person must know before trusting it.
std::vector<std::string> warnings_of(const Calibration& calibration, const std::vector<std::string>& notes);

}  // namespace palpa::calibration
