#include <doctest/doctest.h>

#include "study/comparisons.h"
#include "study/follow_protocol.h"
#include "tests/close_to.h"

using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("follow protocol: signs of a - b follow its order of conditions, not the first log that was read") {
    Observations seen;
    for (const char* name : {"off", "other", "law"}) index_of(name, seen.conditions);
    for (const char* name : {"p", "q"}) index_of(name, seen.participants);
    for (int person = 0; person < 2; ++person) {
        seen.rows.push_back({0, person, -1, 0, person, 2 - person, 0});
        seen.rows.push_back({2, person, -1, 0, 2, 0, 0});
    }
    seen.stiffer.push_back({0, 0, StiffnessAxis::second_first, 0.5, 1, 1});
    Protocol protocol;
    for (const char* id : {"law", "unused", "off"}) {
        protocol.conditions.emplace_back();
        protocol.conditions.back().id = id;
    }
    for (const char* id : {"I", "II"}) protocol.groups.push_back({id, {}});
    Person p, q;
    p.code = "p";
    p.group = "II";
    q.code = "q";
    q.group = "I";
    take_groups({q, p}, seen);
    CHECK(seen.groups == std::vector<std::string>{"II", "I"});
    follow_protocol(protocol, seen);
    CHECK(seen.conditions == std::vector<std::string>{"law", "off", "other"});
    CHECK(seen.stiffer[0].condition == 1);
    CHECK(seen.groups == std::vector<std::string>{"I", "II"});
    CHECK(seen.group_of == std::vector<int>{1, 0});
    const auto pairs = compare_conditions(seen, Quantity::sensitivity, {});
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].a == "law");
    CHECK(pairs[0].people.difference == close_to(0.75));
}
