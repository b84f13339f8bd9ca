// One table over all displays: what was found, and how often answers to pairs were right, one line for each condition.

#include <algorithm>

#include "study/report.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

template <class Rows, class Same>
auto* first_of(const Rows& rows, const Same& same) {
    const auto it = std::find_if(rows.begin(), rows.end(), same);
    return it == rows.end() ? nullptr : &*it;
}

// What the report says of one display; null: nothing.
struct DisplayResult {
    const ConditionResult* found = nullptr;
    const ChoiceResult* chosen = nullptr;  // over all comparisons
};

DisplayResult result_of(const Report& report, const std::string& condition) {
    return {first_of(report.conditions, [&](const ConditionResult& one) { return one.name == condition; }),
            first_of(report.choices,
                     [&](const ChoiceResult& one) { return one.condition == condition && one.comparison.empty(); })};
}

// The interval over participants where there is one, else Wilson's.
Interval interval_of(const Share& share) { return share.bootstrap.value_or(share.wilson); }

void add_cells(const std::optional<Share>& share, std::vector<std::string>& row) {
    row.push_back(share ? share_text(share->x.p()) : kNone);
    add_interval(share ? std::optional(interval_of(*share)) : std::nullopt, row);
}

const char* answers_of(const ConditionDisplay& one) { return one.typed_in ? "typed in" : "logged"; }

}  // namespace

ReportTable display_table(const Report& report) {
    ReportTable table{
        "displays",
        "All displays (intervals over participants where they can be computed, else Wilson's)",
        {"condition", "display", "answers", "participants", "sensitivity", "sensitivity_low", "sensitivity_high", "ppv",
         "ppv_low", "ppv_high", "median_time_s", "correct", "correct_low", "correct_high"},
        {}};
    for (const ConditionDisplay& one : report.displays) {
        const DisplayResult result = result_of(report, one.condition);
        const ConditionResult none;
        const ConditionResult& found = result.found != nullptr ? *result.found : none;
        std::vector<std::string> row{one.condition, one.display, answers_of(one),
                                     result.found != nullptr ? whole(found.participants) : kNone};
        add_cells(found.se, row);
        add_cells(found.ppv, row);
        row.push_back(found.duration_s ? fixed(found.duration_s->median, 1) : kNone);
        add_cells(result.chosen != nullptr ? std::optional(result.chosen->correct) : std::nullopt, row);
        table.rows.push_back(std::move(row));
    }
    return table;
}

void add_displays_json(const Report& report, files::Json& json) {
    if (report.displays.empty()) return;
    const auto add = [](const char* name, const std::optional<Share>& share, files::Json& row) {
        row[name] = share ? files::Json(share->x.p()) : files::Json(nullptr);
        row[std::string(name) + "_ci"] = share ? files::Json{files::number_or_null(interval_of(*share).low),
                                                             files::number_or_null(interval_of(*share).high)}
                                               : files::Json(nullptr);
    };
    json["displays"] = files::Json::array();
    for (const ConditionDisplay& one : report.displays) {
        const DisplayResult result = result_of(report, one.condition);
        files::Json row{{"condition", one.condition}, {"display", one.display}, {"answers", answers_of(one)}};
        row["participants"] = result.found != nullptr ? files::Json(result.found->participants) : files::Json(nullptr);
        add("sensitivity", result.found != nullptr ? result.found->se : std::nullopt, row);
        add("ppv", result.found != nullptr ? result.found->ppv : std::nullopt, row);
        add("correct", result.chosen != nullptr ? std::optional(result.chosen->correct) : std::nullopt, row);
        json["displays"].push_back(std::move(row));
    }
}

}  // namespace palpa::study
