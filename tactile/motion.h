#pragma once
// Where a press is going: extrapolated from what has been read, so that slow pins can be told in time.

#include <array>
#include <cstddef>

namespace palpa::tactile {

// Place and depth (m), or place and force (N), at a time.
struct MotionSample {
    double time_s = 0.0;
    double x_m = 0.0;
    double y_m = 0.0;
    double value = 0.0;
};

// The latest samples.
struct Motion {
    static constexpr std::size_t kMost = 24;
    std::array<MotionSample, kMost> sample{};
    std::size_t n = 0;     // that are remembered
    std::size_t next = 0;  // the place of the next one
};

// Remembers a sample. One whose time is not later than that of the last replaces it; after a pause of kForgotten_s the
// samples before it are forgotten.
inline constexpr double kForgotten_s = 0.05;
void remember(const MotionSample& sample, Motion& motion) noexcept;

// Returns the motion `lead_s` after its last sample: on parabolas fitted by least squares to the samples of the last
// kFitted_s, or on straight lines while these are fewer than kFewestBent. The value does not fall below 0. Without two samples
// it is the last sample, later.
inline constexpr double kFitted_s = 16e-3;
inline constexpr std::size_t kFewestBent = 8;
MotionSample ahead(const Motion& motion, double lead_s) noexcept;

}  // namespace palpa::tactile
