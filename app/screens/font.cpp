#include "app/screens/font.h"

#include <fontconfig/fontconfig.h>

#include "files/regular_file.h"

namespace palpa::app {

std::string system_font_file() {
    FcConfig* config = FcInitLoadConfigAndFonts();
    if (config == nullptr) return {};
    FcPattern* wanted = FcNameParse(
        reinterpret_cast<const FcChar8*>("DejaVu Sans,Noto Sans,sans-serif:fontformat=TrueType:style=Book,Regular"));
    FcConfigSubstitute(config, wanted, FcMatchPattern);
    FcDefaultSubstitute(wanted);
    FcResult result = FcResultNoMatch;
    FcPattern* found = FcFontMatch(config, wanted, &result);
    std::string file;
    FcChar8* text = nullptr;
    FcChar8* format = nullptr;
    const bool readable = found != nullptr && FcPatternGetString(found, FC_FONTFORMAT, 0, &format) == FcResultMatch &&
                          std::string(reinterpret_cast<char*>(format)) == "TrueType";
    if (readable && FcPatternGetString(found, FC_FILE, 0, &text) == FcResultMatch) file = reinterpret_cast<char*>(text);
    if (found != nullptr) FcPatternDestroy(found);
    FcPatternDestroy(wanted);
    FcConfigDestroy(config);
    return files::irregular_kind(file).empty() ? file : std::string();
}

}  // namespace palpa::app
