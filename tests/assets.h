#pragma once
// What the program ships with.

#include <filesystem>

namespace palpa::test {

inline const std::filesystem::path kAssets = PALPA_SOURCE_DIR "/assets";

}  // namespace palpa::test
