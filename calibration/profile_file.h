#pragma once

#include <filesystem>

#include "calibration/profile.h"

namespace palpa {

// Throws InputError for anything that is not a usable curve: it must rise, and stay below 1,000 N.
Profile read_profile(const std::filesystem::path& path);

}  // namespace palpa
