#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "mechanics/elastica.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;
using palpa::test::close_to;

namespace {

BeamPiece elastica_piece(double from_m, double to_m, double D) { return {from_m, to_m, {1.0, 0.0, D, 1e9}, 0.01}; }

// Tip over length for F L^2 / D = alpha, of a beam in `n` pieces.
ElasticaTip tip_of(double alpha, int n) {
    std::vector<BeamPiece> pieces;
    for (int i = 0; i < n; ++i) pieces.push_back(elastica_piece(0.2 * i / n, 0.2 * (i + 1) / n, 3.0));
    ElasticaTip tip = elastica_tip(pieces, true, alpha * 3.0 / 0.04);
    tip.across_m /= 0.2;
    tip.shortening_m /= 0.2;
    return tip;
}

}  // namespace

TEST_CASE("elastica: slope, deflection and shortening of the elliptic integrals, to 1e-6") {
    struct Row {
        double alpha, slope_rad, across, shortening;
    };
    for (const Row& row :
         {Row{0.1, 0.049954256, 0.033295319, 0.000665400}, Row{0.5, 0.244533647, 0.162143576, 0.015918962},
          Row{1.0, 0.461351950, 0.301720774, 0.056433236}, Row{2.0, 0.781749832, 0.493457480, 0.160641721},
          Row{10.0, 1.430285539, 0.810609025, 0.554995598}}) {
        CAPTURE(row.alpha);
        for (const int n : {1, 7}) {
            const ElasticaTip tip = tip_of(row.alpha, n);
            CHECK(tip.slope_rad == close_to(row.slope_rad).epsilon(1e-7));
            CHECK(tip.across_m == close_to(row.across).epsilon(1e-7));
            CHECK(tip.shortening_m == close_to(row.shortening).epsilon(1e-6));
        }
    }
}

TEST_CASE("elastica: a small force bends it as the linear beam, pieces of any stiffness and either clamp") {
    const std::vector<BeamPiece> pieces{elastica_piece(0.0, 0.03, 2.0), elastica_piece(0.03, 0.04, 7.0),
                                        elastica_piece(0.04, 0.1, 1.0)};
    for (const bool low : {true, false}) {
        const BeamTip linear = beam_tip(pieces, low, false);
        const ElasticaTip tip = elastica_tip(pieces, low, -0.01);
        CHECK(tip.across_m == close_to(-0.01 * linear.m_per_N).epsilon(1e-6));
        CHECK(tip.slope_rad == close_to(-0.01 * linear.rad_per_N).epsilon(1e-6));
    }
}

TEST_CASE("elastica: the harder the pull, the nearer it hangs to its limit, and tiny forces bend it in proportion") {
    // a beam that hangs: across = L - (2 - sqrt 2) sqrt(D / F), shortening = L - sqrt 2 sqrt(D / F)
    for (const double alpha : {1e4, 1e6, 1.9e6, 1e9, 1e12, 1e20}) {
        CAPTURE(alpha);
        for (const int n : {1, 7}) {
            const ElasticaTip tip = tip_of(alpha, n);
            const double decay = 1.0 / std::sqrt(alpha);
            CHECK(std::abs(tip.across_m - (1.0 - (2.0 - std::sqrt(2.0)) * decay)) < 1e-7);
            CHECK(std::abs(tip.shortening_m - (1.0 - std::sqrt(2.0) * decay)) < 1e-7);
        }
    }
    for (const double alpha : {1e-3, 1e-6, 1e-9, 1e-12, 1e-200}) {
        CAPTURE(alpha);
        CHECK(tip_of(alpha, 3).across_m / alpha == close_to(1.0 / 3.0).epsilon(1e-6));
    }
}

TEST_CASE("elastica: no pieces, no force and a force that is not a number bend nothing; a huge force stays finite") {
    CHECK(elastica_tip({}, true, 1.0).across_m == 0.0);
    const std::vector<BeamPiece> one{elastica_piece(0.0, 0.1, 1.0)};
    CHECK(elastica_tip(one, true, 0.0).across_m == 0.0);
    CHECK(elastica_tip(one, true, std::numeric_limits<double>::quiet_NaN()).across_m == 0.0);
    const ElasticaTip huge = elastica_tip(one, true, 1e5);
    CHECK(std::isfinite(huge.across_m));
    CHECK(huge.across_m < 0.1);
    CHECK(huge.across_m > 0.09);
}
