#include "stiffnessmaps/analytic.h"

#include <doctest/doctest.h>

#include <cmath>

#include "stiffnessmaps/map_file.h"

using namespace palpa;

TEST_CASE("analytic: a thick layer is Hertz's half-space, a thin incompressible one has the printed coefficients") {
    const Elastic tissue{10e3, 0.5};
    const double hertz_N = 16.0 / 9.0 * 10e3 * std::sqrt(4e-3) * std::pow(1e-3, 1.5);
    CHECK(layer_force_N(tissue, 4e-3, 1e-3, 1e3) == doctest::Approx(hertz_N).epsilon(1e-5));
    // Dimitriadis 2002, bonded, nu = 0.5: 1 + 1.133 c + 1.283 c^2 + 0.769 c^3 + 0.0975 c^4
    const double c = std::sqrt(4e-3 * 1e-3) / 10e-3;
    const double layer = 1 + 1.133 * c + 1.283 * c * c + 0.769 * c * c * c + 0.0975 * c * c * c * c;
    CHECK(layer_force_N(tissue, 4e-3, 1e-3, 10e-3) == doctest::Approx(hertz_N * layer).epsilon(1e-3));
    CHECK(layer_force_N(tissue, 4e-3, 0.0, 10e-3) == 0.0);
}

TEST_CASE("analytic: the default map is what its phantom gives, about 3 N at 7 mm, nodules in the order of size") {
    const std::string assets = PALPA_SOURCE_DIR "/assets/";
    const Phantom phantom = read_phantom(assets + "phantoms/silicone.json");
    const Map made = analytic_map(phantom);
    const Map shipped = read_map(assets + "maps/silicone.map");
    CHECK(map_json(made) == map_json(shipped));
    CHECK(shipped.n_x == 159);
    CHECK(shipped.n_y == 59);
    CHECK(shipped.n_depths() == 6);
    CHECK(shipped.source.kind == SourceKind::analytic);
    for (const auto& [a, b] : {std::pair{&made.normal_N, &shipped.normal_N}, {&made.tangential_x_N, &shipped.tangential_x_N}}) {
        REQUIRE(a->size() == b->size());
        float worst = 0.0f;
        for (std::size_t i = 0; i < a->size(); ++i) worst = std::max(worst, std::abs((*a)[i] - (*b)[i]));
        CHECK(worst < 1e-5f);
    }
    CHECK(phantom_force_N(phantom, 110e-3, 110e-3, 7e-3) == doctest::Approx(3.0).epsilon(0.05));
    const double a = phantom_force_N(phantom, 35e-3, 35e-3, 5e-3);
    const double b = phantom_force_N(phantom, 85e-3, 45e-3, 5e-3);
    const double c = phantom_force_N(phantom, 60e-3, 88e-3, 5e-3);
    CHECK(a > b);
    CHECK(b > c);
    CHECK(c > 1.1 * phantom_force_N(phantom, 110e-3, 110e-3, 5e-3));
}
