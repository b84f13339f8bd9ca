#include <doctest/doctest.h>
#include <map>
#include <set>
#include <string>

#include "study/order_balance.h"

using namespace palpa::study;

namespace {

Protocol protocol_of_views(std::size_t conditions, OrderKind order, bool flip) {
    Protocol protocol;
    protocol.order = order;
    protocol.flip_maps = flip;
    protocol.groups.push_back({"all", {}});
    for (std::size_t i = 0; i < conditions; ++i) {
        Condition condition;
        condition.id = "c" + std::to_string(i);
        protocol.conditions.push_back(condition);
        protocol.groups[0].conditions.push_back(i);
    }
    return protocol;
}

std::vector<PlannedParticipant> plans(const Protocol& protocol, int n) {
    std::vector<PlannedParticipant> out;
    for (int i = 1; i <= n; ++i) out.push_back(plan_participant(protocol, i));
    return out;
}

}  // namespace

TEST_CASE("views: every condition is tested equally often in every view, in all orders") {
    for (const bool flip : {false, true}) {
        const int views = flip ? 8 : 4;
        for (const OrderKind order : {OrderKind::fixed, OrderKind::random, OrderKind::latin, OrderKind::williams}) {
            for (const TrialOrder trials : {TrialOrder::blocked, TrialOrder::interleaved, TrialOrder::shuffled}) {
                for (const int repeats : {1, 2, 3, 5}) {
                    Protocol protocol = protocol_of_views(3, order, flip);
                    protocol.repeats = repeats;
                    protocol.trial_order = trials;
                    CAPTURE(name_of(order));
                    CAPTURE(name_of(trials));
                    CAPTURE(repeats);
                    CHECK(imbalance_of(protocol, plans(protocol, 3 * views))[0].turns == 0);
                    for (int n = 1; n < views; ++n) CHECK(imbalance_of(protocol, plans(protocol, n))[0].turns <= 2);
                }
            }
        }
    }
}

TEST_CASE("views: a person sees no view twice while another was not seen, and none of the tests in practice") {
    Protocol protocol = protocol_of_views(3, OrderKind::latin, true);
    protocol.practice_trials = 1;
    protocol.repeats = 2;
    for (const PlannedParticipant& who : plans(protocol, 20)) {
        std::set<std::pair<int, bool>> tested;
        std::map<std::size_t, std::set<std::pair<int, bool>>> of_condition;
        for (const PlannedTrial& trial : who.trials) {
            if (trial.practice) continue;
            CHECK(tested.insert({trial.rotate_deg, trial.flip}).second);
            of_condition[trial.condition].insert({trial.rotate_deg, trial.flip});
        }
        for (const PlannedTrial& trial : who.trials) {
            if (trial.practice) CHECK(of_condition[trial.condition].count({trial.rotate_deg, trial.flip}) == 0);
        }
    }
}

TEST_CASE("views: with more tests than views, the same view seldom comes twice in a row") {
    Protocol protocol = protocol_of_views(3, OrderKind::williams, false);
    protocol.repeats = 8;
    int again = 0, pairs = 0;
    for (const PlannedParticipant& who : plans(protocol, 20)) {
        for (std::size_t i = 1; i < who.trials.size(); ++i, ++pairs)
            again += who.trials[i].rotate_deg == who.trials[i - 1].rotate_deg ? 1 : 0;
    }
    MESSAGE(again << " of " << pairs << " trials show the view of the trial before");
    CHECK(again == 0);
}

TEST_CASE("views: maps that are not turned have one view") {
    Protocol protocol = protocol_of_views(2, OrderKind::random, false);
    protocol.turn_maps = false;
    for (const PlannedTrial& trial : plan_participant(protocol, 1).trials)
        CHECK((trial.rotate_deg == 0 && !trial.flip));
}
