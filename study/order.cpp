#include "study/order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/order_views.h"
#include "study/random.h"

namespace palpa::study {
namespace {

enum Purpose : std::uint64_t { kGroups = 1, kOrder = 2, kTurns = 3, kTrial = 4, kRounds = 5, kChoices = 6 };

std::vector<std::size_t> counted(std::size_t n) {
    std::vector<std::size_t> out(n);
    std::iota(out.begin(), out.end(), std::size_t{0});
    return out;
}

// Returns the row of a square, from 0, that this place in a group has. The rows are in a random order, drawn once for the
// study, so that the first participants of two studies differ.
std::size_t row_of(const Protocol& protocol, std::size_t rows, int place) {
    std::vector<std::size_t> order = counted(rows);
    Random random(derived_seed(protocol.seed, kOrder, 0));
    random.shuffle(order);
    return order[static_cast<std::size_t>(place) % rows];
}

// How many rows the order has, and one of them. A participant's row is made alone: a design of 1,000 conditions has a
// million entries.
std::size_t order_rows(OrderKind order, std::size_t n) {
    if (order == OrderKind::latin) return n;
    return order == OrderKind::williams ? (n % 2 == 0 || n == 1 ? n : 2 * n) : 1;
}

std::vector<std::size_t> order_row(OrderKind order, std::size_t n, std::size_t r) {
    std::vector<std::size_t> row = counted(n);
    if (order == OrderKind::latin) {
        for (std::size_t c = 0; c < n; ++c) row[c] = (r + c) % n;
    }
    if (order != OrderKind::williams) return row;
    // the first row 0, 1, n-1, 2, n-2, ... has every difference between neighbours once; the others add 1 to it, and for
    // odd n all follow again in reverse
    for (std::size_t c = 0; c < n; ++c) row[c] = ((c % 2 == 1 ? (c + 1) / 2 : (n - c / 2) % n) + r) % n;
    if (r >= n) std::reverse(row.begin(), row.end());
    return row;
}

std::vector<std::vector<std::size_t>> all_rows(OrderKind order, std::size_t n) {
    std::vector<std::vector<std::size_t>> rows;
    for (std::size_t r = 0; r < order_rows(order, n); ++r) rows.push_back(order_row(order, n, r));
    return rows;
}

// Returns the order of the conditions as places in the group.
std::vector<std::size_t> sequence(const Protocol& protocol, const PlannedParticipant& who, int place, int& order_id) {
    const std::size_t n = protocol.groups[who.group].conditions.size();
    if (protocol.order == OrderKind::random) {
        std::vector<std::size_t> order = counted(n);
        Random random(derived_seed(protocol.seed, kOrder, static_cast<std::uint64_t>(who.number)));
        random.shuffle(order);
        order_id = who.number;
        return order;
    }
    const std::size_t rows = order_rows(protocol.order, n);
    order_id = place % static_cast<int>(rows) + 1;
    return order_row(protocol.order, n, row_of(protocol, rows, place));
}

// Returns all pairs of one condition, `repeats` times, in a random order of the participant's own. Whether the
// reference comes first alternates from repeat to repeat.
std::vector<PlannedTrial> choices_of(const Protocol& protocol, Random& random) {
    std::vector<PlannedTrial> out;
    for (int repeat = 0; repeat < protocol.choice.repeats; ++repeat) {
        for (std::size_t c = 0; c < protocol.choice.comparisons_kPa.size(); ++c) {
            PlannedTrial trial;
            trial.repeat = repeat;
            trial.comparison = static_cast<int>(c);
            // with an odd number of repeats, the order of the last pair is drawn
            const bool odd_one = repeat + 1 == protocol.choice.repeats && repeat % 2 == 0;
            trial.reference_first = odd_one ? random.below(2) == 0 : repeat % 2 == 0;
            out.push_back(trial);
        }
    }
    random.shuffle(out);
    return out;
}

// Returns the pairs of a staircase. The reference comes first in one of every two of them.
std::vector<PlannedTrial> steps_of(const Protocol& protocol, Random& random) {
    std::vector<PlannedTrial> out;
    for (int i = 0; i < protocol.staircase.trials; ++i) {
        PlannedTrial trial;
        trial.repeat = i;
        trial.reference_first = i % 2 == 0 ? random.below(2) == 0 : !out.back().reference_first;
        out.push_back(trial);
    }
    return out;
}

std::vector<PlannedTrial> tests_in(const Protocol& protocol, std::size_t condition, int number) {
    Random random(derived_seed(protocol.seed, kChoices + condition, static_cast<std::uint64_t>(number)));
    std::vector<PlannedTrial> out(static_cast<std::size_t>(protocol.repeats));
    switch (task_of(protocol, condition)) {
        case TaskKind::find:
            for (std::size_t i = 0; i < out.size(); ++i) out[i].repeat = static_cast<int>(i);
            break;
        case TaskKind::choice:
            out = choices_of(protocol, random);
            break;
        case TaskKind::staircase:
            out = steps_of(protocol, random);
            break;
    }
    for (PlannedTrial& trial : out) trial.condition = condition;
    return out;
}

// Practice of a comparison shows the pair whose difference is the greatest, in both orders in turn.
std::vector<PlannedTrial> practice_in(const Protocol& protocol, std::size_t condition) {
    std::vector<PlannedTrial> out(static_cast<std::size_t>(protocol.practice_trials));
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i].practice = true;
        out[i].condition = condition;
        out[i].repeat = static_cast<int>(i);
        if (!compares(task_of(protocol, condition))) continue;
        const double reference_kPa = reference_kPa_of(protocol, condition);
        const std::vector<double>& kPa = comparisons_kPa_of(protocol, condition);
        const auto less_unlike = [&](double a, double b) {
            return std::abs(std::log(a / reference_kPa)) < std::abs(std::log(b / reference_kPa));
        };
        out[i].comparison = static_cast<int>(std::max_element(kPa.begin(), kPa.end(), less_unlike) - kPa.begin());
        out[i].reference_first = i % 2 == 0;
    }
    return out;
}

