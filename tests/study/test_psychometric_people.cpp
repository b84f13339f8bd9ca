#include <cmath>
#include <doctest/doctest.h>

#include "study/psychometric_people.h"
#include "study/simulated_observer.h"
#include "tests/close_to.h"

using namespace palpa::study;
using namespace palpa::test;

namespace {

std::vector<PersonAnswers> drawn_people(int n, double sd, Random& random) {
    std::vector<PersonAnswers> people;
    for (int i = 0; i < n; ++i)
        people.push_back(draw_answers(paper_levels(), 80, {0.1 * random.normal(), sd, 0.02}, random));
    return people;
}

constexpr BootstrapOptions kFew{300, 1, 0.95};

}  // namespace

TEST_CASE("psychometric people: intervals hold the curve of all, repeat from their seed, and need two people") {
    constexpr std::uint64_t kSeed = 9;
    CAPTURE(kSeed);
    Random random(kSeed);
    const auto people = drawn_people(12, 0.3, random);
    const PsychometricFit all = fit_psychometric(pooled_answers(people), {});
    const CurveIntervals ci = intervals_of(resampled_curves(people, 0.05, kFew), 0.95);
    REQUIRE(ci.sd.closed());
    REQUIRE(ci.pse.closed());
    CHECK(*ci.sd.low < *all.sd);
    CHECK(*ci.sd.high > *all.sd);
    CHECK(*ci.pse.low < *all.pse);
    CHECK(*ci.pse.high > *all.pse);
    CHECK(*ci.sd.low == *intervals_of(resampled_curves(people, 0.05, kFew), 0.95).sd.low);
    const std::vector<PersonAnswers> one{people[0], {}};
    CHECK_FALSE(intervals_of(resampled_curves(one, 0.05, kFew), 0.95).sd.low);
}

TEST_CASE("psychometric people: people all alike leave no spread") {
    Random random(10);
    const PersonAnswers person = draw_answers(paper_levels(), 400, {0.0, 0.3, 0.0}, random);
    const std::vector<PersonAnswers> people(5, person);
    const CurveIntervals ci = intervals_of(resampled_curves(people, 0.05, kFew), 0.95);
    CHECK(*ci.sd.high - *ci.sd.low < 1e-6);
}

TEST_CASE("psychometric people: people who answer at a step leave limits out") {
    std::vector<PersonAnswers> people;
    for (int i = 0; i < 6; ++i)
        people.push_back({{-0.5, 0, 20}, {-0.1, i < 2 ? 6 : 0, 20}, {0.1, 20, 20}, {0.5, 20, 20}});
    const CurveIntervals ci = intervals_of(resampled_curves(people, 0.05, kFew), 0.95);
    CHECK_FALSE(ci.sd.low);
    CHECK_FALSE(ci.pse.low);
    CHECK_FALSE(ci.pse.high);
}

TEST_CASE("psychometric people: the ratio of JNDs, of the same people and of two groups") {
    constexpr std::uint64_t kSeed = 11;
    CAPTURE(kSeed);
    Random random(kSeed);
    const auto a = drawn_people(12, 0.6, random), b = drawn_people(12, 0.2, random);
    const ResampledCurves of_a = resampled_curves(a, 0.05, kFew), of_b = resampled_curves(b, 0.05, kFew);
    const OpenInterval same = bootstrap_jnd_ratio({a, of_a}, {b, of_b}, 0.05, kFew);
    REQUIRE(same.closed());
    CHECK(*same.low > 1.5);
    CHECK(*same.high < 6.0);
    const OpenInterval turned = bootstrap_jnd_ratio({b, of_b}, {a, of_a}, 0.05, kFew);
    CHECK(*turned.low == close_to(1.0 / *same.high).epsilon(0.02));
    // the first six did a, the others b
    auto half_a = a, half_b = b;
    for (std::size_t i = 0; i < 6; ++i) half_b[i].clear(), half_a[i + 6].clear();
    const ResampledCurves of_half_a = resampled_curves(half_a, 0.05, kFew);
    const ResampledCurves of_half_b = resampled_curves(half_b, 0.05, kFew);
    const OpenInterval apart = bootstrap_jnd_ratio({half_a, of_half_a}, {half_b, of_half_b}, 0.05, kFew);
    REQUIRE(apart.closed());
    CHECK(*apart.low > 1.0);
    CHECK(*apart.high > *apart.low);
}

TEST_CASE("psychometric people: the ratio of two independent JNDs") {
    PsychometricFit a, b;
    a.sd = 0.4, a.sd_ci = {0.3, 0.6};
    b.sd = 0.2, b.sd_ci = {0.2, 0.2};  // known exactly
    const OpenInterval exact = independent_jnd_ratio(a, b);
    CHECK(*exact.low == close_to(1.5));
    CHECK(*exact.high == close_to(3.0));
    b.sd_ci = {0.15, std::nullopt};
    const OpenInterval open = independent_jnd_ratio(a, b);
    CHECK_FALSE(open.low);
    CHECK(*open.high > 3.0);
}
