#pragma once
// Luminance and contrast as WCAG 2.2 defines them.

#include <algorithm>
#include <cmath>

namespace palpa::test {

inline double linear_channel(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

// Relative luminance of a colour of 8 bits a channel.
inline double luminance(int r, int g, int b) {
    return 0.2126 * linear_channel(r / 255.0) + 0.7152 * linear_channel(g / 255.0) + 0.0722 * linear_channel(b / 255.0);
}

// Contrast of two relative luminances, 1 to 21.
inline double contrast(double a, double b) { return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05); }

}  // namespace palpa::test
