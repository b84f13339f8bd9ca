#include "app/screens/font.h"

namespace palpa::app {

// DejaVu Sans, packed beside the program.
std::string system_font_file() { return "/font.ttf"; }

// The page loads the letters U+0020 to U+00FF alone, which take one or two bytes.
std::string first_letter_not_shown(const std::string& text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t bytes = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
        if (lead >= 0x80 && lead != 0xC2 && lead != 0xC3) return text.substr(i, bytes);
        i += bytes;
    }
    return {};
}

const char* letters_shown() { return "letters of the font: Latin letters of Western Europe"; }

}  // namespace palpa::app
