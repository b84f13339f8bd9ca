#pragma once
// Colours for numbers, on the screen and in figures: viridis (Smith and van der Walt, BIDS 2015: perceptually uniform,
// also for colour-blind people) from 0 to 1; blue, white and red for signed numbers, with 0 in the middle.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace palpa::figures {

struct Colour {
    std::uint8_t r, g, b;  // sRGB
};

struct ColourScale {
    std::array<Colour, 10> stops;  // evenly spaced, the first `count` of them
    std::size_t count;
};
inline constexpr ColourScale kViridis{{{{68, 1, 84},
                                        {72, 40, 120},
                                        {62, 74, 137},
                                        {49, 104, 142},
                                        {38, 130, 142},
                                        {31, 158, 137},
                                        {53, 183, 121},
                                        {110, 206, 88},
                                        {181, 222, 43},
                                        {253, 231, 37}}},
                                      10};
inline constexpr ColourScale kApart{
    {{{33, 102, 172}, {146, 197, 222}, {247, 247, 247}, {244, 165, 130}, {178, 24, 43}}}, 5};

// Returns the colour of a share, linear between the stops; beyond 0 and 1 the colours of the ends.
inline Colour colour_at(const ColourScale& scale, float share) {
    const float at = std::clamp(share, 0.0f, 1.0f) * static_cast<float>(scale.count - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), scale.count - 2);
    const float s = at - static_cast<float>(i);
    const Colour& a = scale.stops[i];
    const Colour& b = scale.stops[i + 1];
    const auto mix = [s](std::uint8_t from, std::uint8_t to) {
        return static_cast<std::uint8_t>(from + s * static_cast<float>(to - from) + 0.5f);
    };
    return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

// Returns the scale as an argument of gnuplot's `set palette`.
std::string gnuplot_palette(const ColourScale& scale);

}  // namespace palpa::figures
