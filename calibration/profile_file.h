#pragma once

#include <filesystem>

#include "calibration/profile.h"
#include "files/json.h"

namespace palpa::calibration {

// Reads a profile. Throws InputError for anything that is not a usable curve: it must rise over level_range, and stay
// below 1,000 N.
Profile read_profile(const std::filesystem::path& path);

// Returns `parameters` of the file, with the keys of the curve's model.
files::Json parameters_json(const Curve& curve);

// Returns the content of the file; `quality` is kept for people and for `palpa explain`. write_profile() writes it
// whole or not at all, and throws InputError if read_profile() would refuse it, std::runtime_error if it cannot.
files::Json profile_json(const Profile& profile, const files::Json& quality);
void write_profile(const Profile& profile, const files::Json& quality, const std::filesystem::path& path);

}  // namespace palpa::calibration
