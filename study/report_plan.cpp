// The part of a report that says what was planned, what was done, and what was left out.

#include <algorithm>
#include <map>

#include "study/report.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

// Sums over all places of the plan, each by who has it now, in the order in which conditions appear.
std::vector<Progress> progress_by_condition(const std::vector<Progress>& rows) {
    std::vector<Progress> sums;
    std::map<std::string, std::size_t> place;
    for (const Progress& row : rows) {
        const auto [it, fresh] = place.emplace(row.condition, sums.size());
        if (fresh) sums.push_back({"", "", row.condition});
        if (!row.counts) continue;
        Progress& sum = sums[it->second];
        sum.planned += row.planned;
        sum.finished += row.finished;
        sum.interrupted += row.interrupted;
        sum.excluded += row.excluded;
    }
    return sums;
}

// A sum of rows misses what each row misses: one participant's surplus does not make up for another's gap.
int missing_of(const std::vector<Progress>& rows, const std::string& condition) {
    int missing = 0;
    for (const Progress& row : rows) missing += row.condition == condition ? row.missing() : 0;
    return missing;
}

std::string exclusion_scope(const Exclusion& one) { return one.trial ? std::to_string(*one.trial) : "all"; }

files::Json progress_json(const Progress& row) {
    return {{"condition", row.condition},     {"planned", row.planned},   {"finished", row.finished},
            {"interrupted", row.interrupted}, {"missing", row.missing()}, {"excluded", row.excluded}};
}

}  // namespace

void add_plan_json(const Report& report, files::Json& json) {
    json["excluded_trials"] = report.excluded_trials;
    json["withdrawn_trials"] = report.withdrawn_trials;
    json["plan"] = files::Json::array();
    for (const Progress& row : report.progress) {
        files::Json entry{{"participant", row.participant}, {"group", row.group}};
        entry["replaced_by"] = row.replaced_by.empty() ? files::Json(nullptr) : files::Json(row.replaced_by);
        entry.update(progress_json(row));
        json["plan"].push_back(std::move(entry));
    }
    json["exclusions"] = files::Json::array();
    for (const Exclusion& one : report.exclusions) {
        json["exclusions"].push_back({{"participant", one.participant},
                                      {"trial", one.trial ? files::Json(*one.trial) : files::Json(nullptr)},
                                      {"reason", one.reason}});
    }
    json["replacements"] = files::Json::array();
    for (const Replacement& one : report.replacements) {
        json["replacements"].push_back(
            {{"participant", one.participant}, {"replaced_by", one.replaced_by}, {"reason", one.reason}});
    }
}

std::vector<ReportTable> plan_tables(const Report& report) {
    const std::vector<std::string> counts{"planned", "finished", "interrupted", "missing", "excluded"};
    ReportTable sums{"plan", "Logs against the plan: tests by condition, each place once", {"condition"}, {}};
    ReportTable all{"plan_participants",
                    "Logs against the plan: tests by participant and condition",
                    {"participant", "group", "condition", "replaced_by"},
                    {}};
    ReportTable left_out{"exclusions", "Left out by the experimenter", {"participant", "trial", "reason"}, {}};
    for (ReportTable* table : {&sums, &all}) table->columns.insert(table->columns.end(), counts.begin(), counts.end());
    const auto add = [](ReportTable& table, std::vector<std::string> row, const Progress& one, int missing) {
        for (const int count : {one.planned, one.finished, one.interrupted, missing, one.excluded})
            row.push_back(std::to_string(count));
        table.rows.push_back(std::move(row));
    };
    for (const Progress& row : progress_by_condition(report.progress))
        add(sums, {row.condition}, row, missing_of(report.progress, row.condition));
    for (const Progress& row : report.progress)
        add(all, {row.participant, row.group, row.condition, row.replaced_by.empty() ? kNone : row.replaced_by}, row,
            row.missing());
    for (const Replacement& one : report.replacements) {
        left_out.rows.push_back(
            {one.participant, "all", "dropped out, replaced by " + one.replaced_by + ": " + one.reason});
    }
    for (const Exclusion& one : report.exclusions)
        left_out.rows.push_back({one.participant, exclusion_scope(one), one.reason});
    return {sums, all, left_out};
}

std::string plan_summary(const Report& report) {
    Progress sum;
    int missing = 0;
    for (const Progress& row : report.progress) {
        if (!row.counts) continue;
        sum.planned += row.planned;
        sum.finished += row.finished;
        missing += row.missing();
    }
    std::string out;
    if (!report.progress.empty()) {
        const auto are = [](int n) { return whole(n) + (n == 1 ? " is " : " are "); };
        out += "\nOf " + number_of(sum.planned, "planned test") + " " + are(sum.finished) + "finished and " +
               are(missing) + "missing (table of the plan).\n";
    }
    const auto left_out = [](std::int64_t n) {
        return "\n" + number_of(n, "finished test") + (n == 1 ? " is" : " are") + " left out ";
    };
    const auto decided = report.excluded_trials - report.withdrawn_trials;
    if (decided > 0) out += left_out(decided) + "by the experimenter's decision (table of exclusions).\n";
    if (report.withdrawn_trials > 0)
        out += left_out(report.withdrawn_trials) + "because their participants withdrew the data (notes below).\n";
    return out;
}

}  // namespace palpa::study
