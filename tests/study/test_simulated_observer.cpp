#include <cmath>
#include <doctest/doctest.h>

#include "study/simulated_observer.h"
#include "tests/close_to.h"

using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("simulated observer: levels in both orders, answers spread evenly") {
    const std::vector<double> levels = paper_levels();
    REQUIRE(levels.size() == 10);
    CHECK(levels[0] == close_to(-std::log(3.75 / 1.75)));
    CHECK(levels[9] == -levels[0]);
    Random random(12);
    std::int64_t n = 0;
    for (const LevelAnswers& level : draw_answers(levels, 43, {}, random)) {
        CHECK(level.n >= 4);
        CHECK(level.n <= 5);
        n += level.n;
    }
    CHECK(n == 43);
    CHECK(draw_answers(levels, 3, {}, random).size() == 3);
}

// `palpa study observers` measures this with 1,000 observers; here few, so that a fault of the intervals shows.
TEST_CASE("simulated observer: the intervals hold the truth about as often as they say") {
    ObserverOptions options;
    options.repeats = 150;
    options.seed = 13;
    CAPTURE(options.seed);
    for (const int trials : {40, 80, 240}) {
        CAPTURE(trials);
        options.trials = trials;
        const Held held = coverage_of_profiles(options);
        CHECK(held.of == 150);
        for (const int times : {held.pse, held.sd, held.jnd_ratio}) {
            CHECK(times >= 130);  // 142.5 expected, standard deviation 2.7
            CHECK(times <= 150);
        }
    }
}

TEST_CASE("simulated observer: so do intervals by bootstrap over people") {
    ObserverOptions options;
    options.repeats = 60;
    options.trials = 40;
    options.seed = 14;
    CAPTURE(options.seed);
    const Held held = coverage_of_bootstrap(options, {10}, 200);
    CHECK(held.of == 60);
    for (const int times : {held.pse, held.sd, held.jnd_ratio}) CHECK(times >= 50);  // 57 expected, 1.7
}
