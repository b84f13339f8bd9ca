#pragma once

#include <string>

namespace palpa::app {

// Returns a readable font file of this system (a TrueType sans-serif). If it is empty, Dear ImGui's own font is used.
std::string system_font_file();

}  // namespace palpa::app
