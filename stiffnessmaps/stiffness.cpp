#include "stiffnessmaps/stiffness.h"

#include <algorithm>
#include <cmath>

namespace palpa::stiffnessmaps {

std::vector<double> stiffness_N_per_m(const Map& map, double deepest_m) {
    std::vector<double> out(map.n_cells(), std::numeric_limits<double>::quiet_NaN());
    constexpr double kSame = 1.0 + 1e-9;  // for a depth typed in millimetres
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        double moment = 0.0;
        double square = 0.0;
        for (std::size_t k = 0; k < map.n_depths() && map.depths_m[k] <= deepest_m * kSame; ++k) {
            const double force_N = static_cast<double>(map.normal_N[k * map.n_cells() + cell]);
            if (std::isnan(force_N)) continue;
            moment += force_N * map.depths_m[k];
            square += map.depths_m[k] * map.depths_m[k];
        }
        if (square > 0.0) out[cell] = moment / square;
    }
    return out;
}

}  // namespace palpa::stiffnessmaps
