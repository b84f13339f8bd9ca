#include "study/run_log.h"

#include <algorithm>
#include <array>
#include <functional>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"
#include "study/count.h"
#include "study/stiffer_counts.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

// Returns a value in seconds, millimetres or newtons, which cannot be negative; NaN for n/a, where nothing was
// measured.
double amount(const files::Table& table, std::size_t column) {
    const double value = table.number(column);
    if (value < 0.0) table.fail(column, "a number from 0 up, or n/a");
    return value;
}

// As amount(), for columns that logs of version 0.1 do not have: NaN if the column is missing.
double amount_or_missing(const files::Table& table, std::string_view column) {
    if (!table.has_column(column)) return std::numeric_limits<double>::quiet_NaN();
    return amount(table, table.column(column));
}

void take_finish(const files::Table& table, RunLog& run) {
    run.finished = true;
    run.duration_s = amount(table, table.column("duration"));
    run.tp = count(table, table.column("tp"));
    run.fp = count(table, table.column("fp"));
    run.fn = count(table, table.column("fn"));
    if (table.has_column("n_nodules") && count(table, table.column("n_nodules")) != run.tp + run.fn) {
        table.fail(table.column("n_nodules"), "tp + fn = " + std::to_string(run.tp + run.fn));
    }
    run.path_m = 1e-3 * amount_or_missing(table, "path_mm");
    run.mean_force_N = amount_or_missing(table, "mean_force_N");
    run.max_force_N = amount_or_missing(table, "max_force_N");
}

// The columns of a table of choices, found once.
struct ChoiceColumns {
    explicit ChoiceColumns(const files::Table& table)
        : reference(table.column("reference_kPa")),
          comparison(table.column("comparison_kPa")),
          first(table.column("first")),
          answer(table.column("answer")),
          correct(table.column("correct")),
          has_reference_on(table.has_column("reference_on")) {
        if (has_reference_on) reference_on = table.column("reference_on");
    }
    std::size_t reference, comparison, first, answer, correct;
    bool has_reference_on;  // logs of earlier versions lack it
    std::size_t reference_on = 0;
};

// Returns whether a field says `reference`, not `comparison`.
bool says_reference(const files::Table& table, std::size_t column) {
    const std::string_view said = table.field(column);
    if (said != "reference" && said != "comparison") table.fail(column, "reference or comparison");
    return said == "reference";
}

void take_choice(const files::Table& table, const ChoiceColumns& columns, RunLog& run) {
    RunLog::Choice choice;
    choice.trial = run.trial;
    choice.condition = run.condition;
    choice.comparison = table.field(columns.comparison);
    choice.reference_kPa = stiffness_kPa(table, columns.reference);
    choice.comparison_kPa = stiffness_kPa(table, columns.comparison);
    choice.reference_first = says_reference(table, columns.first);
    if (columns.has_reference_on && table.field(columns.reference_on) != "n/a")
        choice.reference_on = table.field(columns.reference_on);
    choice.reference_softer = says_reference(table, columns.answer);
    choice.correct = whole_number(table, columns.correct, 0, 1) == 1;
    choice.practice = run.practice;
    choice.seed = run.seed;
    choice.line = table.line();
    const bool right = choice.reference_softer == (choice.reference_kPa < choice.comparison_kPa);
    if (choice.correct != right) {
        table.fail(columns.correct, std::string(right ? "1" : "0") + ": " + std::string(table.field(columns.answer)) +
                                        " was called softer, of " + std::string(table.field(columns.reference)) +
                                        " kPa (reference) and " + choice.comparison + " kPa");
    }
    run.choices.push_back(std::move(choice));
}

// Follows the marks of a run as they are made and undone, and refuses what cannot follow finish.
class EventOrder {
  public:
    explicit EventOrder(const files::Table& table, std::size_t type) : type_(type) {
        has_places_ = table.has_column("x_mm");
        if (has_places_) x_ = table.column("x_mm");
    }

    void take(const files::Table& table, const RunLog& run) {
        const std::string_view type = table.field(type_);
        constexpr std::array<std::string_view, 6> kOfTrial{"start", "mark",   "confidence",
                                                           "undo",  "finish", "interrupted"};
        const bool of_trial = std::find(kOfTrial.begin(), kOfTrial.end(), type) != kOfTrial.end();
        if (run.finished && type == "finish") table.fail(type_, "one row finish; this is a second row finish");
        if (run.finished && of_trial) table.fail(type_, "nothing of the trial after its row finish");
        if (has_places_ && type == "mark" && table.field(x_) != "n/a") ++standing_;
        if (type == "undo" && standing_ > 0) --standing_;
    }

