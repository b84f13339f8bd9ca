#pragma once
// Pressure level -> normal force of one device, evaluated.

#include <cstdint>
#include <string>
#include <vector>

#include "calibration/curve.h"
#include "platform/sample.h"

namespace palpa::calibration {

enum class LevelField { pressure, pressure_raw, contact_area };

struct DeviceNames {
    std::string pen;
    std::string tablet;
    std::string driver;
    std::string os;
    std::string date;
};

struct CalibrationPoint {
    double level = 0.0;
    double force_N = 0.0;
};

struct Profile {
    std::string id;  // of the file
    DeviceNames device;
    Curve curve;
    LevelField level = LevelField::pressure;
    double level_lowest = 0.0;  // what the device can report; levels are clamped to this range
    double level_highest = 1.0;
    double fitted_lowest =
        platform::kMissing;  // the part of it that the points cover; beyond, the curve is extrapolated
    double fitted_highest = platform::kMissing;
    double median_relative_error = platform::kMissing;  // on points left out of the fit, where known
    double full_contact_area_px2 = 0.0;                 // contact_area only: the ellipse whose level is 1
    std::vector<CalibrationPoint> points;               // what the curve was fitted to, where known
};

// The field of the sample that the profile reads; NaN if the device did not report it.
// contact_area: pi/4 width height / full_contact_area_px2.
double level_of(const Profile& profile, const platform::Sample& sample);

// Force at a level. Levels outside the range are clamped, and `clamped` is counted up. No curve reaches down to the
// force zero of a pen that does not touch: that is known by the sample's phase. Never below zero.
double force_N(const Profile& profile, double level, std::int64_t& clamped);

// Level at a force, clamped to the range: the inverse of force_N inside it.
double level_at_force(const Profile& profile, double force_N);

const char* name_of(LevelField level);

}  // namespace palpa::calibration
