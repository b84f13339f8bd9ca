#pragma once
// What each participant contributed to a condition: the unit of every test that keeps its level, since people are
// independent, but the nodules and trials of one person are not.

#include <cstdint>
#include <optional>
#include <vector>

namespace palpa::study {

// k of n: nodules found, marks that were right, or right answers. n is 0 for somebody who took part but had nothing to
// count, such as a person without marks.
struct Contribution {
    std::int64_t k = 0;
    std::int64_t n = 0;
};

// What is counted: hits as a share of the nodules, hits as a share of the marks, or right answers.
enum class Quantity { sensitivity, ppv, correct };

// How the share of a condition is averaged. people: the mean of the people's own shares; somebody without anything to
// count is left out. pooled: sum k / sum n, for counts that differ much between people, such as marks; everybody who
// took part counts.
enum class Average { people, pooled };

// By participant; nothing for those who did not take part in the condition.
using People = std::vector<std::optional<Contribution>>;

}  // namespace palpa::study
