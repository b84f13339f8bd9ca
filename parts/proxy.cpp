#include "parts/proxy.h"

#include <algorithm>
#include <cmath>

namespace palpa::parts {
namespace {

using mechanics::Voxels;
using Place = std::array<double, 2>;  // in voxels

constexpr double kGap = 1e-6;    // voxels that the proxy keeps from a face
constexpr double kFar = 1e5;     // voxels: a pen farther away is taken to be this far
constexpr int kMostSlides = 16;  // of one motion; a staircase of voxels needs one for each step

Place in_voxels(const Voxels& voxels, const Slice& slice, const Place& p_m) {
    Place out{};
    for (std::size_t k = 0; k < 2; ++k) {
        const double origin = voxels.frame.origin_m[static_cast<std::size_t>(slice.view[k])];
        out[k] = std::clamp((p_m[k] - origin) / voxels.frame.pitch_m, -kFar, kFar);
    }
    return out;
}

bool filled(const Voxels& voxels, const Slice& slice, const std::array<int, 2>& cell) {
    return filled_at(voxels, slice, cell[0], cell[1]);
}

// Goes from p straight to `to`, voxel by voxel. Returns the axis of the face that stopped it, or -1 if it got there.
int go_straight(const Voxels& voxels, const Slice& slice, const Place& to, Place& p) {
    std::array<int, 2> cell{static_cast<int>(std::floor(p[0])), static_cast<int>(std::floor(p[1]))};
    const Place from = p, d{to[0] - p[0], to[1] - p[1]};
    while (true) {
        // the next face on the way
        int axis = -1;
        double when = 1.0;
        for (std::size_t k = 0; k < 2; ++k) {
            if (d[k] == 0.0) continue;
            const double face = d[k] > 0.0 ? cell[k] + 1 : cell[k];
            const double t = (face - from[k]) / d[k];
            if (t < when) {
                when = std::max(t, 0.0);
                axis = static_cast<int>(k);
            }
        }
        if (axis < 0) {
            p = to;
            return -1;
        }
        const auto k = static_cast<std::size_t>(axis);
        std::array<int, 2> next = cell;
        next[k] += d[k] > 0.0 ? 1 : -1;
        if (filled(voxels, slice, next)) {
            p = {from[0] + when * d[0], from[1] + when * d[1]};
            p[k] = d[k] > 0.0 ? cell[k] + 1 - kGap : cell[k] + kGap;
            // round-off must not put it beyond the other faces of its voxel
            const std::size_t other = 1 - k;
            p[other] = std::clamp(p[other], static_cast<double>(cell[other]), std::nextafter(cell[other] + 1.0, 0.0));
            return axis;
        }
        cell = next;
    }
}

}  // namespace

bool filled_at(const Voxels& voxels, const Slice& slice, int i, int j) {
    std::array<int, 3> p{slice.depth, slice.depth, slice.depth};
    p[static_cast<std::size_t>(slice.view[0])] = i;
    p[static_cast<std::size_t>(slice.view[1])] = j;
    return material_at(voxels, p[0], p[1], p[2]) >= 0;
}

void follow_pen(const Voxels& voxels, const Slice& slice, const Place& pen_m, Place& proxy_m) {
    if (!std::isfinite(pen_m[0] + pen_m[1] + proxy_m[0] + proxy_m[1])) return;
    const Place pen = in_voxels(voxels, slice, pen_m);
    Place p = in_voxels(voxels, slice, proxy_m);
    if (filled(voxels, slice, {static_cast<int>(std::floor(p[0])), static_cast<int>(std::floor(p[1]))})) return;
    for (int slide = 0; slide < kMostSlides; ++slide) {
        const int axis = go_straight(voxels, slice, pen, p);
        if (axis < 0) break;
        // along the face, as far as the pen is along it
        Place along = pen;
        along[static_cast<std::size_t>(axis)] = p[static_cast<std::size_t>(axis)];
        const Place before = p;
        const int corner = go_straight(voxels, slice, along, p);
        if (corner >= 0 || std::abs(p[0] - before[0]) + std::abs(p[1] - before[1]) < kGap) break;
        // the end of a face may have let it free
        const Place after = p;
        if (go_straight(voxels, slice, pen, p) < 0) break;
        if (std::abs(p[0] - after[0]) + std::abs(p[1] - after[1]) < 4.0 * kGap) break;
    }
    for (std::size_t k = 0; k < 2; ++k) {
        proxy_m[k] = voxels.frame.origin_m[static_cast<std::size_t>(slice.view[k])] + voxels.frame.pitch_m * p[k];
    }
}

bool rests_on(const Voxels& voxels, const Slice& slice, int axis, int sign, const Place& proxy_m) {
    const Place p = in_voxels(voxels, slice, proxy_m);
    std::array<int, 2> cell{static_cast<int>(std::floor(p[0])), static_cast<int>(std::floor(p[1]))};
    const auto k = static_cast<std::size_t>(axis);
    const double gap = sign > 0 ? cell[k] + 1 - p[k] : p[k] - cell[k];
    cell[k] += sign;
    return gap < 0.01 && filled(voxels, slice, cell);
}

}  // namespace palpa::parts
