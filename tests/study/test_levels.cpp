#include <doctest/doctest.h>

#include "study/levels.h"
#include "tests/error_message.h"

using namespace palpa::study;
using namespace palpa::test;

// The bounds are those of `palpa study levels`, widened by four standard errors of so few studies.
TEST_CASE("levels: tests over people keep their level and their intervals cover; the others are labelled") {
    LevelOptions options;
    options.studies = 300;
    options.resamples = 200;
    options.seed = 41;
    CAPTURE(options.seed);
    const LevelResult result = measure_levels({12, 10, 1.0}, options);
    int labelled = 0;
    for (const Rate& rate : result.rejections) {
        CAPTURE(rate.name);
        CHECK(rate.n == options.studies);
        if (rate.label.empty()) {
            CHECK(rate.rate() < 0.05 + 4.0 * 0.0126);
        } else {
            ++labelled;
            CHECK(rate.rate() > 0.14);
        }
    }
    CHECK(labelled == 2);
    for (const Rate& rate : result.coverage) {
        CAPTURE(rate.name);
        if (rate.label.empty()) {
            CHECK(rate.rate() > 0.92 - 4.0 * 0.0157);
        } else {
            CHECK(rate.rate() < 0.88);
        }
    }
    const std::string text = levels_markdown({result}, options);
    CHECK(contains(text, "| people, repeats, slope SD | 12, 10, 1 |"));
    CHECK(contains(text, "| McNemar (ignores clustering) |"));
}

TEST_CASE("levels: three people who find and mark nothing in some studies are counted where they can be") {
    LevelOptions options;
    options.studies = 400;
    options.resamples = 100;
    options.seed = 42;
    CAPTURE(options.seed);
    for (const Rate& rate : measure_levels({3, 1, 1.0}, options).coverage) {
        CAPTURE(rate.name);
        CHECK(rate.n > 200);
        if (rate.name == "Se: bootstrap") CHECK(rate.n < options.studies);
    }
}

TEST_CASE("levels: repeat from their seed") {
    LevelOptions options;
    options.studies = 20;
    options.coverage = false;
    const auto text = [&] { return levels_markdown({measure_levels({10, 1, 0.7}, options)}, options); };
    CHECK(text() == text());
}
