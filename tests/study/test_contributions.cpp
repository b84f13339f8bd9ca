#include <doctest/doctest.h>

#include "study/contributions.h"

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
    CHECK(only_group(seen, 0).rows.size() == 3);
    CHECK(only_group(seen, 1).rows.size() == 1);
}
