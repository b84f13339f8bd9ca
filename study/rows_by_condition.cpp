#include "study/rows_by_condition.h"

#include <algorithm>
#include <tuple>

namespace palpa::study {
namespace {

// Returns the rows from `first` up to `last`, both of which compare as their keys.
template <class Row, class Key>
std::span<const Row> rows_between(const std::vector<Row>& rows, const Key& key, const std::pair<int, int>& first,
                                  const std::pair<int, int>& last) {
    const auto begin = std::lower_bound(rows.begin(), rows.end(), first,
                                        [&](const Row& row, const auto& wanted) { return key(row) < wanted; });
    const auto end = std::upper_bound(begin, rows.end(), last,
                                      [&](const auto& wanted, const Row& row) { return wanted < key(row); });
    return std::span(rows).subspan(static_cast<std::size_t>(begin - rows.begin()),
                                   static_cast<std::size_t>(end - begin));
}

}  // namespace

void sort_rows(Observations& seen) {
    const auto of_row = [](const Observation& r) { return std::tuple(r.condition, r.nodule, r.participant, r.repeat); };
    const auto of_choice = [](const Choices& c) { return std::tuple(c.condition, c.comparison, c.participant); };
    std::stable_sort(seen.rows.begin(), seen.rows.end(),
                     [&](const Observation& a, const Observation& b) { return of_row(a) < of_row(b); });
    std::stable_sort(seen.choices.begin(), seen.choices.end(),
                     [&](const Choices& a, const Choices& b) { return of_choice(a) < of_choice(b); });
}

std::span<const Observation> rows_of(const Observations& seen, int condition, int nodule) {
    const auto key = [&](const Observation& row) { return std::pair(row.condition, nodule < 0 ? -1 : row.nodule); };
    return rows_between(seen.rows, key, {condition, nodule}, {condition, nodule});
}

std::span<const Choices> choice_rows_of(const Observations& seen, int condition, int comparison) {
    const auto key = [&](const Choices& c) { return std::pair(c.condition, comparison < 0 ? -1 : c.comparison); };
    return rows_between(seen.choices, key, {condition, comparison}, {condition, comparison});
}

}  // namespace palpa::study
