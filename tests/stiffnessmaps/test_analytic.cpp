#include <cmath>
#include <doctest/doctest.h>

#include "files/json.h"
#include "stiffnessmaps/analytic.h"
#include "stiffnessmaps/map_file.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

TEST_CASE("analytic: a thick layer is Hertz's half-space, a thin incompressible one has the printed coefficients") {
    const Elastic tissue{10e3, 0.5};
    const double hertz_N = 16.0 / 9.0 * 10e3 * std::sqrt(4e-3) * std::pow(1e-3, 1.5);
    CHECK(layer_force_N(tissue, 4e-3, 1e-3, 1e3) == close_to(hertz_N).epsilon(1e-5));
    // Dimitriadis 2002, bonded, nu = 0.5: 1 + 1.133 c + 1.283 c^2 + 0.769 c^3 + 0.0975 c^4
    const double c = std::sqrt(4e-3 * 1e-3) / 10e-3;
    const double layer = 1 + 1.133 * c + 1.283 * c * c + 0.769 * c * c * c + 0.0975 * c * c * c * c;
    CHECK(layer_force_N(tissue, 4e-3, 1e-3, 10e-3) == close_to(hertz_N * layer).epsilon(1e-3));
    CHECK(layer_force_N(tissue, 4e-3, 0.0, 10e-3) == 0.0);
}

TEST_CASE("analytic: a map of the whole grid that says it is a stand-in, nodules in the order of size") {
    const Phantom phantom = read_phantom(PALPA_SOURCE_DIR "/assets/phantoms/silicone.json");
    const Map map = analytic_map(phantom);
    CHECK(map.n_x == 159);
    CHECK(map.n_y == 59);
    CHECK(map.n_depths() == 6);
    CHECK(map.nodules.size() == 3);
    CHECK(map.source.kind == SourceKind::analytic);
    for (const auto* forces : {&map.normal_N, &map.tangential_x_N, &map.tangential_y_N})
        CHECK(forces->size() == 6 * map.n_cells());
    const std::size_t cell = 20 * map.n_x + 40;
    CHECK(map.normal_N[cell] == close_to(phantom_force_N(phantom, map.x_of(40), map.y_of(20), 2e-3)).epsilon(1e-6));
    const double a = phantom_force_N(phantom, 35e-3, 35e-3, 5e-3);
    const double b = phantom_force_N(phantom, 85e-3, 45e-3, 5e-3);
    const double c = phantom_force_N(phantom, 60e-3, 88e-3, 5e-3);
    CHECK(a > b);
    CHECK(b > c);
    CHECK(c > 1.1 * phantom_force_N(phantom, 110e-3, 110e-3, 5e-3));
}

TEST_CASE(
    "the default map is a simulation of its phantom: 3 N at 7 mm beside the nodules, checked, smooth, order of size") {
    const std::string assets = PALPA_SOURCE_DIR "/assets/";
    const Phantom phantom = read_phantom(assets + "phantoms/silicone.json");
    const Map map = read_map(assets + "maps/silicone.map");
    const Map wanted = map_of_phantom(phantom);
    for (const char* key : {"name", "origin_mm", "spacing_mm", "count", "depths_mm", "indenter", "nodules"}) {
        CHECK(map_json(map)[key] == map_json(wanted)[key]);
    }
    CHECK(map.source.kind == SourceKind::simulated);
    for (const char* part : {"47000 Pa, is ASSUMED", "red, above 25 %", "Checked: 50 points"}) {
        CHECK(map.source.how.find(part) != std::string::npos);
    }
    const Json convergence = read_json(assets + "maps/silicone.map/convergence.json");
    CHECK(convergence["points"].size() == 50);
    CHECK(convergence["max_difference"].get<double>() < 0.03);

    const auto force_N = [&](const std::vector<float>& array, double x_mm, double y_mm, std::size_t depth) {
        const auto i = static_cast<std::size_t>(std::lround((x_mm + 0.04) / 0.76));
        const auto j = static_cast<std::size_t>(std::lround((y_mm - 2.0) / 2.0));
        return static_cast<double>(array[depth * map.n_cells() + j * map.n_x + i]);
    };
    CHECK(force_N(map.normal_N, 60, 60, 5) == close_to(3.0).epsilon(0.02));
    for (std::size_t k = 0; k < 6; ++k) {
        CAPTURE(k);
        const double a = force_N(map.normal_N, 35, 35, k);
        const double b = force_N(map.normal_N, 85, 45, k);
        const double c = force_N(map.normal_N, 60, 88, k);
        CHECK(a > b);
        CHECK(b > c);
        CHECK(c > 1.05 * force_N(map.normal_N, 60, 60, k));
        for (const PhantomNodule& n : phantom.nodules) {  // rises on approach, falls behind
            const double x_mm = 1e3 * n.centre_m[0];
            const double y_mm = 1e3 * n.centre_m[1];
            CHECK(force_N(map.tangential_x_N, x_mm - 4, y_mm, k) > 1e-3);
            CHECK(force_N(map.tangential_x_N, x_mm + 4, y_mm, k) < -1e-3);
            CHECK(force_N(map.tangential_y_N, x_mm, y_mm - 4, k) > 1e-3);
            CHECK(force_N(map.tangential_y_N, x_mm, y_mm + 4, k) < -1e-3);
        }
    }
}
