#include "study/observations.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"
#include "study/count.h"
#include "study/marks_table.h"
#include "study/name_index.h"
#include "study/names.h"
#include "study/stiffer_counts.h"
#include "study/table_names.h"

namespace palpa::study {
namespace {

std::optional<std::size_t> optional_column(const files::Table& table, std::string_view name) {
    if (!table.has_column(name)) return std::nullopt;
    return table.column(name);
}

// The names of a column that may be missing, or n/a in a row.
class NameColumn {
  public:
    NameColumn(const files::Table& table, std::string_view name, std::vector<std::string>& names)
        : column_(optional_column(table, name)), index_(names) {}

    // Returns the index of the name in this row, -1 if it is not given.
    int of(const files::Table& table) {
        if (!column_) return -1;
        const std::string_view name = table.field(*column_);
        if (name == "n/a" || name.empty()) return -1;
        if (names_a_sum(name)) table.fail(*column_, "one name, or n/a in a row for all of them");
        if (!is_name(name)) table.fail(*column_, std::string(kNameRule) + ", or n/a if it is not given");
        return index_.of(name_in(table, *column_));
    }

    std::optional<std::size_t> column() const { return column_; }

  private:
    std::optional<std::size_t> column_;
    NameIndex index_;
};

// The conditions, one in each row.
class ConditionColumn {
  public:
    ConditionColumn(const files::Table& table, Observations& out)
        : column_(table.column("condition")), index_(out.conditions) {}

    int of(const files::Table& table) { return index_.of(name_in(table, column_)); }
    std::size_t column() const { return column_; }

  private:
    std::size_t column_;
    NameIndex index_;
};

// Refuses a row for all items (nodules, comparisons or participants) beside rows of single ones, since the sums would
// count both.
class WholeOrParts {
  public:
    explicit WholeOrParts(const char* items) : items_(items) {}

    void add(const files::Table& table, std::size_t column, const std::pair<int, int>& group, bool whole) {
        Lines& lines = lines_[group];
        (whole ? lines.whole : lines.part) = table.line();
        if (lines.whole == 0 || lines.part == 0) return;
        const std::size_t other = whole ? lines.part : lines.whole;
        table.fail(column, std::string("rows of ") + items_ + " or one row for all of them, not both: line " +
                               std::to_string(other) + " counts the same");
    }

  private:
    struct Lines {
        std::size_t whole = 0, part = 0;
    };
    const char* items_;
    std::map<std::pair<int, int>, Lines> lines_;
};

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
void take_group(const files::Table& table, NameColumn& groups, int participant, Observations& out) {
    const auto column = groups.column();
    if (!column) return;
    const int group = groups.of(table);
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
    ConditionColumn condition(table, out);
    const std::size_t tp = table.column("tp"), fn = table.column("fn"), fp = table.column("fp");
    const auto n = optional_column(table, "n");
    NameColumn nodule(table, "nodule", out.nodules), participant(table, "participant", out.participants);
    NameColumn group(table, "group", out.groups);
    Unique unique;
    WholeOrParts nodules("nodules"), false_marks("nodules"), people("participants");
    while (table.next()) {
        Observation row;
        row.condition = condition.of(table);
        row.nodule = nodule.of(table);
        row.participant = participant.of(table);
        take_group(table, group, row.participant, out);
        row.tp = count(table, tp);
        row.fn = count(table, fn);
        const bool no_marks_told = row.nodule >= 0 && table.field(fp) == "n/a";
        row.fp = no_marks_told ? 0 : count(table, fp);
        if (n && row.tp > count(table, *n)) {
            table.fail(tp, "at most n = " + std::string(table.field(*n)) + ": no more can be found than there are");
        }
        if (n && row.tp + row.fn != count(table, *n)) table.fail(*n, "tp + fn = " + std::to_string(row.tp + row.fn));
        unique.add(table, condition.column(), {row.condition, row.nodule, row.participant});
        const std::pair person(row.condition, row.participant);
        const bool whole = row.nodule < 0;
        if (nodule.column() && (!whole || row.tp + row.fn > 0)) nodules.add(table, *nodule.column(), person, whole);
        if (nodule.column() && row.fp > 0) false_marks.add(table, fp, person, whole);
        if (participant.column()) people.add(table, *participant.column(), {row.condition, 0}, row.participant < 0);
        out.rows.push_back(row);
    }
}

void read_choices(files::Table& table, Observations& out) {
    ConditionColumn condition(table, out);
    const std::size_t correct = table.column("correct"), n = table.column("n");
    NameColumn comparison(table, "comparison", out.comparisons), participant(table, "participant", out.participants);
    NameColumn group(table, "group", out.groups);
    Unique unique;
    WholeOrParts comparisons("comparisons"), people("participants");
    while (table.next()) {
        Choices row;
        row.condition = condition.of(table);
        row.comparison = comparison.of(table);
        row.participant = participant.of(table);
        take_group(table, group, row.participant, out);
        row.correct = count(table, correct);
        row.n = count(table, n);
        if (row.correct > row.n) table.fail(correct, "at most n = " + std::to_string(row.n));
        unique.add(table, condition.column(), {row.condition, row.comparison, row.participant});
        if (comparison.column())
            comparisons.add(table, *comparison.column(), {row.condition, row.participant}, row.comparison < 0);
        if (participant.column()) people.add(table, *participant.column(), {row.condition, 0}, row.participant < 0);
        out.choices.push_back(row);
    }
}

}  // namespace

UnnamedJudgements unnamed_judgements(const Observations& seen) {
    UnnamedJudgements out;
    for (const Observation& row : seen.rows) {
        const std::int64_t n = row.tp + row.fn;
        out.all += n;
        if (row.participant < 0) out.no_participant += n;
        if (row.nodule < 0) out.no_nodule += n;
    }
    return out;
}

int index_of(std::string_view name, std::vector<std::string>& names) {
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    if (at == static_cast<std::ptrdiff_t>(names.size())) names.emplace_back(name);
    return static_cast<int>(at);
}

Observations read_counts(const std::filesystem::path& tsv, const RatingScale& scale) {
    files::Table table = files::read_tsv(tsv);
    if (table.has_column("stiffer")) return read_stiffer_counts(table);
    if (table.has_column("kind")) return read_marks_table(table, scale);
    Observations out;
    for (const std::string& column : table.columns()) {
        constexpr std::array<std::string_view, 9> kKnown{"condition", "tp",          "fn",      "fp",   "n",
                                                         "nodule",    "participant", "correct", "group"};
        if (column != "comparison" && std::find(kKnown.begin(), kKnown.end(), column) == kKnown.end()) {
            throw files::bad_input(
                tsv.string(), "line 1", "the column " + files::shown(column),
                "condition tp fn fp [n] [nodule] [participant] [group], or condition correct n [comparison] "
                "[participant] [group], or condition reference_kPa comparison_kPa stiffer n [participant], or "
                "condition participant case kind lesion rating [group]");
        }
    }
    if (table.has_column("correct")) {
        read_choices(table, out);
    } else {
        read_marks(table, out);
    }
    refuse_sum(table, out.conditions);
    if (out.conditions.empty()) throw files::bad_input(tsv.string(), "", "no rows", "one row of counts at least");
    return out;
}

}  // namespace palpa::study
