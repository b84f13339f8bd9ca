#include <doctest/doctest.h>

#include "parts/beam_model.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::parts;
using namespace palpa::test;
using palpa::test::close_to;

namespace {

// Pieces of 20 mm with these moduli (GPa), b = h = 10 mm, or n pieces over 100 mm.
PartBeam paper_pieces(const std::vector<double>& young_GPa) {
    PartBeam beam;
    const auto n = static_cast<double>(young_GPa.size());
    for (std::size_t i = 0; i < young_GPa.size(); ++i) {
        const auto at = static_cast<double>(i);
        beam.pieces.push_back(
            {0.1 * at / n, 0.1 * (at + 1.0) / n, {0.0, 0.0, 1e9 * young_GPa[i] * 1e-8 / 12.0, 1.0}, 0.01});
    }
    beam.length_m = 0.1;
    return beam;
}

}  // namespace

TEST_CASE("paper's spring: 2/3 of a beam in one piece, 5.2 times too stiff in five") {
    CHECK(paper_spring_N_per_m(paper_pieces({8.3})) == close_to(13833.3333).epsilon(1e-8));
    CHECK(paper_spring_N_per_m(paper_pieces({8.3, 2.0, 8.3, 2.0, 8.3})) == close_to(51008.0).epsilon(1e-4));
}

TEST_CASE("paper's spring: a uniform beam in n pieces is 2 n^2 / (n + 1) times as stiff as in one") {
    const double one = paper_spring_N_per_m(paper_pieces({2.0}));
    for (const int n : {2, 4, 5, 8, 32}) {
        const double cut = paper_spring_N_per_m(paper_pieces(std::vector<double>(static_cast<std::size_t>(n), 2.0)));
        CHECK(cut / one == close_to(2.0 * n * n / (n + 1.0)).epsilon(1e-12));
    }
}
