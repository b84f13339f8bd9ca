#include <algorithm>
#include <doctest/doctest.h>
#include <map>
#include <set>

#include "study/order.h"

using namespace palpa;
using namespace palpa::study;

namespace {

Protocol protocol_of(std::size_t conditions, OrderKind order) {
    Protocol protocol;
    protocol.order = order;
    protocol.groups.push_back({"all", {}});
    for (std::size_t i = 0; i < conditions; ++i) {
        Condition condition;
        condition.id = std::string(1, static_cast<char>('a' + i));
        protocol.conditions.push_back(condition);
        protocol.groups[0].conditions.push_back(i);
    }
    return protocol;
}

std::vector<PlannedParticipant> people(const Protocol& protocol, int n) {
    std::vector<PlannedParticipant> out;
    for (int i = 1; i <= n; ++i) out.push_back(plan_participant(protocol, i));
    return out;
}

}  // namespace

TEST_CASE("order: squares hold every condition once in each row and, over all rows, as often in each column") {
    for (std::size_t n = 1; n <= 9; ++n) {
        CAPTURE(n);
        for (const auto& design : {latin_square(n), williams_design(n)}) {
            std::map<std::pair<std::size_t, std::size_t>, std::size_t> at;
            for (const auto& row : design) {
                CHECK(std::set<std::size_t>(row.begin(), row.end()).size() == n);
                for (std::size_t c = 0; c < n; ++c) ++at[{row[c], c}];
            }
            CHECK(at.size() == n * n);
            for (const auto& [key, count] : at) CHECK(count == design.size() / n);
        }
    }
}

TEST_CASE("order: in a Williams design every condition follows every other equally often") {
    for (std::size_t n = 2; n <= 9; ++n) {
        CAPTURE(n);
        const auto design = williams_design(n);
        CHECK(design.size() == (n % 2 == 0 ? n : 2 * n));
        std::map<std::pair<std::size_t, std::size_t>, std::size_t> follows;
        for (const auto& row : design) {
            for (std::size_t c = 1; c < n; ++c) ++follows[{row[c - 1], row[c]}];
        }
        CHECK(follows.size() == n * (n - 1));
        for (const auto& [key, count] : follows) CHECK(count == design.size() / n);
    }
}

TEST_CASE("order: it is a function of protocol, seed and number; another seed gives another order") {
    Protocol protocol = protocol_of(6, OrderKind::random);
    const auto orders = [&] {
        std::string out;
        for (const PlannedParticipant& who : people(protocol, 10)) {
            for (const PlannedTrial& trial : who.trials) {
                out += std::to_string(trial.condition) + "," + std::to_string(trial.rotate_deg) + "," +
                       std::to_string(trial.seed) + " ";
            }
        }
        return out;
    };
    const std::string first = orders();
    CHECK(orders() == first);
    protocol.seed = 2;
    CHECK(orders() != first);
    std::set<std::size_t> at_start;
    for (const PlannedParticipant& who : people(protocol, 60)) at_start.insert(who.trials[0].condition);
    CHECK(at_start.size() == 6);
}

TEST_CASE("order: practice comes before the tests of its condition, and no break parts them") {
    Protocol protocol = protocol_of(3, OrderKind::latin);
    protocol.practice_trials = 1;
    protocol.repeats = 2;
    protocol.break_every_trials = 2;
    const PlannedParticipant who = plan_participant(protocol, 5);
    REQUIRE(who.trials.size() == 9);
    int breaks = 0;
    for (std::size_t i = 0; i < 9; ++i) {
        CHECK(who.trials[i].trial == static_cast<int>(i) + 1);
        CHECK(who.trials[i].practice == (i % 3 == 0));
        CHECK(who.trials[i].condition == who.trials[i - i % 3].condition);
        CHECK(who.trials[i].break_before == (i == 3 || i == 6));  // before the practice
        breaks += who.trials[i].break_before;
    }
    CHECK(breaks == 2);
}

TEST_CASE("order: the time to plan grows with the trials, not with their square") {
    Protocol protocol = protocol_of(2, OrderKind::latin);
    protocol.task = TaskKind::choice;
    protocol.choice = {1.75, std::vector<double>(300, 2.0), 1000, true};
    protocol.break_every_trials = 7;
    const PlannedParticipant who = plan_participant(protocol, 1);  // with the square it would take minutes
    REQUIRE(who.trials.size() == 600000);
    CHECK(who.trials[7].break_before);
    CHECK_FALSE(who.trials[8].break_before);
    CHECK(who.trials[599998].break_before);
}

TEST_CASE("order: with random assignment groups differ by no more than a block has of each; the last is not known") {
    Protocol protocol = protocol_of(2, OrderKind::random);
    protocol.groups = {{"x", {0, 1}}, {"y", {0, 1}}};
    protocol.assignment = Assignment::random;
    for (const int of_each : {2, 5}) {
        protocol.people_per_block = of_each;
        int difference = 0;
        int same_pairs = 0;
        std::vector<int> place(2, 0);
        for (int number = 1; number <= 200; ++number) {
            const Membership one = membership_of(protocol, number);
            CHECK(one.place == place[one.group]++);
            difference += one.group == 0 ? 1 : -1;
            CHECK(std::abs(difference) <= of_each);
            if (number % (2 * of_each) == 0) CHECK(difference == 0);
            if (number % 2 == 0) same_pairs += membership_of(protocol, number - 1).group == one.group;
        }
        CHECK(same_pairs > 20);  // 0 in blocks of one person of each group
    }
}

