#pragma once
// Pressure level -> normal force of one device, evaluated.

#include <cstdint>
#include <string>
#include <vector>

#include "platform/sample.h"

namespace palpa {

// f = a exp(b level), newtons. Source: Li et al., eqs. 1, 5 and 6. The curve never reaches zero force: a pen
// that does not touch has force 0 by its phase, never by the curve.
struct ExponentialCurve {
    double a_N = 0.0;
    double b = 0.0;  // per level; > 0
};

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
    ExponentialCurve curve;
    LevelField level = LevelField::pressure;
    double level_lowest = 0.0;
    double level_highest = 1.0;
    double full_contact_area_px2 = 0.0;  // contact_area only: the ellipse whose level is 1
    std::vector<CalibrationPoint> points;  // what the curve was fitted to, where known
};

// The field of the sample that the profile reads; NaN if the device did not report it.
// contact_area: pi/4 width height / full_contact_area_px2.
double level_of(const Profile& profile, const Sample& sample);

// Force at a level. Levels outside the range are clamped, and `clamped` is counted up.
double force_N(const Profile& profile, double level, std::int64_t& clamped);

// Level at a force, clamped to the range: the inverse of force_N inside it.
double level_at_force(const Profile& profile, double force_N);

const char* name_of(LevelField level);

}  // namespace palpa
