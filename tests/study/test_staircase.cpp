// Staircases against what is known of their methods, with simulated observers.

#include <cmath>
#include <doctest/doctest.h>

#include "study/random.h"
#include "study/staircase.h"
#include "tests/close_to.h"

using namespace palpa::study;
using namespace palpa::test;

namespace {

constexpr std::uint64_t kStaircaseSeed = 16;

StaircaseTask up_down(int steps_after_wrong, double step, int levels, int trials) {
    StaircaseTask task;
    task.method = StaircaseMethod::weighted_up_down;
    task.reference_kPa = 10.0;
    task.steps_after_wrong = steps_after_wrong;
    task.trials = trials;
    for (int i = 1; i <= levels; ++i) task.comparisons_kPa.push_back(10.0 * std::exp(step * i));
    task.start = levels / 2;
    return task;
}

StaircaseTask quest(int trials) {
    StaircaseTask task;
    task.reference_kPa = 10.0;
    task.trials = trials;
    for (const double x : {0.03, 0.06, 0.1, 0.15, 0.25, 0.4, 0.7}) {
        task.comparisons_kPa.push_back(10.0 * std::exp(x));
        task.comparisons_kPa.push_back(10.0 * std::exp(-x));
    }
    return task;
}

std::vector<StaircaseAnswer> answers_of(const StaircaseTask& task, const PosteriorPoint& observer, Random& random) {
    std::vector<StaircaseAnswer> answers;
    for (int i = 0; i < task.trials; ++i) {
        const bool reference_first = i % 2 == 0;
        const int level = next_level(task, answers, reference_first);
        const double x = std::log(task.comparisons_kPa[static_cast<std::size_t>(level)] / task.reference_kPa);
        answers.push_back({level, reference_first, random.uniform() < share_right(observer, x, reference_first)});
    }
    return answers;
}

}  // namespace

TEST_CASE("staircase: weighted up-down goes one level down after a right answer, k up after a wrong one") {
    const StaircaseTask task = up_down(3, 0.05, 10, 10);
    std::vector<StaircaseAnswer> answers;
    CHECK(next_level(task, answers, true) == 5);
    answers.push_back({5, true, true});
    CHECK(next_level(task, answers, true) == 4);
    answers.push_back({4, true, false});
    CHECK(next_level(task, answers, false) == 7);
    answers.push_back({8, true, false});
    CHECK(next_level(task, answers, false) == 9);  // there is none above
    answers.push_back({0, true, true});
    CHECK(next_level(task, answers, false) == 0);
}

TEST_CASE("staircase: weighted up-down makes k of k + 1 answers right (Kaernbach 1991)") {
    MESSAGE("seed " << kStaircaseSeed);
    Random random(kStaircaseSeed);
    for (const int k : {1, 2, 3, 4}) {
        const StaircaseTask task = up_down(k, 0.02, 60, 6000);
        const auto answers = answers_of(task, {0.0, 0.4, 0.0, 1.0}, random);
        int right = 0;
        for (std::size_t i = 1000; i < answers.size(); ++i) right += answers[i].correct;
        CAPTURE(k);
        if (k == 1) continue;  // half right is chance: such a staircase ends at the smallest difference
        // binomial standard error 0.006
        CHECK(right / 5000.0 == close_to(k / (k + 1.0)).epsilon(0.03));
    }
}

TEST_CASE("staircase: the threshold comes near the level of which 75 % are right") {
    MESSAGE("seed " << kStaircaseSeed);
    Random random(kStaircaseSeed);
    const StaircaseTask task = up_down(3, 0.03, 40, 300);
    double sum = 0.0;
    for (int i = 0; i < 20; ++i) {
        const StaircaseEstimate e = estimate_of(task, answers_of(task, {0.0, 0.4, 0.0, 1.0}, random));
        CHECK(e.status == "ok");
        REQUIRE(e.threshold);
        CHECK(*e.target == 0.75);
        sum += *e.threshold;
    }
    // 0.6745 sd = 0.27; between the levels the psychometric function is curved, which adds some per cent
    CHECK(sum / 20 > 0.26);
    CHECK(sum / 20 < 0.31);
}

TEST_CASE("staircase: the threshold of softer comparisons is a difference below the reference") {
    StaircaseTask task = up_down(1, 0.1, 5, 6);
    task.comparisons_kPa = {8.0, 6.0, 4.0};
    // right and wrong in turn: from the second reversal on, between 8 and 6 kPa
    std::vector<StaircaseAnswer> answers;
    for (int i = 0; i < 8; ++i) answers.push_back({i % 2, true, i % 2 == 1});
    const StaircaseEstimate e = estimate_of(task, answers);
    REQUIRE(e.threshold);
    CHECK(percent_of(*e.threshold) == close_to(100.0 * (std::sqrt(0.8 * 0.6) - 1.0)));  // and not +44 %
}

TEST_CASE("staircase: QUEST+ asks for the least expected entropy, as written out in full") {
    const StaircaseTask task = quest(10);
    const std::vector<StaircaseAnswer> answers{{12, true, true}, {6, false, true}, {2, true, false}};
    const std::vector<PosteriorPoint> before = posterior_of(task, answers);
    int best = -1;
    double least = 1e300;
    for (int level = 0; level < 14; ++level) {
        double expected = 0.0;
        for (const bool correct : {true, false}) {
            std::vector<StaircaseAnswer> then = answers;
            then.push_back({level, false, correct});
            const std::vector<PosteriorPoint> after = posterior_of(task, then);
            const double x = std::log(task.comparisons_kPa[static_cast<std::size_t>(level)] / 10.0);
            double p = 0.0, entropy = 0.0;
            for (const PosteriorPoint& point : before) {
                const double right = share_right(point, x, false);
                p += point.weight * (correct ? right : 1.0 - right);
            }
            for (const PosteriorPoint& point : after)
                entropy -= point.weight > 0.0 ? point.weight * std::log(point.weight) : 0.0;
            expected += p * entropy;
        }
        if (expected < least) best = level, least = expected;
    }
    CHECK(next_level(task, answers, false) == best);
}

