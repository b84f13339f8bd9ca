#include "study/contributions.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "study/rows_by_condition.h"

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

Contribution part_of(const Observation& row, Quantity quantity) {
    return {row.tp, row.tp + (quantity == Quantity::sensitivity ? row.fn : row.fp)};
}

Contribution part_of(const Choices& row, Quantity) { return {row.correct, row.n}; }

// Calls take(condition, item, participant, contribution) for each row.
template <class Take>
void each_row(const Observations& seen, Quantity quantity, const Take& take) {
    if (quantity == Quantity::correct) {
        for (const Choices& row : seen.choices)
            take(row.condition, row.comparison, row.participant, part_of(row, quantity));
        return;
    }
    for (const Observation& row : seen.rows) take(row.condition, row.nodule, row.participant, part_of(row, quantity));
}

template <class Row>
People sums_of(std::span<const Row> rows, Quantity quantity) {
    std::map<int, Contribution> sums;  // by participant
    for (const Row& row : rows) {
        if (row.participant < 0) return {};
        const Contribution part = part_of(row, quantity);
        Contribution& sum = sums[row.participant];
        sum.k += part.k;
        sum.n += part.n;
    }
    People people;
    for (const auto& [participant, sum] : sums) people.emplace_back(sum);
    return people;
}

}  // namespace

People people_of(const Observations& seen, int condition, Quantity quantity, int item) {
    Adding adding;
    each_row(seen, quantity, [&](int c, int i, int participant, const Contribution& part) {
        if (c == condition && (item < 0 || i == item)) adding.add(seen.participants.size(), participant, part);
    });
    return std::move(adding).result();
}

People people_who_took_part(const Observations& sorted, int condition, Quantity quantity, int item) {
    if (quantity == Quantity::correct) return sums_of(choice_rows_of(sorted, condition, item), quantity);
    return sums_of(rows_of(sorted, condition, item), quantity);
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
    std::erase_if(out.stiffer, other);
    std::erase_if(out.judged, other);
    std::erase_if(out.answers, other);
    std::set<std::string> codes;
    for (std::size_t i = 0; i < seen.participants.size(); ++i) {
        if (seen.group_of[i] == group) codes.insert(seen.participants[i]);
    }
    const auto elsewhere = [&](const auto& one) { return codes.count(one.participant) == 0; };
    std::erase_if(out.staircases, elsewhere);
    std::erase_if(out.progress, elsewhere);
    std::erase_if(out.exclusions, elsewhere);
    std::erase_if(out.replacements, elsewhere);
    return out;
}

}  // namespace palpa::study
