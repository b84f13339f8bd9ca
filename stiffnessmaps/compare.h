#pragma once
// The difference between two maps of one tissue.

#include <string>
#include <vector>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

struct DepthDifference {
    double depth_m = 0.0;
    std::size_t n = 0;  // places where both maps are known
    double mean_a_N = 0.0;
    double bias_N = 0.0;    // mean of b - a
    double median_N = 0.0;  // of |b - a|
    double rms_N = 0.0;
    double greatest_N = 0.0;  // of |b - a|
    double at_x_m = 0.0;      // where it is greatest
    double at_y_m = 0.0;
};

// b - a at the places of the coarser map (larger cells; a if both are equally fine) within the area of the other one,
// at the depths of the map that has fewer of them, as far as the shallower map goes. The finer map is interpolated as
// in field.h.
struct MapDifference {
    std::string grid_of;    // whose places these are: "a" or "b"
    std::string depths_of;  // whose depths these are: "a" or "b"
    Map a;                  // this and b on that grid; NaN where not both are known
    Map b;
    std::vector<DepthDifference> depths;
    DepthDifference all;       // over all depths; depth_m: where it is greatest
    double relative = 0.0;     // RMS of b - a / RMS of a
    double correlation = 0.0;  // of the forces; NaN if one of them does not vary
};

// Throws InputError if the maps share no place or no depth; the names are for the message.
MapDifference compare_maps(const Map& a, const std::string& name_a, const Map& b, const std::string& name_b);

}  // namespace palpa::stiffnessmaps
