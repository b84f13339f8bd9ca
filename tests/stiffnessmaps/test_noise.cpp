#include <doctest/doctest.h>
#include <random>

#include "stiffnessmaps/field.h"
#include "stiffnessmaps/noise.h"
#include "tests/close_to.h"
#include "tests/stiffnessmaps/test_maps.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

TEST_CASE("noise: white noise on a plane is estimated within 5 %, and smoothing by the rule quiets the avatar") {
    constexpr std::uint32_t kSeed = 3;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::normal_distribution<double> noise(0.0, 0.02);
    Map map =
        map_of(159, 59, kPaperDepths_m, [&](double x, double, double d) { return 300.0 * d + x + noise(random); });
    map.spacing_m[0] = 0.76e-3;
    map.spacing_m[1] = 2e-3;
    const double noise_N = normal_noise_N(map);
    CHECK(noise_N == close_to(0.02).epsilon(0.05));

    const double sigma_m = smoothing_sigma_m(map, noise_N, 3e-4, 2e-3);
    CHECK(sigma_m > 1.5e-3);
    CHECK(sigma_m < 2.5e-3);  // the rule's example: 1.8 mm for 0.65 mN
    FieldOptions options;
    options.sigma_m = sigma_m;
    const Field field = make_field(map, options);
    // standard deviation of the rise over 0.3 mm at 5 mm depth
    double sum = 0.0;
    double squares = 0.0;
    int n = 0;
    for (double x = 10e-3; x < 110e-3; x += 0.7e-3) {
        for (double y = 10e-3; y < 100e-3; y += 1.9e-3) {
            const double here = energy_gradient_N(field, place_at(field, {x, y}), 5e-3).x();
            const double before = energy_gradient_N(field, place_at(field, {x - 3e-4, y}), 5e-3).x();
            sum += here - before;
            squares += (here - before) * (here - before);
            ++n;
        }
    }
    CHECK(std::sqrt(squares / n - (sum / n) * (sum / n)) < 2e-3 / 3.0);
}

TEST_CASE("noise: none in a smooth map, none to estimate in a tiny one") {
    CHECK(normal_noise_N(map_of(30, 30, kPaperDepths_m, [](double x, double y, double d) { return 300 * d + x + y; })) <
          1e-6);
    CHECK(normal_noise_N(map_of(2, 2, kPaperDepths_m, [](double, double, double d) { return d; })) == 0.0);
    CHECK_FALSE(knows_noise(map_of(2, 2, kPaperDepths_m, [](double, double, double d) { return d; })));
    CHECK(knows_noise(map_of(4, 4, kPaperDepths_m, [](double, double, double d) { return d; })));
    CHECK(smoothing_sigma_m(Map{}, 0.0, 3e-4, 2e-3) == 0.0);
}

TEST_CASE("noise: what a map says of itself comes before the estimate") {
    Map map = map_of(30, 30, kPaperDepths_m, [](double x, double y, double d) { return 300 * d + x + y; });
    map.noise_N = 0.03;
    CHECK(normal_noise_N(map) == 0.03);
    CHECK(estimated_noise_N(map) < 1e-6);
}
