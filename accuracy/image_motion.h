#pragma once
// How far anything moved between two pictures, from their pixels alone: blocks of the one are searched for in the other.

#include <vector>

namespace palpa::accuracy {

struct Pixels {
    int width_px = 0;
    int height_px = 0;
    std::vector<unsigned char> rgb;  // rows from the top
};

// Of one block: where its centre was, and how far it moved.
struct BlockMotion {
    double x_px = 0.0;
    double y_px = 0.0;
    double dx_px = 0.0;
    double dy_px = 0.0;
    double length_px() const;
};

// Returns the motion of the block that moved farthest; all 0 if none did. Brightness and shading are left out: only edges
// and marks can be seen to move. A block counts as moved only if its best match explains most of the change at its place,
// if the way back from there leads to where it was, and if two of its neighbours moved alike. Of several good matches the
// nearest is taken, so that a repeating pattern cannot feign a long way. Motion beyond `longest_px` is not found, nor beyond
// kReach_px: what is known to have moved no farther cannot be mistaken for something else that looks like it. Both pictures must
// have the same size (assert).
inline constexpr double kReach_px = 60.0;
BlockMotion greatest_motion(const Pixels& before, const Pixels& after, double longest_px = kReach_px);

}  // namespace palpa::accuracy
