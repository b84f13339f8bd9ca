#include "study/marks_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "study/name_index.h"
#include "study/table_names.h"

namespace palpa::study {
namespace {

struct MarksColumns {
    explicit MarksColumns(const files::Table& table)
        : condition(table.column("condition")),
          participant(table.column("participant")),
          case_id(table.column("case")),
          kind(table.column("kind")),
          lesion(table.column("lesion")),
          rating(table.column("rating")) {
        if (table.has_column("group")) group = table.column("group");
    }
    std::size_t condition, participant, case_id, kind, lesion, rating;
    std::optional<std::size_t> group;
};

bool is_empty_field(std::string_view field) { return field == "n/a" || field.empty(); }

// One case of one person under one condition while its rows come in.
struct OpenCase {
    JudgedCase judged;
    std::size_t line = 0;  // of its first row
    bool bare = false;     // a row `case`
};

class MarksReader {
  public:
    MarksReader(files::Table& table, const RatingScale& scale, Observations& out)
        : table_(table),
          columns_(table),
          scale_(scale),
          out_(out),
          conditions_(out.conditions),
          people_(out.participants),
          groups_(out.groups) {}

    void take_row() {
        const std::string_view kind = table_.field(columns_.kind);
        if (kind != "lesion" && kind != "nl" && kind != "case") table_.fail(columns_.kind, "lesion, nl or case");
        OpenCase& open = open_case();
        if (open.bare || (kind == "case" && open.line != table_.line())) {
            table_.fail(columns_.kind,
                        "no row case beside other rows of the same case: it says that the case has no "
                        "lesion and no mark");
        }
        if (kind == "lesion") return take_lesion(open.judged);
        if (!is_empty_field(table_.field(columns_.lesion)))
            table_.fail(columns_.lesion, "n/a in a row " + std::string(kind));
        if (kind == "nl") return open.judged.reading.nl.push_back(rating());
        if (!is_empty_field(table_.field(columns_.rating))) table_.fail(columns_.rating, "n/a in a row case");
        open.bare = true;
    }

    void finish() {
        sort_lesions();
        check_lesions();
        NameIndex nodules(out_.nodules);
        for (OpenCase& open : cases_) {
            JudgedCase& one = open.judged;
            const auto false_marks = static_cast<std::int64_t>(one.reading.nl.size());
            for (std::size_t l = 0; l < one.lesions.size(); ++l) {
                const bool hit = one.reading.ll[l] != kUnmarked;
                out_.rows.push_back(
                    {one.condition, one.participant, nodules.of(one.id + " " + one.lesions[l]), 0, hit, !hit, 0});
            }
            out_.rows.push_back({one.condition, one.participant, -1, 0, 0, 0, false_marks});
            out_.judged.push_back(std::move(one));
        }
    }

  private:
    OpenCase& open_case() {
        const int condition = conditions_.of(name_in(table_, columns_.condition));
        const int participant = people_.of(name_in(table_, columns_.participant));
        take_group_of(participant);
        const std::string id(name_in(table_, columns_.case_id));
        const auto [it, fresh] = place_.emplace(std::tuple(condition, participant, id), cases_.size());
        if (fresh) {
            cases_.push_back({});
            cases_.back().judged.condition = condition;
            cases_.back().judged.participant = participant;
            cases_.back().judged.id = id;
            cases_.back().line = table_.line();
        }
        return cases_[it->second];
    }

    void take_group_of(int participant) {
        if (!columns_.group) return;
        const std::string_view field = table_.field(*columns_.group);
        const int group = is_empty_field(field) ? -1 : groups_.of(name_in(table_, *columns_.group));
        const auto person = static_cast<std::size_t>(participant);
        if (person == out_.group_of.size()) out_.group_of.push_back(group);
        if (group != out_.group_of[person])
            table_.fail(*columns_.group, "the same group as in the rows before: a participant is in one group");
    }

    double rating() {
        const double value = table_.number(columns_.rating);
        if (std::isnan(value)) table_.fail(columns_.rating, "a number: a mark has a rating");
        if (!(value >= scale_.low && value <= scale_.high)) {
            table_.fail(columns_.rating, "a rating from " + files::short_number(scale_.low) + " to " +
                                             files::short_number(scale_.high) + ", the scale");
        }
        return value;
    }

    void take_lesion(JudgedCase& one) {
        const std::string lesion(name_in(table_, columns_.lesion));
        if (std::find(one.lesions.begin(), one.lesions.end(), lesion) != one.lesions.end())
            table_.fail(columns_.lesion, "each lesion of a case once for each participant and condition");
        one.lesions.push_back(lesion);
        const bool unmarked = is_empty_field(table_.field(columns_.rating));
        one.reading.ll.push_back(unmarked ? kUnmarked : rating());
    }

    // Lesions may stand in another order for each person.
    void sort_lesions() {
        for (OpenCase& open : cases_) {
            JudgedCase& one = open.judged;
            std::vector<std::pair<std::string, double>> both;
            for (std::size_t l = 0; l < one.lesions.size(); ++l) both.emplace_back(one.lesions[l], one.reading.ll[l]);
            std::sort(both.begin(), both.end());
            for (std::size_t l = 0; l < both.size(); ++l) {
                one.lesions[l] = both[l].first;
                one.reading.ll[l] = both[l].second;
            }
        }
    }

    void check_lesions() const {
        std::map<std::string, const OpenCase*> most;
        for (const OpenCase& open : cases_) {
            const OpenCase*& first = most[open.judged.id];
            if (!first || open.judged.lesions.size() > first->judged.lesions.size()) first = &open;
        }
        for (const OpenCase& open : cases_) {
            const OpenCase& other = *most[open.judged.id];
            if (open.judged.lesions == other.judged.lesions) continue;
            throw files::bad_input(
                table_.file(), "line " + std::to_string(open.line) + ", case",
                listed(open.judged.lesions) + " of " + files::shown(open.judged.id) + " for " +
                    files::shown(out_.participants[static_cast<std::size_t>(open.judged.participant)]),
                listed(other.judged.lesions) + " as from line " + std::to_string(other.line) +
                    " on: one row for each lesion of the case, for each participant and condition");
        }
    }

    static std::string listed(const std::vector<std::string>& lesions) {
        std::string text = lesions.empty() ? "no lesion" : "the lesions";
        for (std::size_t l = 0; l < lesions.size() && l < 10; ++l) text += " " + files::shown(lesions[l]);
        return text + (lesions.size() > 10 ? " and others" : "");
    }

    files::Table& table_;
    MarksColumns columns_;
    RatingScale scale_;
    Observations& out_;
    NameIndex conditions_, people_, groups_;
    std::vector<OpenCase> cases_;
    std::map<std::tuple<int, int, std::string>, std::size_t> place_;
};

}  // namespace

Observations read_marks_table(files::Table& table, const RatingScale& scale) {
    constexpr std::array<std::string_view, 7> kKnown{"condition", "participant", "case", "kind",
                                                     "lesion",    "rating",      "group"};
    for (const std::string& column : table.columns()) {
        if (std::find(kKnown.begin(), kKnown.end(), column) != kKnown.end()) continue;
        throw files::bad_input(table.file(), "line 1", "the column " + files::shown(column),
                               "condition participant case kind lesion rating [group]");
    }
    Observations out;
    MarksReader reader(table, scale, out);
    while (table.next()) reader.take_row();
    refuse_sum(table, out.conditions);
    if (out.conditions.empty())
        throw files::bad_input(table.file(), "", "no rows", "one row at least for each case that somebody judged");
    reader.finish();
    return out;
}

}  // namespace palpa::study
