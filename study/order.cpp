#include "study/order.h"

#include <algorithm>
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

std::vector<std::size_t> sequence(const Protocol& protocol, const PlannedParticipant& who, int place, int& order_id) {
    const std::size_t n = protocol.groups[who.group].conditions.size();
    if (protocol.order == OrderKind::random) {
        std::vector<std::size_t> row = counted(n);
        Random random(derived_seed(protocol.seed, kOrder, static_cast<std::uint64_t>(who.number)));
        random.shuffle(row);
        order_id = who.number;
        return row;
    }
    // the first row is drawn once for the study, so that the first participants of two studies differ
    std::vector<std::size_t> rows = counted(order_rows(protocol.order, n));
    Random random(derived_seed(protocol.seed, kOrder, 0));
    random.shuffle(rows);
    order_id = place % static_cast<int>(rows.size()) + 1;
    return order_row(protocol.order, n, rows[static_cast<std::size_t>(order_id - 1)]);
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

void add_trial(const Protocol& protocol, PlannedTrial trial, const std::vector<View>& views, PlannedParticipant& who) {
    const std::size_t index = who.trials.size();
    trial.trial = static_cast<int>(index) + 1;
    trial.rotate_deg = views[index % views.size()].rotate_deg;
    trial.flip = views[index % views.size()].flip;
    constexpr std::uint64_t kSeeds = 2000000000;  // seeds of scenes are smaller
    const std::uint64_t of_person = derived_seed(protocol.seed, kTrial, static_cast<std::uint64_t>(who.number));
    trial.seed = static_cast<std::uint32_t>(derived_seed(of_person, kTrial, index) % kSeeds);
    who.trials.push_back(trial);
}

void add_breaks(const Protocol& protocol, PlannedParticipant& who) {
    const int every = protocol.break_every_trials;
    int tests = 0;
    for (PlannedTrial& trial : who.trials) {
        trial.break_before = every > 0 && !trial.practice && tests > 0 && tests % every == 0;
        tests += trial.practice ? 0 : 1;
    }
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
    if (!protocol.choice.alternate_conditions) {
        for (const auto& list : lists) {
            for (const PlannedTrial& trial : list) add_trial(protocol, trial, views, who);
        }
        return;
    }
    for (std::size_t i = 0; i < lists[0].size(); ++i) {
        for (const auto& list : lists) add_trial(protocol, list[i], views, who);
    }
}

// A square table of counts; the conditions of a group are its rows.
class Counts {
  public:
    Counts(std::size_t rows, std::size_t columns) : columns_(columns), counts_(rows * columns) {}
    int& at(std::size_t row, std::size_t column) { return counts_[row * columns_ + column]; }
    // Returns the greatest minus the least count; `diagonal`: whether a row and the column of its number are one of them.
    int spread(bool diagonal) const {
        int most = 0;
        int least = 1 << 30;
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            if (!diagonal && i / columns_ == i % columns_) continue;
            most = std::max(most, counts_[i]);
            least = std::min(least, counts_[i]);
        }
        return most < least ? 0 : most - least;
    }

  private:
    std::size_t columns_;
    std::vector<int> counts_;
};

// Returns the conditions of the tests in the order of their first trials.
std::vector<std::size_t> conditions_of(const Protocol& protocol, const PlannedParticipant& who) {
    std::vector<std::size_t> out;
    std::vector<bool> there(protocol.conditions.size());
    for (const PlannedTrial& trial : who.trials) {
        if (trial.practice || there[trial.condition]) continue;
        there[trial.condition] = true;
        out.push_back(trial.condition);
    }
    return out;
}

}  // namespace

std::vector<std::vector<std::size_t>> latin_square(std::size_t n) { return all_rows(OrderKind::latin, n); }

std::vector<std::vector<std::size_t>> williams_design(std::size_t n) { return all_rows(OrderKind::williams, n); }

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
        add_breaks(protocol, who);
        return who;
    }
    for (const std::size_t condition : conditions) {
        for (int i = 0; i < protocol.practice_trials + protocol.repeats; ++i) {
            PlannedTrial trial;
            trial.practice = i < protocol.practice_trials;
            trial.repeat = trial.practice ? i : i - protocol.practice_trials;
            trial.condition = condition;
            add_trial(protocol, trial, views, who);
        }
    }
    add_breaks(protocol, who);
    return who;
}

std::vector<Imbalance> imbalance_of(const Protocol& protocol, const std::vector<PlannedParticipant>& people) {
    std::vector<Imbalance> out;
    for (std::size_t g = 0; g < protocol.groups.size(); ++g) {
        const auto& conditions = protocol.groups[g].conditions;
        const std::size_t n = conditions.size();
        std::vector<std::size_t> row(protocol.conditions.size());  // of a condition
        for (std::size_t i = 0; i < n; ++i) row[conditions[i]] = i;
        std::vector<std::size_t> views;  // those that are used
        for (std::size_t view = 0; view < 8; ++view) {
            if ((protocol.turn_maps || view % 4 == 0) && (protocol.flip_maps || view < 4)) views.push_back(view);
        }
        Counts positions(n, n), followers(n, n), seen(n, views.size());
        Imbalance imbalance;
        imbalance.group = protocol.groups[g].id;
        imbalance.full_rounds_of = static_cast<int>(order_rows(protocol.order, n));
        for (const PlannedParticipant& who : people) {
            if (who.group != g) continue;
            ++imbalance.participants;
            const std::vector<std::size_t> order = conditions_of(protocol, who);
            for (std::size_t place = 0; place < order.size(); ++place) {
                ++positions.at(row[order[place]], place);
                if (place > 0) ++followers.at(row[order[place - 1]], row[order[place]]);
            }
            for (const PlannedTrial& trial : who.trials) {
                if (trial.practice) continue;
                const auto view = static_cast<std::size_t>(trial.rotate_deg / 90 + (trial.flip ? 4 : 0));
                const auto used = std::find(views.begin(), views.end(), view) - views.begin();
                ++seen.at(row[trial.condition], static_cast<std::size_t>(used));
            }
        }
        imbalance.position = positions.spread(true);
        imbalance.carry_over = followers.spread(false);
        imbalance.turns = seen.spread(true);
        out.push_back(imbalance);
    }
    return out;
}

}  // namespace palpa::study
