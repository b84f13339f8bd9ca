#pragma once

#include <filesystem>

#include "calibration/profile.h"
#include "files/json.h"

namespace palpa::calibration {

// Throws InputError for anything that is not a usable curve: it must rise over level_range, and stay below 1,000 N.
Profile read_profile(const std::filesystem::path& path);

// `parameters` of the file, by the model's own keys.
files::Json parameters_json(const Curve& curve);

// The whole file; `quality` is kept for people and for `palpa explain`. Written at once or not at all.
files::Json profile_json(const Profile& profile, const files::Json& quality);
void write_profile(const Profile& profile, const files::Json& quality, const std::filesystem::path& path);

}  // namespace palpa::calibration
