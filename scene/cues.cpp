#include "scene/cues.h"

#include <algorithm>

namespace palpa::scene {

CueValues cues_at(const DrawnCues& cues, double indenter_radius_m, double depth_m) {
    // at this depth the crease has half of its darkness
    constexpr double kHalfDark_m = 2e-3;
    CueValues values;
    if (!(depth_m > 0.0)) return values;
    if (cues.footprint > 0.0) values.footprint_m = indenter_radius_m + cues.footprint * depth_m;
    values.crease = std::min(1.0, cues.crease * depth_m / (depth_m + kHalfDark_m));
    values.drawn_depth_m = (1.0 + cues.depth_gain) * depth_m;
    return values;
}

}  // namespace palpa::scene
