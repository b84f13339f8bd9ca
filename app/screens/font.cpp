#include "app/screens/font.h"

#include <fontconfig/fontconfig.h>
#include <memory>

#include "files/regular_file.h"

namespace palpa::app {
namespace {

struct Font {
    std::string file;
    std::unique_ptr<FcCharSet, decltype(&FcCharSetDestroy)> letters{nullptr, &FcCharSetDestroy};
};

Font system_font() {
    Font font;
    FcConfig* config = FcInitLoadConfigAndFonts();
    if (config == nullptr) return font;
    FcPattern* wanted = FcNameParse(
        reinterpret_cast<const FcChar8*>("DejaVu Sans,Noto Sans,sans-serif:fontformat=TrueType:style=Book,Regular"));
    FcConfigSubstitute(config, wanted, FcMatchPattern);
    FcDefaultSubstitute(wanted);
    FcResult result = FcResultNoMatch;
    FcPattern* found = FcFontMatch(config, wanted, &result);
    FcChar8* text = nullptr;
    FcChar8* format = nullptr;
    FcCharSet* letters = nullptr;
    const bool readable = found != nullptr && FcPatternGetString(found, FC_FONTFORMAT, 0, &format) == FcResultMatch &&
                          std::string(reinterpret_cast<char*>(format)) == "TrueType";
    if (readable && FcPatternGetString(found, FC_FILE, 0, &text) == FcResultMatch)
        font.file = reinterpret_cast<char*>(text);
    if (readable && FcPatternGetCharSet(found, FC_CHARSET, 0, &letters) == FcResultMatch)
        font.letters.reset(FcCharSetCopy(letters));
    if (found != nullptr) FcPatternDestroy(found);
    FcPatternDestroy(wanted);
    FcConfigDestroy(config);
    if (!files::irregular_kind(font.file).empty()) font.file.clear();
    return font;
}

// Panels put letters side by side from left to right: Hebrew, Arabic and the scripts of South and South-East Asia need
// more than that. Dear ImGui has no letters beyond 16 bits.
bool put_side_by_side(FcChar32 letter) { return (letter < 0x590 || letter >= 0x10a0) && letter <= 0xffff; }

}  // namespace

std::string system_font_file() { return system_font().file; }

std::string first_letter_not_shown(const std::string& text) {
    static const Font font = system_font();
    for (std::size_t i = 0; i < text.size();) {
        FcChar32 letter = 0;
        const int bytes =
            FcUtf8ToUcs4(reinterpret_cast<const FcChar8*>(&text[i]), &letter, static_cast<int>(text.size() - i));
        if (bytes <= 0) return text.substr(i, 1);
        const auto length = static_cast<std::size_t>(bytes);
        const bool known = font.letters ? FcCharSetHasChar(font.letters.get(), letter) == FcTrue : letter < 0x100;
        if (letter >= 0x20 && (!known || !put_side_by_side(letter))) return text.substr(i, length);
        i += length;
    }
    return {};
}

const char* letters_shown() { return "letters of the font: Latin, Greek, Cyrillic"; }

}  // namespace palpa::app
