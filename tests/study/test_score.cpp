#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <numbers>
#include <random>

#include "study/score.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::study;
using namespace palpa::test;

namespace {

// Best assignment by trying them all: most hits, then least sum of distances.
struct Best {
    int hits = 0;
    double sum_m = 0.0;
};
void try_all(const std::vector<Target>& targets, const std::vector<MarkedPlace>& marks, std::size_t t,
             std::vector<bool>& used, int hits, double sum_m, Best& best) {
    if (t == targets.size()) {
        if (hits > best.hits || (hits == best.hits && sum_m < best.sum_m)) best = {hits, sum_m};
        return;
    }
    try_all(targets, marks, t + 1, used, hits, sum_m, best);
    for (std::size_t m = 0; m < marks.size(); ++m) {
        const double d_m = distance_m(targets[t], marks[m]);
        if (used[m] || d_m > acceptance_radius_m(targets[t])) continue;
        used[m] = true;
        try_all(targets, marks, t + 1, used, hits + 1, sum_m + d_m, best);
        used[m] = false;
    }
}

}  // namespace

TEST_CASE("score: hits, a second mark on one nodule, and false marks") {
    const std::vector<Target> targets{{"A", 0.03, 0.03, 0.010}, {"B", 0.08, 0.04, 0.004}, {"C", 0.06, 0.09, 0.006}};
    const std::vector<MarkedPlace> marks{{0.036, 0.03}, {0.031, 0.03}, {0.0875, 0.04}, {0.01, 0.10}};
    const Score score = score_marks(targets, marks);
    CHECK(score.marks[0].kind == MarkKind::again);
    CHECK(score.marks[1].kind == MarkKind::hit);  // the nearer of the two
    CHECK(score.marks[2].kind == MarkKind::hit);  // 7.5 mm off a small nodule: within 8 mm
    CHECK(score.marks[3].kind == MarkKind::false_mark);
    CHECK(score.marks[3].target == 2);
    CHECK(score.found_by == std::vector<int>{1, 2, -1});
    CHECK(score.true_positives == 2);
    CHECK(score.false_positives == 1);
    CHECK(score.false_negatives == 1);
    CHECK(score.sensitivity == close_to(2.0 / 3.0));
    CHECK(score.ppv == close_to(2.0 / 3.0));
}

TEST_CASE("score: one mark between two nodules leaves the other to the second mark") {
    const std::vector<Target> targets{{"A", 0.00, 0.0, 0.008}, {"B", 0.010, 0.0, 0.008}};
    // the first mark is nearer to A, but only it reaches B
    const std::vector<MarkedPlace> marks{{0.004, 0.0}, {-0.006, 0.0}};
    const Score score = score_marks(targets, marks);
    CHECK(score.true_positives == 2);
    CHECK(score.found_by == std::vector<int>{1, 0});
}

TEST_CASE("score: nothing to find, or nothing marked") {
    const Score empty = score_marks({}, {});
    CHECK(std::isnan(empty.sensitivity));
    CHECK(std::isnan(empty.ppv));
    const std::vector<MarkedPlace> mark{{0.0, 0.0}};
    CHECK(score_marks({}, mark).false_positives == 1);
    CHECK(score_marks({}, mark).marks[0].target == -1);
    const std::vector<Target> target{{"A", 0.0, 0.0, 0.01}};
    CHECK(score_marks(target, {}).sensitivity == 0.0);
}

TEST_CASE("score: an elongated target is found along its whole length") {
    const Target rod{"A", 0.05, 0.05, 0.004, 0.060, std::numbers::pi / 2.0};
    CHECK(distance_m(rod, {0.05, 0.078}) == close_to(0.0));
    CHECK(distance_m(rod, {0.053, 0.078}) == close_to(0.003));
    CHECK(distance_m(rod, {0.05, 0.088}) == close_to(0.010));
}

TEST_CASE("score: as many hits as any assignment has, at the least sum of distances") {
    constexpr unsigned kSeed = 7;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> place_m(0.0, 0.05);
    for (int trial = 0; trial < 300; ++trial) {
        CAPTURE(trial);
        std::vector<Target> targets(random() % 5);
        std::vector<MarkedPlace> marks(random() % 6);
        for (Target& target : targets) target = {"T", place_m(random), place_m(random), 0.008 + 0.2 * place_m(random)};
        for (MarkedPlace& mark : marks) mark = {place_m(random), place_m(random)};
        const Score score = score_marks(targets, marks);
        Best best;
        best.sum_m = std::numeric_limits<double>::infinity();
        best.hits = -1;
        std::vector<bool> used(marks.size(), false);
        try_all(targets, marks, 0, used, 0, 0.0, best);
        double sum_m = 0.0;
        for (const MarkScore& mark : score.marks) sum_m += mark.kind == MarkKind::hit ? mark.distance_m : 0.0;
        CHECK(score.true_positives == best.hits);
        CHECK(sum_m == close_to(best.sum_m).epsilon(1e-9));
    }
}
