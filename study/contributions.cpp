#include "study/contributions.h"

#include <algorithm>

namespace palpa::study {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// The participants of one condition, while rows are added.
struct Adding {
    People people;
    bool all_named = true;

    void add(std::size_t participants, int participant, const Contribution& part) {
        if (participant < 0) {
            all_named = false;
            return;
        }
        people.resize(participants);
        auto& one = people[at(participant)];
        if (!one) one.emplace();
        one->k += part.k;
        one->n += part.n;
    }
    People result() && { return all_named ? std::move(people) : People{}; }
};

// Calls take(condition, item, participant, contribution) for each row.
template <class Take>
void each_row(const Observations& seen, Quantity quantity, const Take& take) {
    if (quantity == Quantity::correct) {
        for (const Choices& row : seen.choices)
            take(row.condition, row.comparison, row.participant, Contribution{row.correct, row.n});
        return;
    }
    for (const Observation& row : seen.rows) {
        const std::int64_t others = quantity == Quantity::sensitivity ? row.fn : row.fp;
        take(row.condition, row.nodule, row.participant, Contribution{row.tp, row.tp + others});
    }
}

}  // namespace

People people_of(const Observations& seen, int condition, Quantity quantity, int item) {
    Adding adding;
    each_row(seen, quantity, [&](int c, int i, int participant, const Contribution& part) {
        if (c == condition && (item < 0 || i == item)) adding.add(seen.participants.size(), participant, part);
    });
    return std::move(adding).result();
}

std::vector<People> people_by_condition(const Observations& seen, Quantity quantity) {
    std::vector<Adding> adding(seen.conditions.size());
    each_row(seen, quantity, [&](int c, int, int participant, const Contribution& part) {
        adding[at(c)].add(seen.participants.size(), participant, part);
    });
    std::vector<People> all;
    for (Adding& one : adding) all.push_back(std::move(one).result());
    return all;
}

Observations only_group(const Observations& seen, int group) {
    Observations out = seen;
    const auto other = [&](const auto& row) {
        return row.participant < 0 || seen.group_of[at(row.participant)] != group;
    };
    std::erase_if(out.rows, other);
    std::erase_if(out.trials, other);
    std::erase_if(out.choices, other);
    std::erase_if(out.answers, other);
    return out;
}

}  // namespace palpa::study
