#pragma once
// A map prepared for look-up: depth from force, and tangential force along any direction. It is made once, when a scene
// loads; look-ups allocate nothing and take some ten nanoseconds.
//
// Normal force: each cell has the least-squares non-decreasing curve over depth (isotonic regression), anchored at (0,
// 0), linear between the depths, bilinear in x and y. The raw values stay in the Map.
//
// The tangential force follows from the normal force by the work argument: at constant depth only lateral motion does
// work, so frictionless elastic tissue resists motion along the unit vector u with u . G, G = grad E,
//     E(x, y, d) = integral_0^d F_n ddepth = E_i + F_i z + (F_{i+1} - F_i) z^2 / (2 D),   z = d - d_i,
// with D the thickness of the layer. G is quadratic in depth, and bilinear in x and y between the gradients at the
// cells. Only resistance counts, and a recorded tangential force adds an even, dissipative part:
//     f(e, u, d) = max(u . G, 0) + rho(e, d),    rho = max(0, f_recorded,x - G_x)

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

enum class TangentialForce { energy, recorded };  // recorded: the recorded matrices, as in Li et al.

struct FieldOptions {
    TangentialForce force = TangentialForce::energy;
    double sigma_m = 0.0;  // of the Gaussian that smooths the tangential force, see noise.h
};

struct Field {
    struct Slope {              // at one cell and layer
        double energy_x = 0.0;  // dE/dx, N
        double energy_y = 0.0;
        double force_x = 0.0;  // dF/dx, N/m
        double force_y = 0.0;
        double rest_x = 0.0;  // energy: rho; recorded: f_x
        double rest_y = 0.0;  // recorded: f_y
    };
    double origin_m[2] = {0.0, 0.0};
    double cells_per_m[2] = {1.0, 1.0};
    std::size_t n_x = 0;
    std::size_t n_y = 0;
    std::vector<double> depths_m;    // layers, the first one at depth 0
    std::vector<double> normal_N;    // [cell][layer], non-decreasing, without gaps
    std::vector<Slope> slopes;       // [cell][layer]
    std::vector<double> greatest_m;  // [cell] greatest measured depth
    std::vector<double> measured;    // [cell] 1 or 0
    FieldOptions options;
    bool complete = false;  // every cell is measured down to the last depth
    // the slopes hold rest_x and rest_y
    bool has_rest = false;
    std::size_t isotonic_changed = 0;  // number of forces that isotonic regression changed

    std::size_t n_layers() const { return depths_m.size(); }
};

Field make_field(const Map& map, const FieldOptions& options);

// A position as four cells with bilinear weights. Positions outside the grid are clamped to its edge.
struct Place {
    std::size_t cell[4] = {0, 0, 0, 0};
    double weight[4] = {0.0, 0.0, 0.0, 0.0};
    bool inside = true;    // within half a pitch of the grid
    bool measured = true;  // at least half of the weight lies on measured cells
};
Place place_at(const Field& field, const Eigen::Vector2d& p_m);

// Returns the normal force at a depth, N; the depth is clamped to greatest_depth_m().
double normal_force_N(const Field& field, const Place& place, double depth_m);
// Returns the greatest measured depth around a place, m.
double greatest_depth_m(const Field& field, const Place& place);

struct DepthAnswer {
    double depth_m = 0.0;
    bool saturated = false;  // the force exceeds that at the greatest depth, where the depth stays
};
// Returns the smallest depth at which the force is reached; 0 for a force <= 0.
DepthAnswer depth_at(const Field& field, const Place& place, double force_N);

// Returns the force that resists motion along the unit vector u at a depth, N. It is >= 0, except with
// TangentialForce::recorded.
double tangential_force_N(const Field& field, const Place& place, const Eigen::Vector2d& u, double depth_m);

// Returns tangential_force_N(here) - tangential_force_N(before) at the same depth, N.
double tangential_rise_N(const Field& field, const Place& here, const Place& before, const Eigen::Vector2d& u,
                         double depth_m);

// Returns G = (dE/dx, dE/dy) at a depth, N; its components have both signs.
Eigen::Vector2d energy_gradient_N(const Field& field, const Place& place, double depth_m);

// How well a recorded tangential force along +x agrees with dE/dx of the same map, over all measured cells:
// correlation, slope of the regression on dE/dx, and number of values. All are 0 without such a recording.
struct TangentialAgreement {
    double correlation = 0.0;
    double slope = 0.0;
    std::size_t n = 0;
};
TangentialAgreement tangential_agreement(const Map& map, const Field& field);

}  // namespace palpa::stiffnessmaps
