#include "study/read_logs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "files/input_error.h"
#include "files/json.h"
#include "files/table.h"
#include "files/text.h"
#include "study/count.h"
#include "study/follow_protocol.h"
#include "study/ratings.h"
#include "study/stiffer_counts.h"
#include "study/study_folder.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

// Returns the file of the same run with another ending: ..._events.tsv -> ..._marks.tsv.
fs::path beside(const fs::path& events, std::string_view suffix) {
    constexpr std::string_view kEvents = "_events.tsv";
    std::string name = events.string();
    return name.substr(0, name.size() - kEvents.size()) + std::string(suffix);
}

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

void take_choice(const files::Table& table, RunLog& run) {
    const bool correct = whole_number(table, table.column("correct"), 0, 1) == 1;
    run.choices.push_back(
        {run.trial, run.condition, std::string(table.field(table.column("comparison_kPa"))), correct, run.practice});
    const StifferAnswers level = stiffer_choice(table);
    run.choices.back().axis = level.axis;
    run.choices.back().x = level.x;
    run.choices.back().stiffer = level.stiffer == 1;
}

struct Settings {
    std::string sha256;  // of the protocol; empty for a single run
    std::vector<std::string> nodules;
    bool simulated = false;
};

Settings read_settings(const fs::path& file, std::vector<std::string>& notes) {
    Settings out;
    if (!fs::exists(file)) {
        notes.push_back(file.string() + ": is not there; nodules that were missed cannot be told apart");
        return out;
    }
    const files::Json root = files::read_json(file);
    files::JsonReader json(root, file.string());
    if (auto study = json.optional_object("study")) {
        out.sha256 = study->text("sha256", "");
        out.simulated = study->boolean("simulated", false);
    }
    for (files::JsonReader& nodule : json.objects("nodules")) out.nodules.push_back(nodule.text("id"));
    return out;
}

std::set<std::string> read_hits(const fs::path& file, std::vector<std::string>& notes) {
    std::set<std::string> hits;
    if (!fs::exists(file)) {
        notes.push_back(file.string() + ": is not there");
        return hits;
    }
    const std::string text = files::read_text(file);
    files::Table table(std::string(whole_lines(text, file.string(), notes)), file.string(), '\t');
    const std::size_t nodule = table.column("nodule"), hit = table.column("hit");
    while (table.next()) {
        if (whole_number(table, hit, 0, 1) == 1) hits.insert(std::string(table.field(nodule)));
    }
    return hits;
}

std::string began_utc(const fs::path& file) {
    if (!fs::exists(file)) return "";  // written last, so an interrupted trial has none
    const files::Json json = files::read_json(file);
    return json.contains("began_utc") && json["began_utc"].is_string() ? json["began_utc"].get<std::string>() : "";
}

void add_find(const RunLog& run, int participant, const Settings& settings, std::map<std::pair<int, int>, int>& repeats,
              Observations& out) {
    const int condition = index_of(run.condition, out.conditions);
    const int repeat = repeats[{participant, condition}]++;
    const std::set<std::string> hits = read_hits(beside(run.events, "_marks.tsv"), out.notes);
    std::int64_t found = 0;
    for (const std::string& id : settings.nodules) {
        const bool hit = hits.count(id) > 0;
        found += hit;
        out.rows.push_back({condition, participant, index_of(id, out.nodules), repeat, hit, !hit, 0});
    }
    const auto n = static_cast<std::int64_t>(settings.nodules.size());
    if (n == 0) {
        out.rows.push_back({condition, participant, -1, repeat, run.tp, run.fn, run.fp});
    } else {
        if (found != run.tp || n != run.tp + run.fn) {
            throw files::bad_input(
                run.events.string(), "finish",
                std::to_string(run.tp) + " found and " + std::to_string(run.fn) + " missed",
                std::to_string(found) + " of " + std::to_string(n) + " as the marks and the settings beside it say");
        }
        out.rows.push_back({condition, participant, -1, repeat, 0, 0, run.fp});
    }
    out.trials.push_back({condition, participant, run.duration_s, run.path_m, run.mean_force_N, run.max_force_N});
}

void add_choices(const RunLog& run, int participant, Observations& out) {
    for (const RunLog::Choice& choice : run.choices) {
        if (choice.practice) {
            ++out.practice_trials;
            continue;
        }
        Choices row;
        row.condition = index_of(choice.condition, out.conditions);
        row.participant = participant;
        row.comparison = index_of(choice.comparison + " kPa", out.comparisons);
        row.correct = choice.correct ? 1 : 0;
        row.n = 1;
        out.choices.push_back(row);
        if (!std::isnan(choice.x))
            out.stiffer.push_back({row.condition, participant, choice.axis, choice.x, choice.stiffer ? 1 : 0, 1});
    }
}

// Reads all runs of one participant, in the order of their numbers.
class Subject {
  public:
    explicit Subject(int index) : index_(index) {}

    void add(const fs::path& events, const std::optional<StudyIdentity>& identity, Observations& out) {
        const RunLog run = read_run(events, out.notes);
        if (identity) refuse_answered_twice(run);
        add_choices(run, index_, out);
        if (!run.choices.empty()) return;
        const Settings settings =
            run.finished ? read_settings(beside(events, "_settings.json"), out.notes) : Settings{};
        check_version(events, settings, identity);
        note_clock(events, out.notes);
        out.simulated = out.simulated || settings.simulated;
        if (!run.finished) {
            ++out.interrupted_trials;
            return;
        }
        if (run.practice) {
            ++out.practice_trials;
            return;
        }
        const auto [it, fresh] = finished_.emplace(run.trial, events.string());
        if (identity && !fresh) {
            throw files::bad_input(events.string(), "trial", std::to_string(run.trial) + " finished a second time",
                                   "once: it is in " + it->second + " too");
        }
        add_find(run, index_, settings, repeats_, out);
    }

