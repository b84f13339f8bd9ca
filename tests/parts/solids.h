#pragma once
// Closed surfaces for tests, and STL files of them.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "mechanics/triangle_solid.h"

namespace palpa::test {

using Corner = std::array<double, 3>;

// Twelve triangles that face outwards.
inline std::vector<mechanics::Triangle> box_triangles(const Corner& low, const Corner& high) {
    const auto corner = [&](int i) {
        return Corner{(i & 1) != 0 ? high[0] : low[0], (i & 2) != 0 ? high[1] : low[1],
                      (i & 4) != 0 ? high[2] : low[2]};
    };
    std::vector<mechanics::Triangle> out;
    for (const auto& q : {std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}, std::array{0, 1, 5, 4},
                          std::array{2, 6, 7, 3}, std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}}) {
        out.push_back({corner(q[0]), corner(q[1]), corner(q[2])});
        out.push_back({corner(q[0]), corner(q[2]), corner(q[3])});
    }
    return out;
}

// A ball of 2 n (n - 1) triangles.
inline std::vector<mechanics::Triangle> ball_triangles(const Corner& centre, double radius, int n) {
    constexpr double kPi = 3.14159265358979323846;
    const auto corner = [&](int i, int j) {
        const double up = kPi * i / n, around = 2.0 * kPi * (j % n) / n;
        const double across = i == 0 || i == n ? 0.0 : radius * std::sin(up);
        return Corner{centre[0] + across * std::cos(around), centre[1] + across * std::sin(around),
                      centre[2] + radius * std::cos(up)};
    };
    std::vector<mechanics::Triangle> out;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            if (i > 0) out.push_back({corner(i, j), corner(i + 1, j), corner(i, j + 1)});
            if (i + 1 < n) out.push_back({corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1)});
        }
    }
    return out;
}

inline std::vector<mechanics::Triangle> turned(std::vector<mechanics::Triangle> triangles) {
    for (auto& t : triangles) std::swap(t[1], t[2]);
    return triangles;
}

inline std::string binary_stl(const std::vector<mechanics::Triangle>& triangles, std::string header = "") {
    header.resize(80, ' ');
    const auto put = [](std::uint32_t bits, std::string& out) {
        for (int byte = 0; byte < 4; ++byte) out.push_back(static_cast<char>(bits >> (8 * byte) & 0xFFU));
    };
    put(static_cast<std::uint32_t>(triangles.size()), header);
    for (const auto& triangle : triangles) {
        header.append(12, '\0');
        for (const auto& corner : triangle) {
            for (const double c : corner) put(std::bit_cast<std::uint32_t>(static_cast<float>(c)), header);
        }
        header.append(2, '\0');
    }
    return header;
}

inline std::string text_stl(const std::vector<mechanics::Triangle>& triangles) {
    std::string out = "solid a part\n";
    for (const auto& triangle : triangles) {
        out += "facet normal 0 0 0\n outer loop\n";
        for (const auto& corner : triangle) {
            out += "  vertex";
            for (const double c : corner) out += " " + std::to_string(c);
            out += "\n";
        }
        out += " endloop\nendfacet\n";
    }
    return out + "endsolid a part\n";
}

}  // namespace palpa::test
