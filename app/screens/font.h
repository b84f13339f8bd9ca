#pragma once

#include <string>

namespace palpa::app {

// A readable font file of this system (a TrueType sans-serif), or empty: then the one inside Dear ImGui is used.
std::string system_font_file();

}  // namespace palpa::app
