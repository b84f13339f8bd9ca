#pragma once
// The profile of one device: from pressure level to normal force.

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
    std::string id;  // file name without its ending
    DeviceNames device;
    Curve curve;
    LevelField level = LevelField::pressure;
    double level_lowest = 0.0;  // the range that the device can report; levels are clamped to it
    double level_highest = 1.0;
    // The part of the range that the points cover; beyond it the curve is extrapolated.
    double fitted_lowest = platform::kMissing;
    double fitted_highest = platform::kMissing;
    double median_relative_error = platform::kMissing;  // on points left out of the fit; NaN if not known
    double full_contact_area_px2 = 0.0;                 // contact_area only: area of the ellipse whose level is 1
    std::vector<CalibrationPoint> points;               // the points that the curve was fitted to, if known
};

// Returns the sample's level by the field that the profile reads; NaN if the device did not report it. contact_area:
// pi/4 width height / full_contact_area_px2.
double level_of(const Profile& profile, const platform::Sample& sample);

// Returns the force at a level, N, never below zero. Levels outside the range are clamped, and counted in `clamped`.
// Not every curve reaches zero force, so whether a pen touches is known from the sample's phase, not from the level.
double force_N(const Profile& profile, double level, std::int64_t& clamped);

// Returns the level at a force, clamped to the range: the inverse of force_N within it.
double level_at_force(const Profile& profile, double force_N);

// Writes a level into the fields that the profile reads: the inverse of level_of(). Where that is not the pressure,
// `pressure` becomes the level's share of the range.
void set_level(const Profile& profile, double level, platform::Sample& sample);

const char* name_of(LevelField level);

}  // namespace palpa::calibration
