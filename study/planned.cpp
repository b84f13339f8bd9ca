#include "study/planned.h"

#include "files/input_error.h"

namespace palpa::study {
namespace {

const char* block_name(bool practice) { return practice ? "practice" : "test"; }

bool has_seed(const PlannedParticipant& plan, int trial, std::int64_t seed) {
    const auto index = static_cast<std::size_t>(trial - 1);
    return index < plan.trials.size() && plan.trials[index].seed == seed;
}

}  // namespace

std::vector<Progress> compare_with_plan(const Protocol& protocol, const PlannedParticipant& plan,
                                        const std::string& participant, const std::vector<Logged>& logged,
                                        std::vector<std::string>& notes) {
    std::vector<Progress> rows;
    std::vector<int> place(protocol.conditions.size(), -1);  // index in rows, by condition
    const auto row = [&](std::size_t condition) -> Progress& {
        if (place[condition] < 0) {
            place[condition] = static_cast<int>(rows.size());
            rows.push_back({participant, protocol.groups[plan.group].id, protocol.conditions[condition].id});
        }
        return rows[static_cast<std::size_t>(place[condition])];
    };
    for (const PlannedTrial& trial : plan.trials) {
        if (!trial.practice) ++row(trial.condition).planned;
    }
    int odd = 0;
    std::string first;
    for (const Logged& one : logged) {
        const auto condition = static_cast<std::size_t>(one.condition);
        const PlannedTrial& planned = plan.trials[static_cast<std::size_t>(one.trial) - 1];
        // the plan of a staircase has no comparisons
        const bool other = planned.comparison >= 0 && one.comparison != planned.comparison;
        const bool pair = one.comparison >= 0 && (other || one.reference_first != planned.reference_first);
        if (planned.condition != condition || planned.practice != one.practice || pair) {
            if (++odd == 1) {
                first = "sub-" + participant + ": trial " + std::to_string(one.trial) + " is " +
                        files::shown(protocol.conditions[condition].id) + " (" + block_name(one.practice) +
                        ") in the log, " + files::shown(protocol.conditions[planned.condition].id) + " (" +
                        block_name(planned.practice) + (pair ? ", another pair" : "") + ") in the plan of number " +
                        std::to_string(plan.number);
            }
        }
        if (one.practice) continue;
        Progress& mine = row(condition);
        mine.finished += one.finished ? 1 : 0;
        mine.interrupted += one.finished ? 0 : 1;
        mine.excluded += one.excluded ? 1 : 0;
    }
    if (odd > 1) first += "; " + std::to_string(odd - 1) + " more such trials";
    if (odd > 0) notes.push_back(first);
    return rows;
}

std::optional<int> number_with_seed(const Protocol& protocol, int trial, std::int64_t seed, int likely, int most) {
    if (has_seed(plan_participant(protocol, likely), trial, seed)) return likely;
    for (int number = 1; number <= most; ++number) {
        if (number != likely && has_seed(plan_participant(protocol, number), trial, seed)) return number;
    }
    return std::nullopt;
}

}  // namespace palpa::study