TEST_CASE("order: alternate assignment goes round, random assignment does not") {
    Protocol protocol = protocol_of(4, OrderKind::random);
    protocol.groups = {{"x", {0, 1}}, {"y", {2, 3}}, {"z", {0, 3}}};
    for (const Assignment assignment : {Assignment::alternate, Assignment::random}) {
        protocol.assignment = assignment;
        std::vector<int> size(3, 0);
        std::string sequence;
        for (int number = 1; number <= 100; ++number) {
            const std::size_t group = plan_participant(protocol, number).group;
            ++size[group];
            sequence += std::to_string(group);
            const auto [least, most] = std::minmax_element(size.begin(), size.end());
            CHECK(*most - *least <= (assignment == Assignment::alternate ? 1 : 2));
        }
        CHECK((sequence.substr(0, 9) == "012012012") == (assignment == Assignment::alternate));
    }
}

TEST_CASE("order: forced choices hold every pair in both orders alike, conditions in turn if asked") {
    Protocol protocol = protocol_of(2, OrderKind::latin);
    protocol.task = TaskKind::choice;
    protocol.choice = {1.75, {1.875, 2.0, 2.25, 2.75, 3.75}, 8, true};
    protocol.trial_order = TrialOrder::interleaved;
    const PlannedParticipant who = plan_participant(protocol, 3);
    REQUIRE(who.trials.size() == 80);
    std::map<std::pair<std::size_t, int>, int> first;
    for (std::size_t i = 0; i < 80; ++i) {
        if (i > 0) CHECK(who.trials[i].condition != who.trials[i - 1].condition);
        first[{who.trials[i].condition, who.trials[i].comparison}] += who.trials[i].reference_first ? 1 : -1;
    }
    CHECK(first.size() == 10);
    for (const auto& [key, balance] : first) CHECK(balance == 0);
    CHECK(who.trials[0].condition != plan_participant(protocol, 4).trials[0].condition);
}

TEST_CASE("order: interleaved trials take every condition once in each round, shuffled ones do not") {
    Protocol protocol = protocol_of(4, OrderKind::williams);
    protocol.repeats = 6;
    protocol.practice_trials = 1;
    protocol.trial_order = TrialOrder::interleaved;
    const PlannedParticipant who = plan_participant(protocol, 2);
    REQUIRE(who.trials.size() == 28);
    for (std::size_t i = 0; i < 4; ++i) CHECK(who.trials[i].practice);
    for (std::size_t round = 0; round < 6; ++round) {
        std::set<std::size_t> seen;
        for (std::size_t i = 4 + 4 * round; i < 8 + 4 * round; ++i) {
            seen.insert(who.trials[i].condition);
            CHECK(who.trials[i].repeat == static_cast<int>(round));
            CHECK(who.trials[i].condition != who.trials[i - 1].condition);
        }
        CHECK(seen.size() == 4);
    }
    protocol.trial_order = TrialOrder::shuffled;
    std::map<std::size_t, int> count;
    int same = 0;
    const PlannedParticipant shuffled = plan_participant(protocol, 2);
    for (std::size_t i = 5; i < 28; ++i)
        same += shuffled.trials[i].condition == shuffled.trials[i - 1].condition ? 1 : 0;
    for (const PlannedTrial& trial : shuffled.trials) ++count[trial.condition];
    CHECK(same > 0);
    for (const auto& [condition, n] : count) CHECK(n == 7);
}

TEST_CASE("order: finding, choices and staircases in one session, with practice of each") {
    Protocol protocol = protocol_of(3, OrderKind::fixed);
    protocol.repeats = 2;
    protocol.practice_trials = 2;
    protocol.conditions[1].task = TaskKind::choice;
    protocol.conditions[2].task = TaskKind::staircase;
    protocol.choice = {10.0, {9.0, 14.0}, 2, false};
    protocol.staircase.reference_kPa = 10.0;
    protocol.staircase.comparisons_kPa = {11.0, 12.0, 13.0};
    protocol.staircase.trials = 20;
    const PlannedParticipant who = plan_participant(protocol, 1);
    REQUIRE(who.trials.size() == 2 + 2 + 2 + 4 + 2 + 20);
    CHECK(who.trials[0].comparison == -1);
    CHECK(who.trials[4].practice);
    CHECK(who.trials[4].comparison == 1);  // 14 differs more from 10 than 9 does
    CHECK(who.trials[4].reference_first != who.trials[5].reference_first);
    CHECK(who.trials[6].comparison >= 0);
    CHECK(who.trials[10].comparison == 2);
    int reference_first = 0;
    for (std::size_t i = 12; i < 32; ++i) {
        CHECK(who.trials[i].comparison == -1);  // follows from the answers
        CHECK(who.trials[i].repeat == static_cast<int>(i) - 12);
        reference_first += who.trials[i].reference_first;
    }
    CHECK(reference_first == 10);
}
