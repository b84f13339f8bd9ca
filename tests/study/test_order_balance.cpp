#include <doctest/doctest.h>
#include <string>

#include "study/order_balance.h"

using namespace palpa::study;

namespace {

Protocol protocol_with(std::size_t conditions, OrderKind order) {
    Protocol protocol;
    protocol.order = order;
    protocol.groups.push_back({"all", {}});
    for (std::size_t i = 0; i < conditions; ++i) {
        Condition condition;
        condition.id = "c" + std::to_string(i);
        protocol.conditions.push_back(condition);
        protocol.groups[0].conditions.push_back(i);
    }
    return protocol;
}

Imbalance imbalance_with(const Protocol& protocol, int n) {
    std::vector<PlannedParticipant> people;
    for (int i = 1; i <= n; ++i) people.push_back(plan_participant(protocol, i));
    return imbalance_of(protocol, people)[0];
}

}  // namespace

TEST_CASE("balance: full rounds are balanced, others say by how much they are not") {
    Protocol protocol = protocol_with(3, OrderKind::williams);
    const Imbalance full = imbalance_with(protocol, 12);
    CHECK(full.position == 0);
    CHECK(full.carry_over == 0);
    CHECK(full.turns == 0);
    CHECK(full.full_rounds_of == 6);
    const Imbalance short_of = imbalance_with(protocol, 7);
    CHECK(short_of.position == 1);
    CHECK(short_of.participants == 7);
    protocol.order = OrderKind::fixed;
    CHECK(imbalance_with(protocol, 7).position == 7);
}

TEST_CASE("balance: carry-over is counted over trials, not over conditions") {
    Protocol protocol = protocol_with(3, OrderKind::latin);
    protocol.repeats = 8;
    CHECK(imbalance_with(protocol, 3).carry_over == 2);  // blocks: two of three rows have a before b, none b before a
    protocol.trial_order = TrialOrder::interleaved;
    // over three people a stands directly before b 8 + 8 + 7 times, and never b before a
    CHECK(imbalance_with(protocol, 3).carry_over == 23);
}

TEST_CASE("balance: the rows of a Williams design stay balanced when trials are interleaved") {
    for (std::size_t n = 2; n <= 7; ++n) {
        CAPTURE(n);
        Protocol protocol = protocol_with(n, OrderKind::williams);
        protocol.repeats = 8;
        protocol.trial_order = TrialOrder::interleaved;
        const int rows = static_cast<int>(n % 2 == 0 ? n : 2 * n);
        CHECK(imbalance_with(protocol, rows).carry_over <= rows);
        protocol.repeats = static_cast<int>(n);  // n - 1 steps between rounds: each difference once
        const int at_full = imbalance_with(protocol, rows).carry_over;
        CHECK(at_full == 0);
    }
}

TEST_CASE("balance: conditions without a view, or with other numbers of tests, disturb nobody") {
    Protocol protocol = protocol_with(2, OrderKind::williams);
    protocol.repeats = 4;
    protocol.conditions[1].task = TaskKind::choice;
    protocol.choice = {10.0, {12.0}, 3, false};
    CHECK(imbalance_with(protocol, 4).turns == 0);
}