// Returns the order of the conditions in the next round of interleaved trials, as places in the group. `before`: the
// order of the round before.
//
// In a Williams design each round is a row of the design. Rows are chosen so that the step from the last condition of a
// round to the first of the next one runs through all differences in turn, as the steps within a row do; the same row
// again would make one step nearly twice as frequent as the others.
std::vector<std::size_t> next_round(const Protocol& protocol, int round, const std::vector<std::size_t>& before,
                                    Random& random) {
    const std::size_t n = before.size();
    std::vector<std::size_t> out = before;
    if (n < 2) return out;
    if (protocol.order == OrderKind::williams) {
        const std::size_t step = 1 + static_cast<std::size_t>(round - 1) % (n - 1);
        const std::size_t shift = before.back() + step + n - before.front();
        for (std::size_t& entry : out) entry = (entry + shift) % n;
    } else if (protocol.order == OrderKind::random) {
        random.shuffle(out);
        if (out.front() == before.back())
            std::swap(out.front(), out[1 + random.below(static_cast<std::uint32_t>(n - 1))]);
    }
    return out;
}

// Merges the tests of all conditions. `lists`: by place in the group.
std::vector<PlannedTrial> interleaved(const Protocol& protocol, const PlannedParticipant& who,
                                      std::vector<std::size_t> order,
                                      const std::vector<std::vector<PlannedTrial>>& lists) {
    std::vector<PlannedTrial> out;
    Random random(derived_seed(protocol.seed, kRounds, static_cast<std::uint64_t>(who.number)));
    std::size_t rounds = 0;
    for (const auto& list : lists) rounds = std::max(rounds, list.size());
    for (std::size_t round = 0; round < rounds; ++round) {
        if (round > 0) order = next_round(protocol, static_cast<int>(round), order, random);
        for (const std::size_t at : order) {
            if (round < lists[at].size()) out.push_back(lists[at][round]);
        }
    }
    return out;
}

// A staircase goes on in the order of its repeats, whatever the order of the trials.
void put_repeats_in_order(std::vector<PlannedTrial>& tests, std::size_t conditions) {
    std::vector<int> next(conditions, 0);
    for (PlannedTrial& trial : tests) {
        if (trial.comparison < 0) trial.repeat = next[trial.condition]++;
    }
}

