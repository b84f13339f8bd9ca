#include <cmath>
#include <doctest/doctest.h>
#include <string>

#include "study/comparisons.h"
#include "study/report.h"
#include "tests/close_to.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::study;
using namespace palpa::test;

namespace {

// Two groups of six; everybody finds one of two nodules under x, and those of group II both under y.
Observations mixed_study() {
    Observations seen;
    for (const char* name : {"x", "y"}) index_of(name, seen.conditions);
    for (const char* name : {"A", "B"}) index_of(name, seen.nodules);
    for (const char* name : {"I", "II"}) index_of(name, seen.groups);
    for (int person = 0; person < 12; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        seen.group_of.push_back(person / 6);
        for (int condition = 0; condition < 2; ++condition) {
            for (int nodule = 0; nodule < 2; ++nodule) {
                const bool hit = nodule == 0 ? person % 6 != condition : condition == 1 && person >= 6;
                seen.rows.push_back({condition, person, nodule, 0, hit, !hit, 0});
            }
            seen.rows.push_back({condition, person, -1, 0, 0, 0, 1});
        }
    }
    return seen;
}

}  // namespace

TEST_CASE("comparisons: groups under each condition, and how much they differ between conditions") {
    const std::vector<GroupResult> results = compare_groups(mixed_study(), {});
    // two conditions and their interaction for sensitivity, two conditions for PPV
    REQUIRE(results.size() == 5);
    CHECK(results[1].condition == "y");
    CHECK(results[1].people.difference == close_to(-0.5));
    CHECK(results[1].people.p < 0.01);
    CHECK(results[1].p_holm == close_to(2.0 * results[1].people.p));
    CHECK(results[2].condition == "x");
    CHECK(results[2].condition_b == "y");
    CHECK(results[2].people.difference == close_to(0.5));
    CHECK(results[2].p_holm == close_to(results[2].people.p));
    CHECK(results[3].quantity == Quantity::ppv);
}

TEST_CASE("comparisons: the stated one is tested alone; without its logs it says why it cannot be computed") {
    Observations seen = mixed_study();
    CHECK_FALSE(primary_result(seen, {}));
    seen.primary = PrimaryComparison{Quantity::sensitivity, false, {"y", "x"}, "", PrimaryTest::permutation};
    const auto result = primary_result(seen, {});
    REQUIRE(result);
    CHECK(result->people.difference == close_to(0.25));
    CHECK(result->p == result->people.p_permutation);
    seen.primary = PrimaryComparison{Quantity::sensitivity, true, {"I", "II"}, "y", PrimaryTest::t};
    CHECK(primary_result(seen, {})->people.difference == close_to(-0.5));
    seen.primary = PrimaryComparison{Quantity::sensitivity, false, {"y", "z"}, "", PrimaryTest::t};
    const auto missing = primary_result(seen, {});
    CHECK(std::isnan(missing->p));
    CHECK(missing->people.status == "cannot be computed, because no log of 'z' counts");
    seen.primary = PrimaryComparison{Quantity::sensitivity, true, {"I", "III"}, "y", PrimaryTest::t};
    CHECK(primary_result(seen, {})->people.design == Design::between);
}

TEST_CASE("comparisons: forced choices of two conditions over people, corrected over all pairs") {
    Observations seen;
    for (const char* name : {"x", "y", "z"}) index_of(name, seen.conditions);
    for (int person = 0; person < 8; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        for (int condition = 0; condition < 3; ++condition)
            seen.choices.push_back({condition, person, -1, 5 + condition + (person + condition) % 3, 10});
    }
    const std::vector<PairResult> pairs = compare_conditions(seen, Quantity::correct, {});
    REQUIRE(pairs.size() == 3);
    CHECK(pairs[1].a == "x");
    CHECK(pairs[1].b == "z");
    CHECK(pairs[1].higher == "z");
    CHECK(pairs[1].people.df == 7.0);
    CHECK(pairs[1].p_holm >= pairs[1].people.p);
    CHECK_FALSE(pairs[1].replication);
    REQUIRE(pairs[1].bootstrap);
    CHECK(pairs[1].bootstrap->low < pairs[1].people.difference);
}

