#include "app/screens/layout.h"

#include <algorithm>
#include <cmath>

namespace palpa::app {
namespace {

constexpr float kColumn_mm = 64.0f;  // five targets of 9 mm side by side, and margins
constexpr float kStrip_mm = 66.0f;
constexpr float kLeastColumnHeight_mm = 104.0f;  // 12 of them for messages, two lines and the bar that scrolls them
constexpr float kLeastStripWidth_mm = 100.0f;    // 58 of them for the buttons, the others for force, depth and lag
constexpr float kLeastTissue_mm = 30.0f;

// Whether controls of this scale leave the tissue half of the window's shorter side.
bool has_room(float width_px, float height_px, float mm) {
    const Layout layout = layout_of(width_px, height_px, mm, false);
    const float side_px = std::min(layout.tissue_px.width(), layout.tissue_px.height());
    return layout.controls && side_px >= 0.5f * std::min(width_px, height_px);
}

}  // namespace

Layout layout_of(float width_px, float height_px, float mm, bool left_handed, bool above_finger, float hand_mm) {
    Layout out;
    const float column_px = kColumn_mm * mm;
    const float strip_px = std::max(kStrip_mm * mm, std::min(height_px - width_px, 1.3f * kStrip_mm * mm));
    const float beside_px = std::min(width_px - column_px, height_px);
    const float below_px = std::min(width_px, height_px - strip_px);
    const bool column_fits = height_px >= kLeastColumnHeight_mm * mm && beside_px >= kLeastTissue_mm * mm;
    const bool strip_fits = width_px >= kLeastStripWidth_mm * mm && below_px >= kLeastTissue_mm * mm;
    out.controls = column_fits || strip_fits;
    out.column = column_fits && (!strip_fits || beside_px >= below_px);
    out.tissue_px = {0.0f, 0.0f, width_px,
                     height_px - (above_finger ? kFingerOffset_mm * (hand_mm > 0.0f ? hand_mm : mm) : 0.0f)};
    if (!out.controls) return out;
    if (!out.column) {
        out.controls_px = {0.0f, 0.0f, width_px, strip_px};
        out.tissue_px.y0 = strip_px;
    } else if (left_handed) {  // the hand comes from the left, the controls stand on the right
        out.controls_px = {width_px - column_px, 0.0f, width_px, height_px};
        out.tissue_px.x1 = width_px - column_px;
    } else {
        out.controls_px = {0.0f, 0.0f, column_px, height_px};
        out.tissue_px.x0 = column_px;
    }
    return out;
}

float larger_scale(float mm, float text, float width_px, float height_px) {
    float scale = mm * text;
    while (scale > mm && !has_room(width_px, height_px, scale)) scale *= 0.95f;
    return std::max(scale, mm);
}

float control_scale(double px_per_mm, float width_px, float height_px, double touch_px_per_mm) {
    if (const double known = std::isfinite(px_per_mm) ? px_per_mm : touch_px_per_mm; std::isfinite(known)) {
        auto scale = static_cast<float>(known);
        for (int i = 0; i < 60 && !has_room(width_px, height_px, scale); ++i) scale *= 0.95f;
        return scale;
    }
    constexpr float kDesk_px_per_mm = 96.0f / 25.4f;
    const float desk = kDesk_px_per_mm * std::clamp(std::min(width_px, height_px) / 800.0f, 1.0f, 2.0f);
    // as small as on a phone, if that gives the tissue its room; a window for which that is too large as well keeps its letters
    float scale = desk;
    for (int i = 0; i < 6 && !has_room(width_px, height_px, scale); ++i) scale *= 0.95f;
    return has_room(width_px, height_px, scale) ? scale : desk;
}

}  // namespace palpa::app
