#pragma once
// How far a linear answer can be trusted.

#include <algorithm>

namespace palpa::mechanics {

enum class LinearRange { fine, amber, red };

inline constexpr double kAmber = 0.10;
inline constexpr double kRed = 0.25;

// Returns the larger of depth over thickness and depth over the width of the contact; 0 without contact.
inline double linearity_ratio(double depth_m, double thickness_m, double contact_width_m) {
    if (!(depth_m > 0.0)) return 0.0;
    return std::max(depth_m / thickness_m, contact_width_m > 0.0 ? depth_m / contact_width_m : 0.0);
}

// Judges a ratio of linearity_ratio(), or the largest principal strain (stiffness.h). The limits are ours: beyond 10 %
// strains are no longer small, beyond 25 % the linear answer is only a rough guide.
inline LinearRange linear_range(double ratio) {
    if (ratio > kRed) return LinearRange::red;
    return ratio > kAmber ? LinearRange::amber : LinearRange::fine;
}

}  // namespace palpa::mechanics
