#include "study/long_tables.h"

#include <cmath>
#include <map>
#include <utility>

#include "files/text.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

struct LongColumn {
    const char* name;
    const char* unit;  // empty: none
    const char* text;
};

LongTable long_table(const std::string& name, const std::string& title, const std::vector<LongColumn>& columns) {
    LongTable out{{name, title, {}, {}}, files::Json::object()};
    for (const LongColumn& column : columns) {
        out.table.columns.emplace_back(column.name);
        out.dictionary[column.name]["Description"] = column.text;
        if (*column.unit) out.dictionary[column.name]["Units"] = column.unit;
    }
    return out;
}

constexpr LongColumn kWhoColumn{"participant", "", "code without sub-; n/a: not given"};
constexpr LongColumn kGroupOf{"group", "", "of the participant; n/a: none"};
constexpr LongColumn kConditionColumn{"condition", "", "as the protocol or the table names it"};
constexpr LongColumn kWhichTrial{"repeat", "",
                                 "1, 2, ...: which of this person's analysed trials under this condition"};

// Participant, group and condition.
std::vector<std::string> who_and_what(const Observations& seen, int participant, int condition) {
    const auto person = static_cast<std::size_t>(participant);
    const bool grouped = participant >= 0 && person < seen.group_of.size() && seen.group_of[person] >= 0;
    return {participant < 0 ? kNone : seen.participants[person],
            grouped ? seen.groups[static_cast<std::size_t>(seen.group_of[person])] : kNone,
            seen.conditions[static_cast<std::size_t>(condition)]};
}

std::string name_or_none(const std::vector<std::string>& names, int index) {
    return index < 0 ? kNone : names[static_cast<std::size_t>(index)];
}

// What was found in each trial: logs give the rows of a trial the number of the person's trial under the condition.
using TrialKey = std::pair<std::pair<int, int>, int>;  // condition and participant, repeat
std::map<TrialKey, Observation> sums_of_trials(const Observations& seen) {
    std::map<TrialKey, Observation> sums;
    for (const Observation& row : seen.rows) {
        Observation& sum = sums[{{row.condition, row.participant}, row.repeat}];
        sum.tp += row.tp;
        sum.fn += row.fn;
        sum.fp += row.fp;
    }
    return sums;
}

void add_answer(const StifferAnswers& answers, std::vector<std::string>& row) {
    row.emplace_back(answers.axis == StiffnessAxis::second_first ? "second/first" : "comparison/reference");
    row.push_back(files::number_text(answers.x));
    row.push_back(whole(answers.stiffer));
}

}  // namespace

LongTable nodules_long(const Observations& seen) {
    LongTable out = long_table("nodules_long", "Each nodule that somebody judged",
                               {kWhoColumn,
                                kGroupOf,
                                kConditionColumn,
                                {"nodule", "", "as the scene names it; in a table of marks the case and the lesion"},
                                kWhichTrial,
                                {"found", "", "1 or 0; in a table of counts how often"},
                                {"missed", "", "1 or 0; in a table of counts how often"}});
    for (const Observation& row : seen.rows) {
        if (row.participant < 0 || row.nodule < 0 || row.tp + row.fn == 0) continue;
        std::vector<std::string> cells = who_and_what(seen, row.participant, row.condition);
        cells.push_back(seen.nodules[static_cast<std::size_t>(row.nodule)]);
        for (const std::int64_t n : {std::int64_t{row.repeat + 1}, row.tp, row.fn}) cells.push_back(whole(n));
        out.table.rows.push_back(std::move(cells));
    }
    return out;
}

LongTable trials_long(const Observations& seen) {
    LongTable out = long_table("trials_long", "Each finished trial in which nodules were to be found",
                               {kWhoColumn,
                                kGroupOf,
                                kConditionColumn,
                                kWhichTrial,
                                {"duration_s", "s", "from the begin of the trial to its end"},
                                {"path_mm", "mm", "length of the path while pressing, in steps of 0.5 mm or more"},
                                {"mean_force_N", "N", "while pressing"},
                                {"max_force_N", "N", "while pressing"},
                                {"found", "", "nodules found"},
                                {"missed", "", "nodules missed"},
                                {"false_marks", "", "marks on no nodule"}});
    const std::map<TrialKey, Observation> sums = sums_of_trials(seen);
    std::map<std::pair<int, int>, int> repeats;
    for (const TrialFigures& trial : seen.trials) {
        const std::pair who(trial.condition, trial.participant);
        const int repeat = repeats[who]++;
        std::vector<std::string> cells = who_and_what(seen, trial.participant, trial.condition);
        cells.push_back(whole(repeat + 1));
        for (const double x : {trial.duration_s, 1e3 * trial.path_m, trial.mean_force_N, trial.max_force_N})
            cells.push_back(files::number_text(x));
        const auto it = sums.find({who, repeat});
        const Observation sum = it == sums.end() ? Observation{} : it->second;
        for (const std::int64_t n : {sum.tp, sum.fn, sum.fp}) cells.push_back(whole(n));
        out.table.rows.push_back(std::move(cells));
    }
    return out;
}

LongTable choices_long(const Observations& seen) {
    LongTable out = long_table("choices_long", "Each forced choice",
                               {kWhoColumn,
                                kGroupOf,
                                kConditionColumn,
                                {"comparison", "", "stiffness that was compared with the reference; n/a: not given"},
                                {"correct", "", "how many answers were right; n/a: not known, or a staircase"},
                                {"n", "", "how many answers the row holds: 1 in logs"},
                                {"axis", "", "what log_ratio is the ratio of: second/first or comparison/reference"},
                                {"log_ratio", "", "natural logarithm of the ratio of stiffnesses"},
                                {"stiffer", "", "how many answers called the second, or the comparison, the stiffer"}});
    // logs give both lists in the same order, unless staircases have left the first
    const bool both = seen.from_logs && seen.choices.size() == seen.stiffer.size();
    for (std::size_t i = 0; i < seen.choices.size() && (both || seen.stiffer.empty()); ++i) {
        const Choices& choice = seen.choices[i];
        std::vector<std::string> cells = who_and_what(seen, choice.participant, choice.condition);
        cells.push_back(name_or_none(seen.comparisons, choice.comparison));
        cells.push_back(whole(choice.correct));
        cells.push_back(whole(choice.n));
        if (both) add_answer(seen.stiffer[i], cells);
        if (!both) cells.insert(cells.end(), 3, kNone);
        out.table.rows.push_back(std::move(cells));
    }
    for (std::size_t i = 0; i < seen.stiffer.size() && !both; ++i) {
        const StifferAnswers& answers = seen.stiffer[i];
        std::vector<std::string> cells = who_and_what(seen, answers.participant, answers.condition);
        cells.insert(cells.end(), {kNone, kNone, whole(answers.n)});
        add_answer(answers, cells);
        out.table.rows.push_back(std::move(cells));
    }
    return out;
}

std::vector<LongTable> long_tables(const Observations& seen) {
    std::vector<LongTable> out;
    for (const auto make : {nodules_long, trials_long, choices_long}) {
        LongTable one = make(seen);
        if (!one.table.rows.empty()) out.push_back(std::move(one));
    }
    return out;
}

const std::vector<std::string>& long_table_names() {
    static const std::vector<std::string> names{"nodules_long", "trials_long", "choices_long"};
    return names;
}

}  // namespace palpa::study
