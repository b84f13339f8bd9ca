#include "study/order_balance.h"

#include <algorithm>

namespace palpa::study {
namespace {

// Counts in rows of equal length.
struct Counts {
    std::size_t columns = 0;
    std::vector<int> cells;
    Counts(std::size_t rows, std::size_t n) : columns(n), cells(rows * n, 0) {}
    int& at(std::size_t row, std::size_t column) { return cells[row * columns + column]; }
};

int spread_of_counts(const std::vector<int>& counts) {
    if (counts.empty()) return 0;
    const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
    return *most - *least;
}

// Returns the conditions of the tests, as places in the group, in the order of their first trials.
std::vector<std::size_t> first_places(const PlannedParticipant& who, const std::vector<std::size_t>& place) {
    std::vector<std::size_t> out;
    std::vector<bool> seen(place.size(), false);
    for (const PlannedTrial& trial : who.trials) {
        if (trial.practice || seen[trial.condition]) continue;
        seen[trial.condition] = true;
        out.push_back(place[trial.condition]);
    }
    return out;
}

// Greatest minus least count of one condition after another, without a condition after itself.
int carry_over_of(Counts& followers, std::size_t n) {
    std::vector<int> others;
    for (std::size_t a = 0; a < n; ++a) {
        for (std::size_t b = 0; b < n; ++b) {
            if (a != b) others.push_back(followers.at(a, b));
        }
    }
    return spread_of_counts(others);
}

bool has_views(const Protocol& protocol, std::size_t condition) {
    return !protocol.conditions[condition].scene.empty();
}

// Conditions may differ in their numbers of tests, so each is compared with itself.
int turns_of(const Protocol& protocol, const std::vector<std::size_t>& conditions, Counts& views) {
    int most = 0;
    for (std::size_t c = 0; c < conditions.size(); ++c) {
        if (!has_views(protocol, conditions[c])) continue;
        std::vector<int> used;
        for (std::size_t view = 0; view < views.columns; ++view) {
            if ((protocol.turn_maps || view % 4 == 0) && (protocol.flip_maps || view < 4))
                used.push_back(views.at(c, view));
        }
        most = std::max(most, spread_of_counts(used));
    }
    return most;
}

int rows_of(OrderKind order, TrialOrder trials, std::size_t n) {
    if (trials == TrialOrder::shuffled) return 1;  // whatever the order of the conditions
    if (order == OrderKind::latin) return static_cast<int>(n);
    if (order == OrderKind::williams) return static_cast<int>(n % 2 == 0 || n == 1 ? n : 2 * n);
    return 1;
}

Imbalance imbalance_of_group(const Protocol& protocol, std::size_t group,
                             const std::vector<PlannedParticipant>& people) {
    const std::vector<std::size_t>& conditions = protocol.groups[group].conditions;
    const std::size_t n = conditions.size();
    std::vector<std::size_t> place(protocol.conditions.size(), 0);
    for (std::size_t i = 0; i < n; ++i) place[conditions[i]] = i;
    Counts positions(n, n), followers(n, n), views(n, 8);
    Imbalance out;
    out.group = protocol.groups[group].id;
    out.full_rounds_of = rows_of(protocol.order, protocol.trial_order, n);
    for (const PlannedParticipant& who : people) {
        if (who.group != group) continue;
        ++out.participants;
        const std::vector<std::size_t> order = first_places(who, place);
        for (std::size_t i = 0; i < order.size(); ++i) ++positions.at(order[i], i);
        const PlannedTrial* before = nullptr;
        for (const PlannedTrial& trial : who.trials) {
            if (trial.practice) continue;
            const auto view = static_cast<std::size_t>(trial.rotate_deg / 90 + (trial.flip ? 4 : 0));
            ++views.at(place[trial.condition], view);
            if (before != nullptr) ++followers.at(place[before->condition], place[trial.condition]);
            before = &trial;
        }
    }
    out.position = spread_of_counts(positions.cells);
    out.carry_over = carry_over_of(followers, n);
    out.turns = turns_of(protocol, conditions, views);
    return out;
}

}  // namespace

std::vector<Imbalance> imbalance_of(const Protocol& protocol, const std::vector<PlannedParticipant>& people) {
    std::vector<Imbalance> out;
    for (std::size_t group = 0; group < protocol.groups.size(); ++group)
        out.push_back(imbalance_of_group(protocol, group, people));
    return out;
}

}  // namespace palpa::study
