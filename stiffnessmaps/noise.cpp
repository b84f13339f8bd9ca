#include "stiffnessmaps/noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/quantile.h"

namespace palpa::stiffnessmaps {
namespace {

void second_differences(const Map& map, std::size_t along, std::size_t n, std::size_t stride,
                        std::vector<double>& out) {
    constexpr std::size_t kEnough = 1'000'000;  // forces; beyond that a part of them gives the same quantile
    const std::size_t step = 1 + map.normal_N.size() / kEnough;
    for (std::size_t k = 0; k < map.n_depths(); ++k) {
        for (std::size_t cell = 0; cell < map.n_cells(); cell += step) {
            const std::size_t i = (cell / along) % n;
            if (i == 0 || i + 1 >= n) continue;
            const std::size_t at = k * map.n_cells() + cell;
            const double d = static_cast<double>(map.normal_N[at - stride]) -
                             2.0 * static_cast<double>(map.normal_N[at]) +
                             static_cast<double>(map.normal_N[at + stride]);
            if (!std::isnan(d)) out.push_back(std::abs(d));
        }
    }
}

constexpr std::size_t kFewestDifferences = 8;

// |F(i-1) - 2 F(i) + F(i+1)| along x and y.
std::vector<double> second_differences(const Map& map) {
    std::vector<double> out;
    second_differences(map, 1, map.n_x, 1, out);
    second_differences(map, map.n_x, map.n_y, map.n_x, out);
    return out;
}

// Returns their q quantile; 0 if there are too few.
double second_difference_N(const Map& map, double q) {
    std::vector<double> differences = second_differences(map);
    if (differences.size() < kFewestDifferences) return 0.0;
    return files::reordered_quantile(differences, q, files::QuantileType::lower);
}

}  // namespace

double normal_noise_N(const Map& map) { return map.noise_N ? *map.noise_N : estimated_noise_N(map); }

bool knows_noise(const Map& map) { return map.noise_N || second_differences(map).size() >= kFewestDifferences; }

double estimated_noise_N(const Map& map) {
    constexpr double kMedianOfNormal = 0.6745;
    return second_difference_N(map, 0.5) / (kMedianOfNormal * std::sqrt(6.0));
}

double default_smoothing_m(const Map& map, double noise_N, double reference_m, double gate_N) {
    if (map.source.kind != SourceKind::recorded) return 0.0;
    return smoothing_sigma_m(map, noise_N, reference_m, gate_N);
}

double coarse_grid_error_N(const Map& map) { return 0.5 * second_difference_N(map, 0.95); }

double smoothing_sigma_m(const Map& map, double noise_N, double reference_m, double gate_N) {
    if (noise_N <= 0.0) return 0.0;
    double weights = 0.0;  // trapezoid rule from (0, 0): the first layer weighs half its own and half the next step
    for (std::size_t k = 0; k < map.n_depths(); ++k) {
        const double below = k > 0 ? map.depths_m[k - 1] : 0.0;
        const double above = k + 1 < map.n_depths() ? map.depths_m[k + 1] : map.depths_m[k];
        const double w = 0.5 * (above - below);
        weights += w * w;
    }
    const double energy_noise = noise_N * std::sqrt(weights);
    const double area = map.spacing_m[0] * map.spacing_m[1];
    const double cube = reference_m * energy_noise * std::sqrt(3.0 * area / (16.0 * std::numbers::pi)) / (gate_N / 3.0);
    return std::cbrt(cube);
}

}  // namespace palpa::stiffnessmaps
