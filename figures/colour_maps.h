#pragma once
// Colours for numbers, as in the figures: viridis (Smith and van der Walt, BIDS 2015: even steps for the eye, also without
// colour vision) from 0 to 1; blue, white, red around the middle for what has a sign.

#include <algorithm>
#include <imgui.h>

namespace palpa::figures {

struct ColourScale {
    float stops[10][3];
    int count;
};
inline constexpr ColourScale kViridis{{{68, 1, 84},
                                       {72, 40, 120},
                                       {62, 74, 137},
                                       {49, 104, 142},
                                       {38, 130, 142},
                                       {31, 158, 137},
                                       {53, 183, 121},
                                       {110, 206, 88},
                                       {181, 222, 43},
                                       {253, 231, 37}},
                                      10};
inline constexpr ColourScale kApart{{{33, 102, 172}, {146, 197, 222}, {247, 247, 247}, {244, 165, 130}, {178, 24, 43}},
                                    5};

inline ImU32 colour_at(const ColourScale& scale, float share) {
    const float at = std::clamp(share, 0.0f, 1.0f) * static_cast<float>(scale.count - 1);
    const int i = std::min(static_cast<int>(at), scale.count - 2);
    const float s = at - static_cast<float>(i);
    const auto mix = [&](int c) {
        return static_cast<int>(scale.stops[i][c] + s * (scale.stops[i + 1][c] - scale.stops[i][c]) + 0.5f);
    };
    return IM_COL32(mix(0), mix(1), mix(2), 255);
}

}  // namespace palpa::figures
