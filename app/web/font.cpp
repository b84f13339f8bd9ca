#include "app/screens/font.h"

namespace palpa::app {

// DejaVu Sans, packed beside the program.
std::string system_font_file() { return "/font.ttf"; }

}  // namespace palpa::app
