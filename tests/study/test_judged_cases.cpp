#include <doctest/doctest.h>

#include "study/judged_cases.h"

using namespace palpa::study;

TEST_CASE("judged cases: a tissue that a person judges again is another case, and unused names are left out") {
    const JudgedCase empty{1, 0, "map", {}, {{2.0}, {}}, true};
    const JudgedCase first{1, 0, "map", {"A"}, {{}, {3.0}}, true};
    JudgedCase again = first, other = first;
    again.reading.ll[0] = kUnmarked;
    other.participant = 2;
    const FreeResponse data = free_response_of({empty, first, again, other}, {"unused", "pen"}, {"01", "unused", "03"});
    CHECK(data.conditions == std::vector<std::string>{"pen"});
    CHECK(data.participants == std::vector<std::string>{"01", "03"});
    REQUIRE(data.cases.size() == 3);
    CHECK(data.cases[1].id == "map");
    CHECK(data.cases[2].id == "map (2)");
    CHECK(data.at(0, 0, 1)->ll[0] == 3.0);
    CHECK(data.at(0, 0, 2)->ll[0] == kUnmarked);
    CHECK(data.at(0, 1, 1).has_value());
    CHECK_FALSE(data.at(0, 1, 2).has_value());
}
