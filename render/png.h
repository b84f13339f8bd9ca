#pragma once

#include <string>
#include <vector>

namespace palpa::render {

// Returns a PNG file of rows of RGB, from the top downwards. Throws std::runtime_error if libpng cannot make it.
std::string png_bytes(int width_px, int height_px, const std::vector<unsigned char>& rgb);

}  // namespace palpa::render
