#include <doctest/doctest.h>
#include <limits>

#include "mechanics/error.h"
#include "mechanics/material.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

TEST_CASE("hard case 15: moduli that no solid has are refused with their entry") {
    const double inf = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Material bad[] = {{2500.0, 0.5}, {2500.0, 0.51}, {0.0, 0.3}, {-1.0, 0.3},
                            {nan, 0.3},    {2500.0, nan},  {inf, 0.3}, {1.0, -1.0}};
    for (const Material& m : bad) {
        CAPTURE(m.young_Pa);
        CAPTURE(m.poisson);
        const Material list[] = {{2500.0, 0.45}, m};
        try {
            check_materials(list);
            FAIL("accepted");
        } catch (const MaterialError& error) {
            CHECK(error.entries == std::vector<int>{1});
        }
    }
    const Material good[] = {{1e-3, 0.4999999}, {1e12, -0.5}, {1.0, 0.0}};
    CHECK_NOTHROW(check_materials(good));
    CHECK_THROWS_AS(materials_of_cells(Eigen::VectorXi::Constant(3, 3), good), MaterialError);
}

TEST_CASE("stress: uniaxial and hydrostatic") {
    const Material m{1000.0, 0.25};
    Voigt strain;
    strain << 1.0, -0.25, -0.25, 0, 0, 0;
    Voigt expected;
    expected << 1000.0, 0, 0, 0, 0, 0;
    CHECK((stress_Pa(m, strain) - expected).norm() < 1e-10);
    strain << 0.1, 0.1, 0.1, 0.2, 0, 0;
    CHECK(stress_Pa(m, strain)(0) == close_to(3.0 * kappa_Pa(m) * 0.1).epsilon(1e-14));
    CHECK(stress_Pa(m, strain)(3) == close_to(mu_Pa(m) * 0.2).epsilon(1e-14));
}

TEST_CASE("mixing: ends are the parts, soft < between < stiff") {
    const Material in{2.4e6, 0.49};
    const Material out{3000.0, 0.45};
    for (const Mixing rule : {Mixing::stiff, Mixing::soft, Mixing::between}) {
        CHECK(mix(in, out, 1.0, rule).young_Pa == close_to(in.young_Pa).epsilon(1e-12));
        CHECK(mix(in, out, 0.0, rule).poisson == close_to(out.poisson).epsilon(1e-12));
    }
    CHECK(mix(in, out, 0.5, Mixing::soft).young_Pa < mix(in, out, 0.5, Mixing::between).young_Pa);
    CHECK(mix(in, out, 0.5, Mixing::between).young_Pa < mix(in, out, 0.5, Mixing::stiff).young_Pa);
    std::vector<Material> cells(3, out);
    mix_in(Eigen::Vector3d(0.0, 0.5, 1.0), in, Mixing::between, cells);
    CHECK(cells[0].young_Pa == out.young_Pa);
    CHECK(cells[2].young_Pa == in.young_Pa);
}