  private:
    void refuse_answered_twice(const RunLog& run) {
        for (const RunLog::Choice& choice : run.choices) {
            const auto [it, fresh] = answered_.emplace(choice.trial, run.events.string());
            if (fresh) continue;
            throw files::bad_input(run.events.string(), "trial",
                                   std::to_string(choice.trial) + " answered a second time",
                                   "once: it is in " + it->second + " too");
        }
    }

    static void check_version(const fs::path& events, const Settings& settings,
                              const std::optional<StudyIdentity>& identity) {
        if (!identity || settings.sha256.empty() || settings.sha256 == identity->sha256) return;
        throw files::bad_input(beside(events, "_settings.json").string(), "study.sha256",
                               files::shown(settings.sha256.substr(0, 12)),
                               files::shown(identity->sha256.substr(0, 12)) +
                                   " as in study.json: two versions of a protocol in one folder");
    }

    // Notes a run that began before the one with the number before. Times are UTC in ISO 8601, which sorts as text.
    void note_clock(const fs::path& events, std::vector<std::string>& notes) {
        const std::string began = began_utc(beside(events, "_performance.json"));
        if (began.empty()) return;
        if (!last_began_.empty() && began < last_began_) {
            notes.push_back(events.string() + ": began at " + began +
                            " by the computer's clock, before the run before it (" + last_began_ +
                            "): the clock was set back. Times within trials are of the steady clock and hold");
        }
        last_began_ = began;
    }

    int index_;
    std::map<int, std::string> finished_;
    std::map<int, std::string> answered_;  // of forced choices
    std::map<std::pair<int, int>, int> repeats_;
    std::string last_began_;
};

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
    RunLog run;
    run.events = events;
    const std::string text = files::read_text(events);
    const std::string_view whole_text = whole_lines(text, events.string(), notes);
    if (whole_text.empty()) return run;  // killed before the first line
    files::Table table(std::string(whole_text), events.string(), '\t');
    const std::size_t type = table.column("trial_type"), trial = table.column("trial");
    const std::size_t condition = table.column("condition"), block = table.column("block"),
                      onset = table.column("onset");
    double before_s = 0.0;
    while (table.next()) {
        const double onset_s = table.finite_number(onset);
        if (onset_s < before_s) {
            notes.push_back(events.string() + ": line " + std::to_string(table.line()) + ": found the time " +
                            files::short_number(onset_s) + " s after " + files::short_number(before_s) +
                            " s: the clock went back");
        }
        before_s = onset_s;
        run.trial = static_cast<int>(whole_number(table, trial, 1, kMostCounts));
        run.condition = table.field(condition);
        run.practice = table.field(block) == "practice";
        if (table.field(type) == "finish") take_finish(table, run);
        if (table.field(type) == "choice") take_choice(table, run);
    }
    return run;
}

std::vector<fs::path> events_files(const fs::path& subject) {
    std::vector<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(subject / "beh", error)) {
        const std::string name = entry.path().filename().string();
        constexpr std::string_view kEnd = "_events.tsv";
        if (name.find("_task-interval_") != std::string::npos) continue;
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

namespace {

// A folder that was copied by hand to another code would count its person twice.
void refuse_copy(const fs::path& subject, const fs::path& events) {
    const std::string own = subject.filename().string();
    const std::string name = events.filename().string();
    if (name.rfind(own + "_", 0) == 0) return;
    throw files::bad_input(events.string(), "", "a log of " + name.substr(0, name.find('_')), "one of " + own);
}

}  // namespace

Observations read_study(const fs::path& directory) {
    Observations out;
    const auto identity = read_identity(directory);
    if (identity) out.simulated = identity->kind.simulated;
    const std::vector<Person> people = read_people(directory, out.notes);  // refuses a code that appears twice
    std::vector<fs::path> subjects;
    for (const auto& entry : fs::directory_iterator(directory)) {
        if (entry.path().filename().string().rfind("sub-", 0) == 0) subjects.push_back(entry.path());
    }
    std::sort(subjects.begin(), subjects.end());
    for (const fs::path& subject : subjects) {
        out.participants.push_back(subject.filename().string().substr(4));
        Subject reader(static_cast<int>(out.participants.size()) - 1);
        for (const fs::path& events : events_files(subject)) {
            refuse_copy(subject, events);
            reader.add(events, identity, out);
        }
        for (const Rating& r : read_ratings(directory, out.participants.back(), out.notes))
            out.answers.push_back({r.condition, r.item, r.value, static_cast<int>(out.participants.size()) - 1});
    }
    if (out.rows.empty() && out.choices.empty() && out.interrupted_trials + out.practice_trials == 0) {
        throw files::bad_input(directory.string(), "", "no trial", "sub-XX/beh/..._events.tsv of one trial at least");
    }
    take_groups(people, out);
    if (fs::exists(directory / "protocol.json")) follow_protocol(read_protocol(directory / "protocol.json"), out);
    return out;
}

}  // namespace palpa::study
