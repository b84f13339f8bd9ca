#include "study/order.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "study/random.h"

namespace palpa::study {
namespace {

enum Purpose : std::uint64_t { kGroups = 1, kOrder = 2, kTurns = 3, kTrial = 4, kChoices = 5 };

std::vector<std::size_t> counted(std::size_t n) {
    std::vector<std::size_t> out(n);
    std::iota(out.begin(), out.end(), std::size_t{0});
    return out;
}

// Groups come in blocks with each group once, so that their sizes never differ by more than one person.
std::size_t group_of(const Protocol& protocol, int number) {
    const std::size_t groups = protocol.groups.size();
    const auto index = static_cast<std::size_t>(number - 1);
    if (protocol.assignment == Assignment::alternate) return index % groups;
    Random random(derived_seed(protocol.seed, kGroups, index / groups));
    std::vector<std::size_t> block = counted(groups);
    random.shuffle(block);
    return block[index % groups];
}

// The participant's number within the group, from 0.
int place_in_group(const Protocol& protocol, int number) {
    return (number - 1) / static_cast<int>(protocol.groups.size());  // blocks hold each group once
}

std::vector<std::size_t> sequence(const Protocol& protocol, const PlannedParticipant& who, int place, int& order_id) {
    const std::size_t n = protocol.groups[who.group].conditions.size();
    std::vector<std::vector<std::size_t>> rows{counted(n)};
    switch (protocol.order) {
        case OrderKind::fixed:
            break;
        case OrderKind::latin:
            rows = latin_square(n);
            break;
        case OrderKind::williams:
            rows = williams_design(n);
            break;
        case OrderKind::random: {
            Random random(derived_seed(protocol.seed, kOrder, static_cast<std::uint64_t>(who.number)));
            random.shuffle(rows[0]);
            order_id = who.number;
            return rows[0];
        }
    }
    // the first row is drawn once for the study, so that the first participants of two studies differ
    Random random(derived_seed(protocol.seed, kOrder, 0));
    random.shuffle(rows);
    order_id = place % static_cast<int>(rows.size()) + 1;
    return rows[static_cast<std::size_t>(order_id - 1)];
}

struct View {
    int rotate_deg = 0;
    bool flip = false;
};

// Returns all views in a random order of the participant's own. Trials, practice included, use them in turn, so that no
// view repeats before all were shown.
std::vector<View> views_of(const Protocol& protocol, int number) {
    std::vector<View> views{{0, false}};
    if (protocol.turn_maps) views = {{0, false}, {90, false}, {180, false}, {270, false}};
    if (protocol.flip_maps) {
        const std::size_t n = views.size();
        for (std::size_t i = 0; i < n; ++i) views.push_back({views[i].rotate_deg, true});
    }
    Random random(derived_seed(protocol.seed, kTurns, static_cast<std::uint64_t>(number)));
    random.shuffle(views);
    return views;
}

// tests: how many of the trials so far are no practice.
void add_trial(const Protocol& protocol, PlannedTrial trial, const std::vector<View>& views, int& tests,
               PlannedParticipant& who) {
    const std::size_t index = who.trials.size();
    trial.trial = static_cast<int>(index) + 1;
    trial.rotate_deg = views[index % views.size()].rotate_deg;
    trial.flip = views[index % views.size()].flip;
    constexpr std::uint64_t kSeeds = 2000000000;  // seeds of scenes are smaller
    const std::uint64_t of_person = derived_seed(protocol.seed, kTrial, static_cast<std::uint64_t>(who.number));
    trial.seed = static_cast<std::uint32_t>(derived_seed(of_person, kTrial, index) % kSeeds);
    const int every = protocol.break_every_trials;
    trial.break_before = every > 0 && !trial.practice && tests > 0 && tests % every == 0;
    tests += trial.practice ? 0 : 1;
    who.trials.push_back(trial);
}

// Returns all pairs of one condition, `repeats` times, in a random order of the participant's own. Whether the
// reference comes first alternates from repeat to repeat.
std::vector<PlannedTrial> choices_of(const Protocol& protocol, std::size_t condition, int number) {
    std::vector<PlannedTrial> out;
    Random random(derived_seed(protocol.seed, kChoices + condition, static_cast<std::uint64_t>(number)));
    for (int repeat = 0; repeat < protocol.choice.repeats; ++repeat) {
        for (std::size_t c = 0; c < protocol.choice.comparisons_kPa.size(); ++c) {
            PlannedTrial trial;
            trial.condition = condition;
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

void add_choices(const Protocol& protocol, const std::vector<std::size_t>& conditions, const std::vector<View>& views,
                 PlannedParticipant& who) {
    std::vector<std::vector<PlannedTrial>> lists;
    for (const std::size_t condition : conditions) lists.push_back(choices_of(protocol, condition, who.number));
    int tests = 0;
    if (!protocol.choice.alternate_conditions) {
        for (const auto& list : lists) {
            for (const PlannedTrial& trial : list) add_trial(protocol, trial, views, tests, who);
        }
        return;
    }
    for (std::size_t i = 0; i < lists[0].size(); ++i) {
        for (const auto& list : lists) add_trial(protocol, list[i], views, tests, who);
    }
}

template <class Key>
int spread(const std::map<Key, int>& counts) {
    int most = 0;
    int least = 1 << 30;
    for (const auto& [key, count] : counts) {
        most = std::max(most, count);
        least = std::min(least, count);
    }
    return counts.empty() ? 0 : most - least;
}

// Returns the conditions of the tests in the order of their first trials.
std::vector<std::size_t> conditions_of(const PlannedParticipant& who) {
    std::vector<std::size_t> out;
    for (const PlannedTrial& trial : who.trials) {
        if (!trial.practice && std::find(out.begin(), out.end(), trial.condition) == out.end())
            out.push_back(trial.condition);
    }
    return out;
}

int rows_of(const Protocol& protocol, std::size_t n) {
    switch (protocol.order) {
        case OrderKind::latin:
            return static_cast<int>(n);
        case OrderKind::williams:
            return static_cast<int>(williams_design(n).size());
        case OrderKind::fixed:
        case OrderKind::random:
            break;
    }
    return 1;
}

}  // namespace

std::vector<std::vector<std::size_t>> latin_square(std::size_t n) {
    std::vector<std::vector<std::size_t>> rows(n, std::vector<std::size_t>(n));
    for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t c = 0; c < n; ++c) rows[r][c] = (r + c) % n;
    }
    return rows;
}

std::vector<std::vector<std::size_t>> williams_design(std::size_t n) {
    // the first row 0, 1, n-1, 2, n-2, ... has every difference between neighbours once; the others add 1 to it
    std::vector<std::size_t> first(n);
    for (std::size_t c = 0; c < n; ++c) first[c] = c % 2 == 1 ? (c + 1) / 2 : (n - c / 2) % n;
    std::vector<std::vector<std::size_t>> rows;
    for (std::size_t r = 0; r < n; ++r) {
        std::vector<std::size_t> row;
        for (const std::size_t entry : first) row.push_back((entry + r) % n);
        rows.push_back(row);
    }
    if (n % 2 == 0 || n == 1) return rows;
    for (std::size_t r = 0; r < n; ++r) rows.emplace_back(rows[r].rbegin(), rows[r].rend());
    return rows;
}

PlannedParticipant plan_participant(const Protocol& protocol, int number) {
    PlannedParticipant who;
    who.number = number;
    who.group = group_of(protocol, number);
    std::vector<std::size_t> conditions;
    for (const std::size_t place : sequence(protocol, who, place_in_group(protocol, number), who.order_id)) {
        conditions.push_back(protocol.groups[who.group].conditions[place]);
    }
    const std::vector<View> views = views_of(protocol, number);
    if (protocol.task == TaskKind::choice) {
        add_choices(protocol, conditions, views, who);
        return who;
    }
    int tests = 0;
    for (const std::size_t condition : conditions) {
        for (int i = 0; i < protocol.practice_trials + protocol.repeats; ++i) {
            PlannedTrial trial;
            trial.practice = i < protocol.practice_trials;
            trial.repeat = trial.practice ? i : i - protocol.practice_trials;
            trial.condition = condition;
            add_trial(protocol, trial, views, tests, who);
        }
    }
    return who;
}

std::vector<Imbalance> imbalance_of(const Protocol& protocol, const std::vector<PlannedParticipant>& people) {
    std::vector<Imbalance> out;
    for (std::size_t g = 0; g < protocol.groups.size(); ++g) {
        const auto& conditions = protocol.groups[g].conditions;
        std::map<std::pair<std::size_t, std::size_t>, int> positions, followers;
        std::map<std::pair<std::size_t, int>, int> views;
        for (const std::size_t a : conditions) {
            for (std::size_t place = 0; place < conditions.size(); ++place) positions[{a, place}] = 0;
            for (const std::size_t b : conditions) {
                if (a != b) followers[{a, b}] = 0;
            }
            for (int view = 0; view < 8; ++view) {
                const bool used = (protocol.turn_maps || view % 4 == 0) && (protocol.flip_maps || view < 4);
                if (used) views[{a, view}] = 0;
            }
        }
        Imbalance imbalance;
        imbalance.group = protocol.groups[g].id;
        imbalance.full_rounds_of = rows_of(protocol, conditions.size());
        for (const PlannedParticipant& who : people) {
            if (who.group != g) continue;
            ++imbalance.participants;
            const std::vector<std::size_t> order = conditions_of(who);
            for (std::size_t place = 0; place < order.size(); ++place) {
                ++positions[{order[place], place}];
                if (place > 0) ++followers[{order[place - 1], order[place]}];
            }
            for (const PlannedTrial& trial : who.trials) {
                if (!trial.practice) ++views[{trial.condition, trial.rotate_deg / 90 + (trial.flip ? 4 : 0)}];
            }
        }
        imbalance.position = spread(positions);
        imbalance.carry_over = spread(followers);
        imbalance.turns = spread(views);
        out.push_back(imbalance);
    }
    return out;
}

}  // namespace palpa::study