TEST_CASE("comparisons: people who did only one of two conditions change neither the interval nor which is higher") {
    Observations seen;
    for (const char* name : {"a", "b"}) index_of(name, seen.conditions);
    for (int person = 0; person < 20; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        const int right = person < 10 ? 4 + person % 3 : 9 + person % 2;  // the second ten did a alone, and well
        seen.choices.push_back({0, person, -1, right, 10});
        if (person < 10) seen.choices.push_back({1, person, -1, right + 1 + (person > 2 ? 1 : 0), 10});
    }
    const std::vector<PairResult> pairs = compare_conditions(seen, Quantity::correct, {});
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].people.left_out == 10);
    CHECK(pairs[0].people.difference == close_to(-0.17));
    CHECK(pairs[0].higher == "b");
    REQUIRE(pairs[0].bootstrap);
    CHECK(pairs[0].bootstrap->low < -0.17);
    CHECK(pairs[0].bootstrap->high > -0.17);
    CHECK(pairs[0].bootstrap->high < -0.1);
}

TEST_CASE("comparisons: the bootstrap's interval is of the difference beside it, however much one person did") {
    Observations seen;
    for (const char* name : {"a", "b"}) index_of(name, seen.conditions);
    for (int person = 0; person < 10; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        const bool much = person == 9;
        seen.choices.push_back({0, person, -1, much ? 90 : 1 + person % 3, much ? 100 : 4});
        seen.choices.push_back({1, person, -1, much ? 20 : 1 + (person + 1) % 3, much ? 100 : 4});
    }
    const std::vector<PairResult> pairs = compare_conditions(seen, Quantity::correct, {});
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].people.difference == close_to(0.07));
    REQUIRE(pairs[0].bootstrap);
    CHECK(0.5 * (pairs[0].bootstrap->low + pairs[0].bootstrap->high) == close_to(0.07).epsilon(0.3));
}

TEST_CASE("comparisons: a primary comparison by a permutation that would not keep its level has no p, and says why") {
    Observations seen;
    for (const char* name : {"a", "b"}) index_of(name, seen.conditions);
    for (int person = 0; person < 6; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        seen.rows.push_back({0, person, -1, 0, 4, 0, person == 0 ? 1 : 0});
        seen.rows.push_back({1, person, -1, 0, 2, 2, 0});
    }
    seen.primary = PrimaryComparison{Quantity::ppv, false, {"a", "b"}, "", PrimaryTest::permutation};
    const files::Json primary = report_json(make_report(seen, {}))["primary"];
    CHECK(primary["p"].is_null());
    CHECK(contains(primary["status"].get<std::string>(), "but for the permutation: few false"));
}

TEST_CASE("comparisons: Holm's correction leaves out what is not known") {
    const std::vector<double> corrected = holm_of_known({0.01, std::nan(""), 0.04});
    CHECK(corrected[0] == close_to(0.02));
    CHECK(std::isnan(corrected[1]));
    CHECK(corrected[2] == close_to(0.04));
}

TEST_CASE("comparisons: more pairs than are resampled keep their t test") {
    Observations seen;
    for (int condition = 0; condition < 46; ++condition) index_of("c" + std::to_string(condition), seen.conditions);
    for (int person = 0; person < 3; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        for (int c = 0; c < 46; ++c) seen.rows.push_back({c, person, -1, 0, (c + person * person) % 4, 3, 0});
    }
    const std::vector<PairResult> pairs = compare_conditions(seen, Quantity::sensitivity, {});
    REQUIRE(pairs.size() == 1035);
    CHECK_FALSE(pairs[0].bootstrap);
    CHECK(std::isnan(pairs[0].people.p_permutation));
    CHECK_FALSE(std::isnan(pairs[0].people.p));
}

TEST_CASE("comparisons: of very many people in many pairs the t test alone is computed") {
    CHECK(resamples(1000, 100));
    CHECK_FALSE(resamples(1001, 1));
    CHECK_FALSE(resamples(1000, 101));
    Observations seen;
    for (const char* name : {"a", "b", "c", "d", "e"}) index_of(name, seen.conditions);
    for (int person = 0; person < 10001; ++person) seen.participants.push_back("p" + std::to_string(person));
    for (int condition = 0; condition < 5; ++condition) {
        for (int person = 0; person < 20; ++person)
            seen.rows.push_back({condition, person, -1, 0, (person + condition) % 4, 4, 0});
    }
    const auto pairs = compare_conditions(seen, Quantity::sensitivity, {});
    REQUIRE(pairs.size() == 10);
    CHECK_FALSE(std::isnan(pairs[0].people.p));
    CHECK(std::isnan(pairs[0].people.p_permutation));
    CHECK_FALSE(pairs[0].bootstrap);
}
