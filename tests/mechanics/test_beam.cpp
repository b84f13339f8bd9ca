#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

#include "mechanics/beam.h"
#include "mechanics/error.h"
#include "tests/close_to.h"
#include "tests/mechanics/paper_beams.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

double tip_mm(PaperBeam kind, int along, bool with_shear) {
    const Voxels voxels = paper_beam(kind, along);
    return 1e4 * beam_tip(beam_pieces(voxels, kHardAndSoft, 0, 2, 0.0, 0.1), true, with_shear).m_per_N;  // 10 N
}

}  // namespace

TEST_CASE("beam: Euler-Bernoulli tips of the five beams, closed forms") {
    CHECK(tip_mm(PaperBeam::homogeneous, 100, false) == close_to(0.481927711).epsilon(1e-8));
    CHECK(tip_mm(PaperBeam::hshsh, 100, false) == close_to(1.016289).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::shshs, 100, false) == close_to(1.465639).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::hsh, 90, false) == close_to(0.495868).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::shs, 90, false) == close_to(1.791045).epsilon(1e-6));
}

TEST_CASE("beam: Timoshenko tips of the five beams, shear by energy") {
    CHECK(tip_mm(PaperBeam::homogeneous, 100, true) == close_to(0.485629).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::hshsh, 100, true) == close_to(1.025201).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::shshs, 100, true) == close_to(1.477156).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::hsh, 90, true) == close_to(0.506614).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::shs, 90, true) == close_to(1.799366).epsilon(1e-6));
    const auto sandwich = beam_pieces(paper_beam(PaperBeam::hsh, 90), kHardAndSoft, 0, 2, 0.0, 0.1);
    // shear stiffness: the integral summed over 30,000 strips by another program
    CHECK(sandwich[0].section.shear_N == close_to(93059.8375).epsilon(1e-7));
    CHECK(sandwich[0].section.bending_N_m2 == close_to(6.722222).epsilon(1e-6));
}

TEST_CASE("beam: a bilayer of 6 mm hard and 4 mm soft has its neutral axis at 3.692042 mm") {
    const std::vector<SectionRow> rows{{0.0, 0.006, 8.3e9 * 0.01, 3e9 * 0.01}, {0.006, 0.01, 2e9 * 0.01, 0.7e9 * 0.01}};
    const Section section = section_of(rows);
    CHECK(section.neutral_m == close_to(3.692042e-3).epsilon(1e-6));
    CHECK(section.bending_N_m2 == close_to(3.323850).epsilon(1e-6));
}

TEST_CASE("beam: a homogeneous beam that is cut up bends alike, to 1e-12; so does one along another axis") {
    const std::vector<Material> same{kHardAndSoft[0], kHardAndSoft[0]};
    const Voxels whole = paper_beam(PaperBeam::homogeneous, 50), cut = paper_beam(PaperBeam::hshsh, 50);
    const BeamTip one = beam_tip(beam_pieces(whole, same, 0, 2, 0.0, 0.1), true, true);
    const auto pieces = beam_pieces(cut, same, 0, 2, 0.0, 0.1);
    CHECK(pieces.size() == 5);
    const BeamTip five = beam_tip(pieces, true, true);
    CHECK(std::abs(five.m_per_N / one.m_per_N - 1.0) < 1e-12);
    CHECK(std::abs(five.rad_per_N / one.rad_per_N - 1.0) < 1e-12);
    CHECK(beam_tip(beam_pieces(cut, same, 0, 1, 0.0, 0.1), false, true).m_per_N ==
          close_to(one.m_per_N).epsilon(1e-12));

    Voxels upright = empty_voxels({5, 5, 50}, {0.002, {}});
    EditHistory history;
    apply({EditKind::add, {EverywhereRegion{}}, 0, {}}, upright, history);
    for (const int force_axis : {0, 1}) {
        CHECK(beam_tip(beam_pieces(upright, same, 2, force_axis, 0.0, 0.1), true, true).m_per_N ==
              close_to(one.m_per_N).epsilon(1e-12));
    }
}

TEST_CASE("beam: clamped at the other end, an uneven beam is another one") {
    const std::vector<Material> soft_tip = kHardAndSoft;
    Voxels voxels = paper_beam(PaperBeam::homogeneous, 50);
    EditHistory history;
    apply({EditKind::permute, {BoxRegion{{0.05, -1, -1}, {1, 1, 1}}}, 1, {}}, voxels, history);
    const auto pieces = beam_pieces(voxels, soft_tip, 0, 2, 0.0, 0.1);
    const double stiff_root = beam_tip(pieces, true, false).m_per_N, soft_root = beam_tip(pieces, false, false).m_per_N;
    const double I = 1e-8 / 12.0, eighth = 1e-3 / 8.0;
    CHECK(stiff_root == close_to((7 * eighth / 8.3e9 + eighth / 2e9) / (3.0 * I)).epsilon(1e-12));
    CHECK(soft_root == close_to((7 * eighth / 2e9 + eighth / 8.3e9) / (3.0 * I)).epsilon(1e-12));
}