std::vector<PlannedTrial> trials_in_order(const Protocol& protocol, const PlannedParticipant& who,
                                          const std::vector<std::size_t>& order) {
    const std::vector<std::size_t>& conditions = protocol.groups[who.group].conditions;
    std::vector<PlannedTrial> out;
    std::vector<std::vector<PlannedTrial>> lists(conditions.size());
    const bool in_turn = protocol.trial_order == TrialOrder::interleaved;
    const bool blocked = protocol.trial_order == TrialOrder::blocked;
    const auto add = [&](const std::vector<PlannedTrial>& trials) {
        out.insert(out.end(), trials.begin(), trials.end());
    };
    for (const std::size_t at : order) {
        lists[at] = tests_in(protocol, conditions[at], who.number);
        add(practice_in(protocol, conditions[at]));
        if (blocked) add(lists[at]);
    }
    if (blocked) return out;
    std::vector<PlannedTrial> tests;
    if (in_turn) {
        tests = interleaved(protocol, who, order, lists);
    } else {
        for (const auto& list : lists) tests.insert(tests.end(), list.begin(), list.end());
        Random random(derived_seed(protocol.seed, kRounds, static_cast<std::uint64_t>(who.number)));
        random.shuffle(tests);
        put_repeats_in_order(tests, protocol.conditions.size());
    }
    add(tests);
    return out;
}

// Numbers the trials and gives each its seed. A break follows a test, so that practice and the tests that it prepares
// stay together.
void number_trials(const Protocol& protocol, PlannedParticipant& who) {
    const std::uint64_t of_person = derived_seed(protocol.seed, kTrial, static_cast<std::uint64_t>(who.number));
    constexpr std::uint64_t kSeeds = 2000000000;  // seeds of scenes are smaller
    const int every = protocol.break_every_trials;
    int tests = 0;
    for (std::size_t i = 0; i < who.trials.size(); ++i) {
        PlannedTrial& trial = who.trials[i];
        trial.trial = static_cast<int>(i) + 1;
        trial.seed = static_cast<std::uint32_t>(derived_seed(of_person, kTrial, i) % kSeeds);
        const bool after_test = i > 0 && !who.trials[i - 1].practice;
        trial.break_before = every > 0 && after_test && tests % every == 0;
        tests += trial.practice ? 0 : 1;
    }
}

}  // namespace

std::vector<std::vector<std::size_t>> latin_square(std::size_t n) { return all_rows(OrderKind::latin, n); }

std::vector<std::vector<std::size_t>> williams_design(std::size_t n) { return all_rows(OrderKind::williams, n); }

Membership membership_of(const Protocol& protocol, int number) {
    const std::size_t groups = protocol.groups.size();
    const auto index = static_cast<std::size_t>(number - 1);
    if (protocol.assignment == Assignment::alternate) return {index % groups, static_cast<int>(index / groups)};
    const auto of_each = static_cast<std::size_t>(protocol.people_per_block);
    std::vector<std::size_t> block;
    for (std::size_t i = 0; i < groups * of_each; ++i) block.push_back(i % groups);
    Random random(derived_seed(protocol.seed, kGroups, index / block.size()));
    random.shuffle(block);
    const auto at = block.begin() + static_cast<std::ptrdiff_t>(index % block.size());
    const std::size_t before = index / block.size() * of_each;
    return {*at, static_cast<int>(before) + static_cast<int>(std::count(block.begin(), at, *at))};
}

int tests_of(const Protocol& protocol, std::size_t condition) {
    switch (task_of(protocol, condition)) {
        case TaskKind::choice:
            return protocol.choice.repeats * static_cast<int>(protocol.choice.comparisons_kPa.size());
        case TaskKind::staircase:
            return protocol.staircase.trials;
        case TaskKind::find:
            break;
    }
    return protocol.repeats;
}

PlannedParticipant plan_participant(const Protocol& protocol, int number) {
    PlannedParticipant who;
    who.number = number;
    const Membership membership = membership_of(protocol, number);
    who.group = membership.group;
    const std::vector<std::size_t> order = sequence(protocol, who, membership.place, who.order_id);
    who.trials = trials_in_order(protocol, who, order);
    number_trials(protocol, who);
    give_views(protocol, membership.place, derived_seed(protocol.seed, kTurns, 0), who);
    return who;
}

}  // namespace palpa::study