    std::optional<std::int64_t> marks_left() const {
        return has_places_ ? std::optional<std::int64_t>(standing_) : std::nullopt;
    }

  private:
    std::size_t type_;
    bool has_places_ = false;
    std::size_t x_ = 0;
    std::int64_t standing_ = 0;
};

// Lists the events of intervals, or of all other runs, in the order of their numbers.
std::vector<fs::path> files_of_events(const fs::path& subject, bool of_intervals) {
    std::vector<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(subject / "beh", error)) {
        const std::string name = entry.path().filename().string();
        constexpr std::string_view kEnd = "_events.tsv";
        if ((name.find("_task-interval_") != std::string::npos) != of_intervals) continue;
        if (name.size() > kEnd.size() && name.compare(name.size() - kEnd.size(), kEnd.size(), kEnd) == 0)
            files.push_back(entry.path());
    }
    // by length first, so that run-100 comes after run-99
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        const std::string x = a.filename().string(), y = b.filename().string();
        return x.size() != y.size() ? x.size() < y.size() : x < y;
    });
    return files;
}

}  // namespace

std::string_view whole_lines(std::string_view text, const std::string& file, std::vector<std::string>& notes) {
    const auto end = text.rfind('\n');
    const std::string_view whole = end == std::string_view::npos ? std::string_view() : text.substr(0, end + 1);
    if (whole.size() < text.size()) {
        const auto line = 1 + std::count(whole.begin(), whole.end(), '\n');
        notes.push_back(file + ": line " + std::to_string(line) + " is left out: it was cut off after " +
                        std::to_string(text.size() - whole.size()) + " bytes");
    }
    return whole;
}

RunLog read_run(const fs::path& events, std::vector<std::string>& notes) {
    return run_in(files::read_text(events), events, notes);
}

RunLog run_in(const std::string& text, const fs::path& events, std::vector<std::string>& notes) {
    RunLog run;
    run.events = events;
    const std::string_view whole_text = whole_lines(text, events.string(), notes);
    if (whole_text.empty()) return run;  // killed before the first line
    run.text_hash = std::hash<std::string_view>()(whole_text);
    files::Table table(std::string(whole_text), events.string(), '\t');
    const std::size_t type = table.column("trial_type"), trial = table.column("trial");
    const std::size_t condition = table.column("condition"), block = table.column("block"),
                      onset = table.column("onset");
    const bool has_seed = table.has_column("seed");
    const std::size_t seed = has_seed ? table.column("seed") : 0;
    EventOrder order(table, type);
    std::optional<ChoiceColumns> columns;
    double before_s = 0.0;
    while (table.next()) {
        const double onset_s = table.finite_number(onset);
        if (onset_s < before_s) {
            notes.push_back(events.string() + ": line " + std::to_string(table.line()) + ": found the time " +
                            files::short_number(onset_s) + " s after " + files::short_number(before_s) +
                            " s: the clock went back");
        }
        before_s = onset_s;
        const bool choice = table.field(type) == "choice";
        const auto number = static_cast<int>(whole_number(table, trial, 1, kMostCounts));
        if (!choice && run.trial > 0 && (number != run.trial || table.field(condition) != run.condition)) {
            table.fail(number != run.trial ? trial : condition, "the same trial and condition in all rows of a run");
        }
        run.trial = number;
        run.condition = table.field(condition);
        if (table.field(block) != "practice" && table.field(block) != "test") table.fail(block, "practice or test");
        run.practice = table.field(block) == "practice";
        if (has_seed) run.seed = whole_number(table, seed, 0, std::int64_t{1} << 53);
        order.take(table, run);
        if (table.field(type) == "finish") take_finish(table, run);
        if (choice && !columns) columns.emplace(table);
        if (choice) take_choice(table, *columns, run);
    }
    run.marks_left = order.marks_left();
    return run;
}

std::vector<fs::path> events_files(const fs::path& subject) { return files_of_events(subject, false); }

std::vector<fs::path> interval_files(const fs::path& subject) { return files_of_events(subject, true); }

}  // namespace palpa::study
