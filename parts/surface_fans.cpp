#include "parts/surface_fans.h"

#include <numeric>

namespace palpa::parts {
namespace {

bool has(unsigned filled, int octant) { return (filled >> octant & 1U) != 0; }

std::array<int, 8> bodies_around(unsigned filled) {
    std::array<int, 8> body{0, 1, 2, 3, 4, 5, 6, 7};
    // three rounds suffice: no two octants are further apart
    for (int round = 0; round < 8; ++round) {
        for (int o = 0; o < 8; ++o) {
            for (int axis = 0; axis < 3; ++axis) {
                const int next = o ^ (1 << axis);
                if (!has(filled, o) || !has(filled, next)) continue;
                auto &a = body[static_cast<std::size_t>(o)], &b = body[static_cast<std::size_t>(next)];
                a = b = a < b ? a : b;
            }
        }
    }
    return body;
}

// Returns the face that follows another one across an edge along axis b.
int next_face(unsigned filled, unsigned joined, int octant, int a, int b) {
    const int c = 3 - a - b;
    const int edge = 2 * b + (octant >> b & 1);
    const int empty = octant ^ (1 << a), across = empty ^ (1 << c), beside = octant ^ (1 << c);
    const bool diagonal = has(filled, across) && !has(filled, beside);
    if (diagonal && (joined >> edge & 1U) == 0) return 3 * octant + c;
    if (has(filled, across)) return 3 * across + c;
    if (has(filled, beside)) return 3 * beside + a;
    return 3 * octant + c;
}

}  // namespace

bool joined_around(unsigned filled, int octant, int other) {
    const std::array<int, 8> body = bodies_around(filled);
    return body[static_cast<std::size_t>(octant)] == body[static_cast<std::size_t>(other)];
}

std::array<int, 2> diagonal_of(unsigned filled, int edge) {
    const int b = edge / 2, a = (b + 1) % 3, c = (b + 2) % 3;
    const int first = (edge % 2) << b;
    const int o[4] = {first, first | 1 << a, first | 1 << c, first | 1 << a | 1 << c};
    if (has(filled, o[0]) && has(filled, o[3]) && !has(filled, o[1]) && !has(filled, o[2])) return {o[0], o[3]};
    if (has(filled, o[1]) && has(filled, o[2]) && !has(filled, o[0]) && !has(filled, o[3])) return {o[1], o[2]};
    return {-1, -1};
}

Fans fans_of(unsigned filled, unsigned joined) {
    std::array<int, 24> lowest{};
    std::iota(lowest.begin(), lowest.end(), 0);
    const auto is_face = [&](int o, int a) { return has(filled, o) && !has(filled, o ^ (1 << a)); };
    for (bool changed = true; changed;) {
        changed = false;
        for (int o = 0; o < 8; ++o) {
            for (int a = 0; a < 3; ++a) {
                if (!is_face(o, a)) continue;
                for (const int b : {(a + 1) % 3, (a + 2) % 3}) {
                    auto& here = lowest[static_cast<std::size_t>(3 * o + a)];
                    auto& there = lowest[static_cast<std::size_t>(next_face(filled, joined, o, a, b))];
                    if (here == there) continue;
                    here = there = here < there ? here : there;
                    changed = true;
                }
            }
        }
    }
    Fans fans{};
    std::uint8_t n = 0;
    for (int f = 0; f < 24; ++f) {
        const auto face = static_cast<std::size_t>(f);
        if (!is_face(f / 3, f % 3)) continue;
        fans[face] = lowest[face] == f ? n++ : fans[static_cast<std::size_t>(lowest[face])];
    }
    return fans;
}

}  // namespace palpa::parts
