#include "study/planned.h"

#include "files/input_error.h"

namespace palpa::study {
namespace {

const char* block_name(bool practice) { return practice ? "practice" : "test"; }

bool has_seed(const PlannedParticipant& plan, int trial, std::int64_t seed) {
    const auto index = static_cast<std::size_t>(trial - 1);
    return index < plan.trials.size() && plan.trials[index].seed == seed;
}

// The plan of a staircase has no comparisons; a choice may name the same one twice.
bool is_other_comparison(const Protocol& protocol, const PlannedTrial& planned, int logged) {
    if (planned.comparison < 0) return false;
    const std::vector<double>& all = comparisons_kPa_of(protocol, planned.condition);
    const auto at = static_cast<std::size_t>(logged);
    return at >= all.size() || all[at] != all[static_cast<std::size_t>(planned.comparison)];
}

// Trials that are odd in the same way: the first is described, the others are counted.
struct Odd {
    std::string first;
    int n = 0;
    void add(const std::string& text) {
        if (++n == 1) first = text;
    }
    void note(std::vector<std::string>& notes) const {
        if (n == 0) return;
        notes.push_back(n == 1 ? first : first + "; " + std::to_string(n - 1) + " more such trials");
    }
};

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
    Odd trials, seeds;
    for (const Logged& one : logged) {
        const auto condition = static_cast<std::size_t>(one.condition);
        const PlannedTrial& planned = plan.trials[static_cast<std::size_t>(one.trial) - 1];
        const bool other = one.comparison >= 0 && is_other_comparison(protocol, planned, one.comparison);
        const bool pair = one.comparison >= 0 && (other || one.reference_first != planned.reference_first);
        const std::string trial = "sub-" + participant + ": trial " + std::to_string(one.trial);
        const std::string of_plan = " in the plan of number " + std::to_string(plan.number);
        if (planned.condition != condition || planned.practice != one.practice || pair) {
            trials.add(trial + " is " + files::shown(protocol.conditions[condition].id) + " (" +
                       block_name(one.practice) + ") in the log, " +
                       files::shown(protocol.conditions[planned.condition].id) + " (" + block_name(planned.practice) +
                       (pair ? ", another pair" : "") + ")" + of_plan);
        } else if (one.seed > 0 && one.seed != planned.seed) {
            seeds.add(trial + " has the seed " + std::to_string(one.seed) + " in the log, " +
                      std::to_string(planned.seed) + of_plan + ": a trial of somebody else?");
        }
        if (one.practice) continue;
        Progress& mine = row(condition);
        mine.finished += one.finished ? 1 : 0;
        mine.interrupted += one.finished ? 0 : 1;
        mine.excluded += one.excluded ? 1 : 0;
    }
    trials.note(notes);
    seeds.note(notes);
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
