#pragma once

#include <filesystem>
#include <vector>

namespace palpa {

// RGB rows from the top downwards. Throws std::runtime_error if the file cannot be written.
void write_png(const std::filesystem::path& path, int width_px, int height_px, const std::vector<unsigned char>& rgb);

}  // namespace palpa
