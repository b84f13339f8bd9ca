#include "study/stiffer_counts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "files/input_error.h"
#include "files/text.h"
#include "study/count.h"
#include "study/name_index.h"
#include "study/names.h"
#include "study/psychometric.h"
#include "study/table_names.h"

namespace palpa::study {
namespace {

void check_columns(const files::Table& table) {
    constexpr std::array<std::string_view, 6> kKnown{"condition", "reference_kPa", "comparison_kPa", "stiffer",
                                                     "n",         "participant"};
    for (const std::string& column : table.columns()) {
        if (std::find(kKnown.begin(), kKnown.end(), column) != kKnown.end()) continue;
        throw files::bad_input(table.file(), "line 1", "the column " + files::shown(column),
                               "condition reference_kPa comparison_kPa stiffer n [participant]");
    }
}

void check_levels(const files::Table& table, const Observations& out) {
    std::vector<std::vector<LevelAnswers>> levels(out.conditions.size());
    for (const StifferAnswers& row : out.stiffer)
        levels[static_cast<std::size_t>(row.condition)].push_back({row.x, row.stiffer, row.n});
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (merged_levels(std::move(levels[i])).size() > 1) continue;
        throw files::bad_input(table.file(), "condition " + files::shown(out.conditions[i]), "one level only",
                               "two ratios comparison_kPa / reference_kPa at least: no curve goes through one level");
    }
}

}  // namespace

double stiffness_kPa(const files::Table& table, std::size_t column) {
    const double value = table.number(column);
    if (!std::isfinite(value) || value <= 0.0) table.fail(column, "a stiffness in kPa, a number above 0");
    return value;
}

Observations read_stiffer_counts(files::Table& table) {
    check_columns(table);
    const std::size_t condition = table.column("condition"), reference = table.column("reference_kPa");
    const std::size_t comparison = table.column("comparison_kPa"), stiffer = table.column("stiffer");
    const std::size_t n = table.column("n");
    const bool has_people = table.has_column("participant");
    const std::size_t participant = has_people ? table.column("participant") : condition;
    Observations out;
    NameIndex conditions(out.conditions), participants(out.participants);
    std::map<std::tuple<int, int, double, double>, std::size_t> first_line;
    std::map<int, std::array<std::size_t, 2>> lines;  // by condition: the last that names nobody, and somebody
    while (table.next()) {
        StifferAnswers row;
        row.condition = conditions.of(name_in(table, condition));
        if (has_people && !table.field(participant).empty() && table.field(participant) != "n/a") {
            if (!is_name(table.field(participant)))
                table.fail(participant, std::string(kNameRule) + ", or n/a if it is not given");
            if (names_a_sum(table.field(participant)))
                table.fail(participant, "one name, or n/a in a row for all of them");
            row.participant = participants.of(name_in(table, participant));
        }
        row.axis = StiffnessAxis::comparison_reference;
        const double reference_kPa = stiffness_kPa(table, reference);
        const double comparison_kPa = stiffness_kPa(table, comparison);
        row.x = std::log(comparison_kPa / reference_kPa);
        row.n = whole_number(table, n, 1, kMostCounts);
        row.stiffer = count(table, stiffer);
        if (row.stiffer > row.n) {
            table.fail(stiffer,
                       "at most n = " + std::to_string(row.n) + ": no more answers can say stiffer than there are");
        }
        const auto [it, fresh] =
            first_line.emplace(std::tuple(row.condition, row.participant, reference_kPa, comparison_kPa), table.line());
        if (!fresh) {
            table.fail(condition, "it once: line " + std::to_string(it->second) +
                                      " has the same condition, participant, reference_kPa and comparison_kPa");
        }
        auto& here = lines[row.condition];
        here[row.participant < 0 ? 0 : 1] = table.line();
        if (here[0] > 0 && here[1] > 0) {
            table.fail(participant, "rows of participants or rows for all of them, not both: line " +
                                        std::to_string(std::min(here[0], here[1])) + " counts the same");
        }
        out.stiffer.push_back(row);
    }
    if (out.stiffer.empty()) throw files::bad_input(table.file(), "", "no rows", "one row of counts at least");
    refuse_sum(table, out.conditions);
    check_levels(table, out);
    return out;
}

StifferAnswers stiffer_choice(const StifferQuestion& question, bool reference_softer) {
    StifferAnswers out;
    out.n = 1;
    const double x = std::log(question.comparison_kPa / question.reference_kPa);
    if (question.reference_stays) {
        out.axis = StiffnessAxis::comparison_reference;
        out.x = x;
        out.stiffer = reference_softer ? 1 : 0;
    } else {
        out.x = question.reference_first ? x : -x;
        out.stiffer = reference_softer == question.reference_first ? 1 : 0;  // the first was called softer
    }
    return out;
}

}  // namespace palpa::study
