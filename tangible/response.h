#pragma once
// A device as seen from its few channels: the finger, then the actuators. See linearised.h.

#include <Eigen/Core>
#include <array>

#include "tangible/device_file.h"

namespace palpa::tangible {

inline constexpr int kMostTies = kMostActuators - 1;      // conditions of equal motion
inline constexpr int kMostChannels = 1 + kMostActuators;  // the finger, and the actuators
inline constexpr int kMostSmall = kMostChannels + kMostTies;
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostSmall, kMostSmall>;
using SmallColumn = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostSmall, 1>;

// What answers to the channels' forces p: a column per channel, and one for p = 0.
struct Response {
    double depth_m = 0.0;            // before: from DeviceState::rest_depth_m
    std::array<double, 2> tilt{};    // before
    SmallColumn moved;               // change of the channels' coordinates for p = 0
    Small compliance;                // the same per p
    SmallColumn forced;              // forces that the nodes get, for p = 0
    Small forcing;                   // the same per p
    SmallColumn tied;                // the part of it by conditions of equal motion, for p = 0
    Small tying;                     // the same per p
    std::array<double, 2> tilted{};  // change of the tilts for p = 0
    Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::ColMajor, 2, kMostChannels> tilting;  // the same per p
};

}  // namespace palpa::tangible
