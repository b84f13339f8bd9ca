#include "calibration/profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa::calibration {

double level_of(const Profile& profile, const platform::Sample& sample) {
    switch (profile.level) {
        case LevelField::pressure:
            return sample.pressure;
        case LevelField::pressure_raw:
            return sample.pressure_raw;
        case LevelField::contact_area:
            return 0.25 * std::numbers::pi * sample.width_px * sample.height_px / profile.full_contact_area_px2;
    }
    return platform::kMissing;
}

double force_N(const Profile& profile, double level, std::int64_t& clamped) {
    const double inside = std::clamp(level, profile.level_lowest, profile.level_highest);
    if (inside != level) ++clamped;
    return std::max(0.0, value_N(profile.curve, inside));
}

double level_at_force(const Profile& profile, double force_N) {
    if (!(force_N > 0.0)) return profile.level_lowest;
    return std::clamp(level_at(profile.curve, force_N), profile.level_lowest, profile.level_highest);
}

void set_level(const Profile& profile, double level, platform::Sample& sample) {
    sample.pressure = (level - profile.level_lowest) / (profile.level_highest - profile.level_lowest);
    switch (profile.level) {
        case LevelField::pressure:
            sample.pressure = level;
            break;
        case LevelField::pressure_raw:
            sample.pressure_raw = std::round(level);
            break;
        case LevelField::contact_area:
            sample.width_px = sample.height_px =
                std::sqrt(4.0 / std::numbers::pi * level * profile.full_contact_area_px2);
            break;
    }
}

const char* name_of(LevelField level) {
    switch (level) {
        case LevelField::pressure:
            return "pressure";
        case LevelField::pressure_raw:
            return "pressure_raw";
        case LevelField::contact_area:
            return "contact_area";
    }
    return "pressure";
}

}  // namespace palpa::calibration
