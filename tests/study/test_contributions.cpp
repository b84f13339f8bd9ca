#include <doctest/doctest.h>
#include <vector>

#include "study/contributions.h"
#include "study/rows_by_condition.h"

using namespace palpa::study;

namespace {

Observations two_people() {
    Observations seen;
    index_of("x", seen.conditions);
    for (const char* name : {"p", "q"}) index_of(name, seen.participants);
    seen.rows.push_back({0, 0, 0, 0, 1, 0, 0});
    seen.rows.push_back({0, 0, 1, 0, 0, 1, 0});
    seen.rows.push_back({0, 0, -1, 0, 0, 0, 2});
    return seen;
}

}  // namespace

TEST_CASE("contributions: hits of nodules and of marks; nothing for who was not there") {
    const Observations seen = two_people();
    const People found = people_of(seen, 0, Quantity::sensitivity);
    REQUIRE(found.size() == 2);
    CHECK(found[0]->k == 1);
    CHECK(found[0]->n == 2);
    CHECK_FALSE(found[1]);
    CHECK(people_of(seen, 0, Quantity::sensitivity, 1)[0]->n == 1);
    CHECK(people_by_condition(seen, Quantity::ppv)[0][0]->n == 3);
    CHECK(people_of(seen, 0, Quantity::correct).empty());
}

TEST_CASE("contributions: somebody without marks took part; a row without a name leaves all unknown") {
    Observations seen = two_people();
    seen.rows.push_back({0, 1, -1, 0, 0, 3, 0});
    const People marked = people_of(seen, 0, Quantity::ppv);
    REQUIRE(marked[1]);
    CHECK(marked[1]->n == 0);
    seen.rows.push_back({0, -1, -1, 0, 1, 0, 0});
    CHECK(people_of(seen, 0, Quantity::ppv).empty());
}

TEST_CASE("contributions: the rows of one group") {
    Observations seen = two_people();
    seen.rows.push_back({0, 1, -1, 0, 0, 3, 0});
    for (const char* name : {"I", "II"}) index_of(name, seen.groups);
    seen.group_of = {0, 1};
    seen.stiffer.push_back({0, 1, StiffnessAxis::second_first, 0.5, 1, 1});
    seen.progress.push_back({"p", "I", "x", 3});
    seen.exclusions.push_back({"q", std::nullopt, "ill"});
    const Observations one = only_group(seen, 0), two = only_group(seen, 1);
    CHECK(one.rows.size() == 3);
    CHECK(two.rows.size() == 1);
    CHECK(one.stiffer.empty());
    CHECK(two.stiffer.size() == 1);
    CHECK(one.progress.size() == 1);
    CHECK(two.progress.empty());
    CHECK(one.exclusions.empty());
    CHECK(two.exclusions.size() == 1);
}

TEST_CASE("contributions: of sorted rows, those who took part are summed as among all rows") {
    Observations seen = two_people();
    for (const char* name : {"r", "s"}) index_of(name, seen.participants);
    seen.rows.push_back({0, 3, 0, 0, 0, 1, 0});
    seen.rows.push_back({0, 1, -1, 0, 0, 3, 1});
    seen.choices = {{0, 3, 1, 1, 2}, {0, 0, 0, 2, 2}, {0, 3, 0, 1, 1}};
    sort_rows(seen);
    for (const Quantity quantity : {Quantity::sensitivity, Quantity::ppv, Quantity::correct}) {
        for (const int item : {-1, 0, 1}) {
            CAPTURE(item);
            std::vector<Contribution> expected, found;
            for (const auto& one : people_of(seen, 0, quantity, item)) {
                if (one) expected.push_back(*one);
            }
            for (const auto& one : people_who_took_part(seen, 0, quantity, item)) found.push_back(*one);
            REQUIRE(found.size() == expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                CHECK(found[i].k == expected[i].k);
                CHECK(found[i].n == expected[i].n);
            }
        }
    }
}
