#include <cmath>
#include <doctest/doctest.h>
#include <initializer_list>
#include <numbers>

#include "mechanics/layer.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

TEST_CASE("bonded layer and half-space: the reference numbers to their last digit") {
    const double rows[5][5] = {{0.30, 0.88608, 0.67017, 0.96554, 0.74933},
                               {0.45, 0.76401, 0.57488, 0.84617, 0.65669},
                               {0.49, 0.72261, 0.54243, 0.80628, 0.62573},
                               {0.499, 0.71275, 0.53470, 0.79683, 0.61840},
                               {0.4999, 0.71175, 0.53391, 0.79588, 0.61766}};
    const ParabolicPatch patch{0.008, 0.025};
    for (const auto& row : rows) {
        CAPTURE(row[0]);
        const Layer layer{2500.0, row[0], 0.05};
        CHECK(std::abs(1e3 * layer_depression_m(layer, patch, 0.0) - row[1]) < 6e-6);
        CHECK(std::abs(1e3 * layer_mean_depression_m(layer, patch) - row[2]) < 6e-6);
        CHECK(std::abs(1e3 * half_space_depression_m(layer, patch, 0.0) - row[3]) < 6e-6);
        CHECK(std::abs(1e3 * half_space_mean_depression_m(layer, patch) - row[4]) < 6e-6);
    }
}

TEST_CASE("layer: a thick one is the half-space, far away both are a point load, the mean is the mean") {
    const ParabolicPatch patch{0.004, 0.1};
    const Layer thick{3000.0, 0.45, 400.0};
    for (const double r : {0.0, 0.002, 0.004, 0.006, 0.02}) {
        CAPTURE(r);
        CHECK(layer_depression_m(thick, patch, r) == close_to(half_space_depression_m(thick, patch, r)).epsilon(3e-4));
    }
    const double E = plane_strain_modulus_Pa(3000.0, 0.45);
    CHECK(half_space_depression_m(thick, patch, 0.2) == close_to(boussinesq_depression_m(E, 0.1, 0.2)).epsilon(1e-4));

    const Layer layer{3000.0, 0.45, 0.01};
    double work = 0.0;  // int p u dA by midpoints
    const int n = 2000;
    const double P = 2.0 * patch.force_N / (std::numbers::pi * 1.6e-5);
    for (int i = 0; i < n; ++i) {
        const double r = 0.004 * (i + 0.5) / n;
        work +=
            P * (1.0 - r * r / 1.6e-5) * layer_depression_m(layer, patch, r) * 2.0 * std::numbers::pi * r * 0.004 / n;
    }
    CHECK(work / patch.force_N == close_to(layer_mean_depression_m(layer, patch)).epsilon(1e-5));
    CHECK(layer_depression_m(layer, patch, 0.0) < half_space_depression_m(layer, patch, 0.0));
}

TEST_CASE("Hertz, Dimitriadis, punch") {
    CHECK(hertz_force_N(4000.0, 0.01, 0.001) == close_to(4.0 / 3.0 * 4000.0 * 0.1 * std::pow(0.001, 1.5)));
    CHECK(hertz_contact_radius_m(0.01, 0.001) == close_to(std::sqrt(1e-5)));
    CHECK(dimitriadis_force_N(3000.0, 0.01, 1e-4, 10.0) == close_to(hertz_force_N(4000.0, 0.01, 1e-4)).epsilon(2e-4));
    CHECK(dimitriadis_force_N(3000.0, 0.01, 1e-3, 0.02) > 1.1 * hertz_force_N(4000.0, 0.01, 1e-3));
    CHECK(punch_force_N(4000.0, 0.01, 0.001) == close_to(0.08));
}