TEST_CASE("staircase: the posterior does not depend on the order of the answers, and adds up to 1") {
    const StaircaseTask task = quest(10);
    const auto one = posterior_of(task, {{12, true, true}, {6, false, true}, {2, true, false}});
    const auto other = posterior_of(task, {{2, true, false}, {12, true, true}, {6, false, true}});
    double sum = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        sum += one[i].weight;
        CHECK(one[i].weight == close_to(other[i].weight).epsilon(1e-9));
    }
    CHECK(sum == close_to(1.0).epsilon(1e-12));
}

TEST_CASE("staircase: 95 % credible intervals hold the truth of 95 % of observers drawn from the prior") {
    MESSAGE("seed " << kStaircaseSeed);
    Random random(kStaircaseSeed);
    const StaircaseTask task = quest(20);
    const std::vector<PosteriorPoint> prior = posterior_of(task, {});
    constexpr int kObservers = 60;
    int inside = 0;
    for (int i = 0; i < kObservers; ++i) {
        double left = random.uniform();
        std::size_t at = 0;
        while (at + 1 < prior.size() && (left -= prior[at].weight) > 0.0) ++at;
        const StaircaseEstimate e = estimate_of(task, answers_of(task, prior[at], random));
        const double jnd = 0.6744897501960817 * prior[at].sd;
        inside += e.jnd_low <= jnd && jnd <= e.jnd_high ? 1 : 0;
    }
    MESSAGE(inside << " of " << kObservers);
    CHECK(inside >= 52);  // 95 % of 60 is 57; fewer than 52 have a probability of 0.4 %
}

TEST_CASE("staircase: QUEST+ comes nearer with the same number of answers than chance levels do") {
    MESSAGE("seed " << kStaircaseSeed);
    Random random(kStaircaseSeed);
    const StaircaseTask task = quest(30);
    const PosteriorPoint observer{0.05, 0.2, 0.02, 1.0};
    double by_method = 0.0, by_chance = 0.0;
    for (int i = 0; i < 12; ++i) {
        const StaircaseEstimate e = estimate_of(task, answers_of(task, observer, random));
        by_method += std::log(e.jnd_high / e.jnd_low);
        std::vector<StaircaseAnswer> answers;
        for (int k = 0; k < task.trials; ++k) {
            const auto level = static_cast<int>(random.below(14));
            const double x = std::log(task.comparisons_kPa[static_cast<std::size_t>(level)] / 10.0);
            answers.push_back({level, k % 2 == 0, random.uniform() < share_right(observer, x, k % 2 == 0)});
        }
        const StaircaseEstimate chance = estimate_of(task, answers);
        by_chance += std::log(chance.jnd_high / chance.jnd_low);
    }
    MESSAGE("mean width of ln: " << by_method / 12 << " against " << by_chance / 12);
    CHECK(by_method < by_chance);
}

TEST_CASE("staircase: too few reversals, or levels that end too early, say so") {
    const StaircaseTask task = up_down(3, 0.05, 10, 10);
    std::vector<StaircaseAnswer> answers(10, StaircaseAnswer{0, true, true});
    CHECK(estimate_of(task, answers).status == "open");
    CHECK_FALSE(estimate_of(task, answers).threshold);
    CHECK(estimate_of(task, {}).trials == 0);
    CHECK(percent_of(std::log(1.25)) == close_to(25.0));
}

TEST_CASE("staircase: answers at levels that were not asked for are counted, by both methods") {
    MESSAGE("seed " << kStaircaseSeed);
    Random random(kStaircaseSeed);
    const PosteriorPoint observer{0.0, 0.2, 0.02, 1.0};
    for (const StaircaseTask& task : {up_down(3, 0.05, 10, 40), quest(40)}) {
        std::vector<StaircaseAnswer> answers = answers_of(task, observer, random);
        CHECK(answers_at_other_levels(task, answers) == 0);
        answers.back().level = answers.back().level == 0 ? 5 : 0;
        CHECK(answers_at_other_levels(task, answers) == 1);
    }
}

TEST_CASE("staircase: an interval that the answers have hardly moved from the prior's is open, a good one is not") {
    MESSAGE("seed " << kStaircaseSeed);
    Random random(kStaircaseSeed);
    const Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/threshold.json");
    StaircaseTask task = protocol.staircase;
    CHECK(estimate_of(task, {}).status == "open");
    const PosteriorPoint observer{0.0, 0.2, 0.02, 1.0};
    for (const int trials : {1, 4}) {
        task.trials = trials;
        for (int i = 0; i < 5; ++i) CHECK(estimate_of(task, answers_of(task, observer, random)).status == "open");
    }
    task.trials = protocol.staircase.trials;
    for (int i = 0; i < 5; ++i) {
        const StaircaseEstimate e = estimate_of(task, answers_of(task, observer, random));
        CAPTURE(percent_of(e.jnd_low));
        CAPTURE(percent_of(e.jnd_high));
        CHECK(e.status == "ok");
    }
}
