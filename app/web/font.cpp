#include "app/screens/font.h"

namespace palpa::app {

// DejaVu Sans, packed beside the program.
std::string system_font_file() { return "/font.ttf"; }

std::string first_letter_not_shown(const std::string&) { return {}; }

}  // namespace palpa::app
