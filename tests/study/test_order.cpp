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

TEST_CASE("order: full rounds are balanced, others say by how much they are not") {
    Protocol protocol = protocol_of(3, OrderKind::williams);
    const Imbalance full = imbalance_of(protocol, people(protocol, 12))[0];
    CHECK(full.position == 0);
    CHECK(full.carry_over == 0);
    CHECK(full.full_rounds_of == 6);
    const Imbalance short_of = imbalance_of(protocol, people(protocol, 7))[0];
    CHECK(short_of.position == 1);
    CHECK(short_of.participants == 7);
    protocol.order = OrderKind::fixed;
    CHECK(imbalance_of(protocol, people(protocol, 7))[0].position == 7);
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

TEST_CASE("order: a participant sees every view before one comes again, and practice comes first") {
    Protocol protocol = protocol_of(3, OrderKind::latin);
    protocol.flip_maps = true;
    protocol.practice_trials = 1;
    protocol.repeats = 2;
    protocol.break_every_trials = 2;
    const PlannedParticipant who = plan_participant(protocol, 5);
    REQUIRE(who.trials.size() == 9);
    std::set<std::pair<int, bool>> seen;
    for (std::size_t i = 0; i < 8; ++i) seen.insert({who.trials[i].rotate_deg, who.trials[i].flip});
    CHECK(seen.size() == 8);
    int breaks = 0;
    for (std::size_t i = 0; i < 9; ++i) {
        CHECK(who.trials[i].trial == static_cast<int>(i) + 1);
        CHECK(who.trials[i].practice == (i % 3 == 0));
        CHECK(who.trials[i].condition == who.trials[i - i % 3].condition);
        breaks += who.trials[i].break_before;
    }
    CHECK(breaks == 2);
    protocol.turn_maps = protocol.flip_maps = false;
    for (const PlannedTrial& trial : plan_participant(protocol, 1).trials)
        CHECK((trial.rotate_deg == 0 && !trial.flip));
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

TEST_CASE("order: groups never differ by more than one person; random ones are shuffled in blocks") {
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
            CHECK(*std::max_element(size.begin(), size.end()) - *std::min_element(size.begin(), size.end()) <= 1);
        }
        CHECK((sequence.substr(0, 9) == "012012012") == (assignment == Assignment::alternate));
    }
}

TEST_CASE("order: forced choices hold every pair in both orders alike, conditions in turn if asked") {
    Protocol protocol = protocol_of(2, OrderKind::latin);
    protocol.task = TaskKind::choice;
    protocol.choice = {1.75, {1.875, 2.0, 2.25, 2.75, 3.75}, 8, true};
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
