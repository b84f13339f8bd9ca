#include "stiffnessmaps/analytic.h"

#include <cmath>
#include <numbers>

#include "stiffnessmaps/field.h"

namespace palpa::stiffnessmaps {

double layer_force_N(const Elastic& tissue, double radius_m, double depth_m, double thickness_m) {
    if (depth_m <= 0.0) return 0.0;
    constexpr double pi = std::numbers::pi;
    const double nu = tissue.poisson;
    const double a = -(1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1.0 - nu);
    const double b = (0.6387 - 1.0277 * nu + 1.5164 * nu * nu) / (1.0 - nu);
    const double c = std::sqrt(radius_m * depth_m) / thickness_m;
    const double a3 = a * a * a;
    const double layer = 1.0 - 2.0 * a / pi * c + 4.0 * a * a / (pi * pi) * c * c -
                         8.0 / (pi * pi * pi) * (a3 + 4.0 * pi * pi / 15.0 * b) * c * c * c +
                         16.0 * a / (pi * pi * pi * pi) * (a3 + 3.0 * pi * pi / 5.0 * b) * c * c * c * c;
    const double half_space_N =
        4.0 / 3.0 * tissue.young_Pa / (1.0 - nu * nu) * std::sqrt(radius_m) * std::pow(depth_m, 1.5);
    return half_space_N * layer;
}

double phantom_force_N(const Phantom& phantom, double x_m, double y_m, double depth_m) {
    const double plain_N = layer_force_N(phantom.tissue, phantom.indenter_radius_m, depth_m, phantom.size_m[2]);
    double factor = 1.0;
    for (const PhantomNodule& nodule : phantom.nodules) {
        const double D = nodule.diameter_m;
        const double top = nodule.centre_m[2] - 0.5 * D;
        const double over_top_N = layer_force_N(phantom.tissue, phantom.indenter_radius_m, depth_m, top);
        const double size = D * D / (D * D + 4.0 * top * top);
        const double width2 = 0.25 * (D * D + top * top);
        const double dx = x_m - nodule.centre_m[0];
        const double dy = y_m - nodule.centre_m[1];
        factor += size * (over_top_N / plain_N - 1.0) * std::exp(-(dx * dx + dy * dy) / (2.0 * width2));
    }
    return plain_N * factor;
}

Map analytic_map(const Phantom& phantom) {
    Map map = map_of_phantom(phantom);
    for (const double depth_m : map.depths_m) {
        for (std::size_t j = 0; j < map.n_y; ++j) {
            for (std::size_t i = 0; i < map.n_x; ++i) {
                map.normal_N.push_back(static_cast<float>(phantom_force_N(phantom, map.x_of(i), map.y_of(j), depth_m)));
            }
        }
    }
    const Field field = make_field(map, {});
    for (std::size_t k = 1; k < field.n_layers(); ++k) {
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            const Field::Slope& slope = field.slopes[cell * field.n_layers() + k];
            map.tangential_x_N.push_back(static_cast<float>(slope.energy_x));
            map.tangential_y_N.push_back(static_cast<float>(slope.energy_y));
        }
    }
    map.source.kind = SourceKind::analytic;
    map.source.how =
        "closed-form stand-in, neither recorded nor simulated: a sphere on a bonded layer (Dimitriadis 2002), a bump "
        "over each nodule; the modulus of the tissue is " +
        std::string(phantom.tissue.assumed ? "assumed" : "the phantom's");
    map.source.from = phantom.name;
    map.source.licence = "made by Palpa";
    return map;
}

}  // namespace palpa::stiffnessmaps
