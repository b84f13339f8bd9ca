#pragma once

#include <string>

namespace palpa::app {

// Returns a readable font file of this system (a TrueType sans-serif). If it is empty, Dear ImGui's own font is used.
std::string system_font_file();

// Returns the first letter of `text` (UTF-8) that the panels cannot show with this font, in UTF-8; empty if they show all.
std::string first_letter_not_shown(const std::string& text);
const char* letters_shown();  // what messages expect instead

}  // namespace palpa::app
