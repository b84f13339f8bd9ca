#include "figures/colour_maps.h"

#include <cstdio>

namespace palpa::figures {

std::string gnuplot_palette(const ColourScale& scale) {
    std::string out = "defined (";
    for (std::size_t i = 0; i < scale.count; ++i) {
        const Colour& c = scale.stops[i];
        std::array<char, 32> hex{};
        std::snprintf(hex.data(), hex.size(), " '#%02x%02x%02x'", c.r, c.g, c.b);
        out += (i > 0 ? ", " : "") + std::to_string(i) + hex.data();
    }
    return out + ")";
}

}  // namespace palpa::figures
