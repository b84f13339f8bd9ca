#include "study/staircase_history.h"

#include <algorithm>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"
#include "study/count.h"
#include "study/read_logs.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

int level_in(const StaircaseTask& task, const files::Table& table, std::size_t column) {
    const double kPa = table.finite_number(column);
    const auto at = std::find(task.comparisons_kPa.begin(), task.comparisons_kPa.end(), kPa);
    if (at == task.comparisons_kPa.end()) table.fail(column, "one of staircase.comparisons_kPa of the protocol");
    return static_cast<int>(at - task.comparisons_kPa.begin());
}

void read_steps(const fs::path& file, const Protocol& protocol, const std::string& condition_id,
                const std::set<int>& left_out, std::vector<StaircaseAnswer>& out) {
    std::vector<std::string> notes;  // read_study() gives them to the reader of the report
    const std::string text = files::read_text(file);
    const std::string_view whole = whole_lines(text, file.string(), notes);
    if (whole.empty()) return;
    files::Table table(std::string(whole), file.string(), '\t');
    const std::size_t trial = table.column("trial"), block = table.column("block"),
                      condition = table.column("condition"), comparison = table.column("comparison_kPa"),
                      first = table.column("first"), correct = table.column("correct");
    while (table.next()) {
        if (table.field(block) == "practice" || table.field(condition) != condition_id) continue;
        if (!left_out.empty() && left_out.count(static_cast<int>(whole_number(table, trial, 1, kMostCounts))) > 0)
            continue;
        out.push_back({level_in(protocol.staircase, table, comparison), table.field(first) == "reference",
                       whole_number(table, correct, 0, 1) == 1});
    }
}

std::set<int> trials_of(const std::string& code, const std::set<std::pair<std::string, int>>& left_out) {
    std::set<int> trials;
    for (const auto& [who, trial] : left_out) {
        if (who == code) trials.insert(trial);
    }
    return trials;
}

void note_other_levels(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers, const std::string& code,
                       const std::string& condition, std::vector<std::string>& notes) {
    const int others = answers_at_other_levels(task, answers);
    if (others == 0) return;
    notes.push_back("sub-" + code + ": " + std::to_string(others) + " of " + std::to_string(answers.size()) +
                    " answers of the staircase under " + files::shown(condition) +
                    " are at a level that the answers before them do not ask for");
}

}  // namespace

std::vector<StaircaseAnswer> staircase_answers(const fs::path& directory, const Protocol& protocol,
                                               const std::string& code, std::size_t condition,
                                               const std::set<int>& left_out) {
    std::vector<StaircaseAnswer> out;
    for (const fs::path& file : events_files(directory / ("sub-" + code))) {
        if (file.filename().string().find("_task-softer_") == std::string::npos) continue;
        read_steps(file, protocol, protocol.conditions[condition].id, left_out, out);
    }
    return out;
}

std::vector<StaircaseResult> staircase_results(const fs::path& directory, const std::vector<std::string>& participants,
                                               const std::set<std::pair<std::string, int>>& left_out,
                                               std::vector<std::string>& notes) {
    std::vector<StaircaseResult> out;
    if (!fs::exists(directory / "protocol.json")) return out;
    const Protocol protocol = read_protocol(directory / "protocol.json");
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        if (task_of(protocol, i) != TaskKind::staircase) continue;
        for (const std::string& code : participants) {
            const auto answers = staircase_answers(directory, protocol, code, i, trials_of(code, left_out));
            note_other_levels(protocol.staircase, staircase_answers(directory, protocol, code, i), code,
                              protocol.conditions[i].id, notes);
            if (answers.empty()) continue;
            out.push_back(
                {protocol.conditions[i].id, code, protocol.staircase.method, estimate_of(protocol.staircase, answers)});
        }
    }
    return out;
}

}  // namespace palpa::study
