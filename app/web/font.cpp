#include "app/screens/font.h"

namespace palpa::app {

// DejaVu Sans, packed beside the program.
std::string system_font_file() { return "/font.ttf"; }

// The page loads the letters below alone (app/web/CMakeLists.txt packs them). The text is UTF-8.
std::string first_letter_not_shown(const std::string& text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    for (std::size_t i = 0; i < text.size();) {
        const unsigned lead = byte(i);
        const std::size_t bytes = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
        const unsigned letter = bytes == 1   ? lead
                                : bytes == 2 ? (lead & 0x1F) << 6 | (byte(i + 1) & 0x3F)
                                             : (lead & 0x0F) << 12 | (byte(i + 1) & 0x3F) << 6 | (byte(i + 2) & 0x3F);
        const bool latin = letter < 0x180 || (letter >= 0x218 && letter <= 0x21B);
        const bool mark = (letter >= 0x2010 && letter <= 0x2015) || (letter >= 0x2018 && letter <= 0x201F) ||
                          letter == 0x2022 || letter == 0x2026 || letter == 0x20AC;
        if (bytes == 4 || (!latin && !mark)) return text.substr(i, bytes);
        i += bytes;
    }
    return {};
}

const char* letters_shown() { return "letters of the font: Latin letters of Europe"; }

}  // namespace palpa::app
