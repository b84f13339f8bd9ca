#pragma once
// Luminance and contrast as WCAG 2.2 defines them, as different eyes see them.

#include <algorithm>
#include <array>
#include <cmath>

namespace palpa::test {

// What an eye makes of linear red, green and blue, row by row.
struct Eye {
    const char* name;
    std::array<double, 9> sees;
};

// Eyes without cones for long or for medium wavelengths.
// Source: Machado, Oliveira & Fernandes, IEEE Trans. Vis. Comput. Graph. 15 (2009) 1291, severity 1.
inline constexpr std::array<Eye, 3> kEyes{
    {{"usual", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
     {"protanope", {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998}},
     {"deuteranope", {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881}}}};

inline double linear_channel(int value) {
    static const std::array<double, 256> kLinear = [] {
        std::array<double, 256> out{};
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double share = static_cast<double>(i) / 255.0;
            out[i] = share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
        }
        return out;
    }();
    return kLinear[static_cast<std::size_t>(value)];
}

// Relative luminance of a colour of 8 bits a channel.
inline double luminance(int r, int g, int b, const Eye& eye) {
    constexpr std::array<double, 3> kWeight{0.2126, 0.7152, 0.0722};
    const std::array<double, 3> rgb{linear_channel(r), linear_channel(g), linear_channel(b)};
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double seen = eye.sees[3 * i] * rgb[0] + eye.sees[3 * i + 1] * rgb[1] + eye.sees[3 * i + 2] * rgb[2];
        sum += kWeight[i] * std::clamp(seen, 0.0, 1.0);
    }
    return sum;
}

// Contrast of two relative luminances, 1 to 21.
inline double contrast(double a, double b) { return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05); }

}  // namespace palpa::test
