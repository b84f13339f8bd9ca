#pragma once
// Small maps in closed form.

#include <cmath>

#include "stiffnessmaps/map.h"

namespace palpa::test {

// force(x_m, y_m, depth_m) at every cell and depth.
template <class Force>
stiffnessmaps::Map map_of(std::size_t n_x, std::size_t n_y, const std::vector<double>& depths_m, Force force) {
    stiffnessmaps::Map map;
    map.name = "test";
    map.n_x = n_x;
    map.n_y = n_y;
    map.depths_m = depths_m;
    map.source.kind = stiffnessmaps::SourceKind::simulated;
    for (const double depth_m : depths_m) {
        for (std::size_t j = 0; j < n_y; ++j) {
            for (std::size_t i = 0; i < n_x; ++i) {
                map.normal_N.push_back(static_cast<float>(force(map.x_of(i), map.y_of(j), depth_m)));
            }
        }
    }
    return map;
}

inline const std::vector<double> kPaperDepths_m{2e-3, 3e-3, 4e-3, 5e-3, 6e-3, 7e-3};

}  // namespace palpa::test