TEST_CASE("beam: Euler's load of a uniform column, and of one with a soft end by the equation of two sections") {
    const double pi = std::numbers::pi;
    const auto uniform = beam_pieces(paper_beam(PaperBeam::homogeneous, 50), kHardAndSoft, 0, 2, 0.0, 0.1);
    const double I = 1e-8 / 12.0;
    CHECK(euler_load_N(uniform, true) == close_to(pi * pi * 8.3e9 * I / (4.0 * 0.01)).epsilon(1e-11));
    // from the clamp: D1 over a, D2 over b; tan(k1 a) tan(k2 b) = k2 / k1
    struct TwoSections {
        double a_m, b_m, D1, D2;
    };
    for (const auto& [a_m, b_m, D1, D2] : {TwoSections{0.08, 0.02, 0.7, 0.003}, TwoSections{0.02, 0.08, 0.003, 0.7},
                                           TwoSections{0.05, 0.05, 0.1, 0.2}, TwoSections{0.09, 0.01, 1.0, 1e-6}}) {
        const Section first{0.0, 0.0, D1, 0.0}, second{0.0, 0.0, D2, 0.0};
        const double a = a_m, L = a_m + b_m;
        const std::vector<BeamPiece> low{{0.0, a, first, 0.01}, {a, L, second, 0.01}};
        const std::vector<BeamPiece> high{{0.0, b_m, second, 0.01}, {b_m, L, first, 0.01}};
        const double P = euler_load_N(low, true);
        CHECK(euler_load_N(high, false) == close_to(P).epsilon(1e-11));
        const double k1 = std::sqrt(P / D1), k2 = std::sqrt(P / D2);
        CHECK(k1 * a < pi / 2);
        CHECK(k2 * b_m < pi / 2);
        CHECK(std::tan(k1 * a) * std::tan(k2 * b_m) == close_to(k2 / k1).epsilon(1e-6));
    }
    // a rubber end on a practically rigid rest is a column by itself
    const std::vector<BeamPiece> rubber{{0.0, 0.08, {0.0, 0.0, 1e6, 0.0}, 0.01},
                                        {0.08, 0.1, {0.0, 0.0, 1.0, 0.0}, 0.01}};
    CHECK(euler_load_N(rubber, true) == close_to(pi * pi / (4.0 * 4e-4)).epsilon(1e-4));
}

TEST_CASE("beam: gaps, equal axes and planes outside are refused") {
    Voxels voxels = paper_beam(PaperBeam::homogeneous, 50);
    CHECK_THROWS_AS(beam_pieces(voxels, kHardAndSoft, 0, 0, 0.0, 0.1), MeshError);
    CHECK_THROWS_AS(beam_pieces(voxels, kHardAndSoft, 0, 2, 0.0, 0.11), MeshError);
    CHECK_THROWS_AS(beam_pieces(voxels, kHardAndSoft, 0, 2, 0.05, 0.05), MeshError);
    EditHistory history;
    apply({EditKind::remove, {BoxRegion{{0.04, -1, -1}, {0.05, 1, 1}}}, 0, {}}, voxels, history);
    CHECK_THROWS_WITH_AS(beam_pieces(voxels, kHardAndSoft, 0, 2, 0.0, 0.1), doctest::Contains("gap"), MeshError);
    CHECK(beam_pieces(voxels, kHardAndSoft, 0, 2, 0.05, 0.1).size() == 1);
}

TEST_CASE("beam: deflections are those of the tip at the tip, symmetric in load and place, straight beyond the load") {
    const auto pieces = beam_pieces(paper_beam(PaperBeam::hshsh, 50), kHardAndSoft, 0, 2, 0.0, 0.1);
    for (const bool low : {true, false}) {
        const double tip_m = low ? 0.1 : 0.0, clamp_m = 0.1 - tip_m;
        const auto w = [&](double load_m, double at_m) {
            return beam_deflection_m_per_N(pieces, low, {load_m, at_m}, true);
        };
        CHECK(w(tip_m, tip_m) == close_to(beam_tip(pieces, low, true).m_per_N).epsilon(1e-12));
        CHECK(w(0.03, 0.07) == close_to(w(0.07, 0.03)).epsilon(1e-12));
        CHECK(w(tip_m, clamp_m) == 0.0);
        const double a = low ? 0.04 : 0.06, step = low ? 0.02 : -0.02;
        CHECK(w(a, a + 2 * step) - w(a, a + step) == close_to(w(a, a + step) - w(a, a)).epsilon(1e-9));
    }
}
