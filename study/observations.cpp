#include "study/observations.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"
#include "study/count.h"
#include "study/stiffer_counts.h"

namespace palpa::study {
namespace {

std::optional<std::size_t> optional_column(const files::Table& table, std::string_view name) {
    if (!table.has_column(name)) return std::nullopt;
    return table.column(name);
}

int name_index(const files::Table& table, std::optional<std::size_t> column, std::vector<std::string>& names) {
    if (!column || table.field(*column) == "n/a" || table.field(*column).empty()) return -1;
    return index_of(table.field(*column), names);
}

int condition_index(const files::Table& table, std::size_t column, Observations& out) {
    const int index = name_index(table, column, out.conditions);
    if (index < 0) table.fail(column, "a name");
    return index;
}

// Refuses two rows with the same participant, condition and item, which would be counted twice.
class Unique {
  public:
    void add(const files::Table& table, std::size_t column, const std::array<int, 3>& key) {
        const auto [it, fresh] = first_line_.emplace(key, table.line());
        if (!fresh) {
            table.fail(column, "it once: line " + std::to_string(it->second) +
                                   " has the same condition, participant and nodule or comparison");
        }
    }

  private:
    std::map<std::array<int, 3>, std::size_t> first_line_;
};

// Takes the group of the row's participant, which must be the same in all of that person's rows.
void take_group(const files::Table& table, std::optional<std::size_t> column, int participant, Observations& out) {
    if (!column) return;
    const int group = name_index(table, column, out.groups);
    if (participant < 0) {
        if (group >= 0) table.fail(*column, "n/a: the row names no participant");
        return;
    }
    const auto person = static_cast<std::size_t>(participant);
    if (person == out.group_of.size()) out.group_of.push_back(group);
    const int before = out.group_of[person];
    if (group != before) {
        table.fail(*column, (before < 0 ? "n/a" : out.groups[static_cast<std::size_t>(before)]) +
                                " as in a row before: a participant is in one group");
    }
}

void read_marks(files::Table& table, Observations& out) {
    const std::size_t condition = table.column("condition");
    const std::size_t tp = table.column("tp"), fn = table.column("fn"), fp = table.column("fp");
    const auto n = optional_column(table, "n");
    const auto nodule = optional_column(table, "nodule");
    const auto participant = optional_column(table, "participant"), group = optional_column(table, "group");
    Unique unique;
    while (table.next()) {
        Observation row;
        row.condition = condition_index(table, condition, out);
        row.nodule = name_index(table, nodule, out.nodules);
        row.participant = name_index(table, participant, out.participants);
        take_group(table, group, row.participant, out);
        row.tp = count(table, tp);
        row.fn = count(table, fn);
        const bool no_marks_told = row.nodule >= 0 && table.field(fp) == "n/a";
        row.fp = no_marks_told ? 0 : count(table, fp);
        if (n && row.tp > count(table, *n)) {
            table.fail(tp, "at most n = " + std::string(table.field(*n)) + ": no more can be found than there are");
        }
        if (n && row.tp + row.fn != count(table, *n)) table.fail(*n, "tp + fn = " + std::to_string(row.tp + row.fn));
        unique.add(table, condition, {row.condition, row.nodule, row.participant});
        out.rows.push_back(row);
    }
}

void read_choices(files::Table& table, Observations& out) {
    const std::size_t condition = table.column("condition");
    const std::size_t correct = table.column("correct"), n = table.column("n");
    const auto comparison = optional_column(table, "comparison");
    const auto participant = optional_column(table, "participant"), group = optional_column(table, "group");
    Unique unique;
    while (table.next()) {
        Choices row;
        row.condition = condition_index(table, condition, out);
        row.comparison = name_index(table, comparison, out.comparisons);
        row.participant = name_index(table, participant, out.participants);
        take_group(table, group, row.participant, out);
        row.correct = count(table, correct);
        row.n = count(table, n);
        if (row.correct > row.n) table.fail(correct, "at most n = " + std::to_string(row.n));
        unique.add(table, condition, {row.condition, row.comparison, row.participant});
        out.choices.push_back(row);
    }
}

}  // namespace

int index_of(std::string_view name, std::vector<std::string>& names) {
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    if (at == static_cast<std::ptrdiff_t>(names.size())) names.emplace_back(name);
    return static_cast<int>(at);
}

Observations read_counts(const std::filesystem::path& tsv) {
    files::Table table = files::read_tsv(tsv);
    if (table.has_column("stiffer")) return read_stiffer_counts(table);
    Observations out;
    for (const std::string& column : table.columns()) {
        constexpr std::array<std::string_view, 9> kKnown{"condition", "tp",          "fn",      "fp",   "n",
                                                         "nodule",    "participant", "correct", "group"};
        if (column != "comparison" && std::find(kKnown.begin(), kKnown.end(), column) == kKnown.end()) {
            throw files::bad_input(
                tsv.string(), "line 1", "the column " + files::shown(column),
                "condition tp fn fp [n] [nodule] [participant] [group], or condition correct n [comparison] "
                "[participant] [group], or condition reference_kPa comparison_kPa stiffer n [participant]");
        }
    }
    if (table.has_column("correct")) {
        read_choices(table, out);
    } else {
        read_marks(table, out);
    }
    if (out.conditions.empty()) throw files::bad_input(tsv.string(), "", "no rows", "one row of counts at least");
    return out;
}

}  // namespace palpa::study
