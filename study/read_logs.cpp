#include "study/read_logs.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "files/input_error.h"
#include "files/json.h"
#include "files/text.h"
#include "study/broken_choices.h"
#include "study/check_logs.h"
#include "study/follow_protocol.h"
#include "study/found_trial.h"
#include "study/name_index.h"
#include "study/ratings.h"
#include "study/stiffer_counts.h"
#include "study/study_folder.h"
#include "study/subject_folders.h"
#include "study/withdrawal.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

// Returns the file of the same run with another ending: ..._events.tsv -> ..._marks.tsv.
fs::path beside(const fs::path& events, std::string_view suffix) {
    constexpr std::string_view kEvents = "_events.tsv";
    std::string name = events.string();
    return name.substr(0, name.size() - kEvents.size()) + std::string(suffix);
}

// What is known of the whole study while its participants are read.
struct Study {
    explicit Study(Observations& out) : found(out), comparisons(out.comparisons) {}

    fs::path directory;
    std::optional<StudyIdentity> identity;
    std::optional<Protocol> protocol;
    std::map<std::string, int> planned_condition;  // index in the protocol
    std::map<std::string, std::string> people;     // of participants.tsv: the group of each code
    Numbers numbers;
    std::map<std::string, int> places;  // in the plan, of the codes whose logs say so
    std::set<std::string> left_out;     // participants of whom all is excluded
    std::set<std::pair<std::string, int>> left_out_trials;
    std::string sha256, sha256_in;                      // of the first trial that names a protocol
    std::unordered_map<std::size_t, std::string> seen;  // file of events by the hash of its text
    NodulesOfConditions nodules_seen;
    FoundTrials found;
    NameIndex comparisons;        // of the observations
    std::set<std::string> typed;  // conditions with answers that were typed in

    bool excludes(const std::string& code, int trial) const {
        return left_out.count(code) > 0 || left_out_trials.count({code, trial}) > 0;
    }
};

void read_protocol_of(Study& study, std::vector<std::string>& notes) {
    const fs::path file = study.directory / "protocol.json";
    if (!study.identity && fs::exists(file)) {
        notes.push_back((study.directory / "study.json").string() +
                        ": is not there; the logs cannot be compared with the plan, nor told from simulated ones");
    }
    if (!study.identity) return;
    if (!fs::exists(file)) {
        notes.push_back(file.string() + ": is not there; the logs cannot be compared with the plan");
        return;
    }
    study.protocol = read_protocol(file);
    if (study.protocol->sha256 != study.identity->sha256) {
        throw files::bad_input(file.string(), "", "sha256 " + study.protocol->sha256.substr(0, 12),
                               study.identity->sha256.substr(0, 12) + " as in study.json: the file was changed");
    }
    if (study.identity->orders_version != kOrdersVersion) {
        notes.push_back((study.directory / "study.json").string() +
                        ": began with another version's orders; the logs are compared with the plan's numbers only");
    }
    for (std::size_t i = 0; i < study.protocol->conditions.size(); ++i)
        study.planned_condition[study.protocol->conditions[i].id] = static_cast<int>(i);
}

// Reads all runs of one participant, in the order of their numbers.
class Subject {
  public:
    Subject(std::string code, int index, Study& study, Observations& out)
        : code_(std::move(code)), index_(index), study_(study), out_(out) {}

    void add(const fs::path& events) {
        const RunLog run = read_run(events, out_.notes);
        files_.push_back(events.string());
        note_copy(run);
        if (seed_ == 0 && run.seed > 0) {
            seed_ = run.choices.empty() ? run.seed : run.choices.front().seed;
            seeded_trial_ = run.choices.empty() ? run.trial : run.choices.front().trial;
        }
        if (!run.choices.empty()) return add_choices(run);
        if (run.trial > 0)
            add_run(run);  // 0: killed before the first row
        else
            ++out_.interrupted_trials;
    }

    // To be called once all runs are added: finds the choices that were broken off, and compares all with the plan.
    void settle(const fs::path& subject) {
        std::set<int> answered;
        for (const auto& [trial, place] : finished_) answered.insert(trial);
        const auto broken = broken_choices(subject, answered, out_.notes);
        out_.interrupted_trials += static_cast<std::int64_t>(broken.size());
        if (!study_.protocol) return;
        const auto likely = study_.numbers.number(code_);
        int number = number_.value_or(likely);
        bool known = number_.has_value();
        if (!number_ && seed_ > 0) {
            const auto found = number_with_seed(*study_.protocol, seeded_trial_, seed_, likely,
                                                static_cast<int>(study_.people.size()));
            if (!found) {
                out_.notes.push_back("sub-" + code_ + ": the seed of trial " + std::to_string(seeded_trial_) +
                                     " is not that of any participant's plan");
            }
            number = found.value_or(likely);
            known = found.has_value();
        }
        if (known) study_.places[code_] = number;
        const PlannedParticipant plan = plan_participant(*study_.protocol, number);
        const bool same_orders = study_.identity->orders_version == kOrdersVersion;
        const auto person = study_.people.find(code_);
        if (known && same_orders && person != study_.people.end())
            check_group(study_.directory, code_, person->second, study_.protocol->groups[plan.group].id);
        if (last_trial_ > static_cast<int>(plan.trials.size())) {
            throw files::bad_input(text(last_place_), "trial", std::to_string(last_trial_),
                                   "1 to " + std::to_string(plan.trials.size()) + ", as the protocol plans them");
        }
        for (const BrokenChoice& one : broken) log_broken(one, plan);
        std::vector<std::string> of_other_orders;
        auto& notes = same_orders ? out_.notes : of_other_orders;
        auto rows = compare_with_plan(*study_.protocol, plan, code_, logged_, notes);
        for (const Replacement& one : out_.replacements) {
            if (one.participant != code_) continue;
            for (Progress& row : rows) row.replaced_by = one.replaced_by;
        }
        out_.progress.insert(out_.progress.end(), rows.begin(), rows.end());
    }

    bool has_finished(int trial) const { return finished_.count(trial) > 0; }

  private:
    void note_copy(const RunLog& run) {
        if (!run.finished && run.choices.empty()) return;
        const auto [it, fresh] = study_.seen.emplace(run.text_hash, run.events.string());
        if (!fresh) out_.notes.push_back(run.events.string() + ": holds the same bytes as " + it->second + ": a copy?");
    }

    // A line of one of this participant's files.
    struct Place {
        std::size_t file = 0;
        std::size_t line = 0;  // 0: the whole file
    };
    std::string text(const Place& place) const {
        return files_[place.file] + (place.line > 0 ? ": line " + std::to_string(place.line) : "");
    }

    // Notes what the log says of a trial, for the comparison with the plan.
    Logged& log(const Place& place, const std::string& condition, int trial, bool practice, bool finished,
                std::int64_t seed) {
        if (trial > last_trial_) last_place_ = place;
        last_trial_ = std::max(last_trial_, trial);
        const auto it = study_.planned_condition.find(condition);
        if (study_.protocol && it == study_.planned_condition.end()) {
            throw files::bad_input(text(place), "condition", files::shown(condition),
                                   "a condition of " + (study_.directory / "protocol.json").string());
        }
        const int index = it == study_.planned_condition.end() ? 0 : it->second;
        logged_.push_back({trial, index, practice, finished, finished && study_.excludes(code_, trial)});
        logged_.back().seed = seed;
        return logged_.back();
    }

    // An interval is of the surface's condition, which need not be that of the choice: the plan tells it.
    void log_broken(const BrokenChoice& one, const PlannedParticipant& plan) {
        const auto n = plan.trials.size();
        if (static_cast<std::size_t>(one.trial) > n) {
            throw files::bad_input(one.events.string(), "trial", std::to_string(one.trial),
                                   "1 to " + std::to_string(n) + ", as the protocol plans them");
        }
        if (one.trial == 0) return;
        const std::size_t condition = plan.trials[static_cast<std::size_t>(one.trial) - 1].condition;
        logged_.push_back({one.trial, static_cast<int>(condition), one.practice, false, false});
    }

    void finish_once(const Place& place, int trial) {
        const auto [it, fresh] = finished_.emplace(trial, place);
        if (fresh) return;
        throw files::bad_input(text(place), "trial", std::to_string(trial) + " finished a second time",
                               "once: it is in " + text(it->second) + " too");
    }

    void add_choices(const RunLog& run) {
        for (const RunLog::Choice& choice : run.choices) {
            const Place place{files_.size() - 1, choice.line};
            finish_once(place, choice.trial);
            Logged& logged = log(place, choice.condition, choice.trial, choice.practice, true, choice.seed);
            if (study_.protocol) check_pair(*study_.protocol, text(place), choice, logged);
            if (choice.practice) {
                ++out_.practice_trials;
            } else if (logged.excluded) {
                ++out_.excluded_trials;
            } else {
                const int condition = study_.found.conditions.of(choice.condition);
                out_.choices.push_back(
                    {condition, index_, study_.comparisons.of(choice.comparison + " kPa"), choice.correct ? 1 : 0, 1});
                out_.stiffer.push_back(stiffer_choice(
                    {choice.reference_kPa, choice.comparison_kPa, choice.reference_first, !choice.reference_on.empty()},
                    choice.reference_softer));
                out_.stiffer.back().condition = condition;
                out_.stiffer.back().participant = index_;
            }
        }
    }

    void add_run(const RunLog& run) {
        const Place place{files_.size() - 1};
        const RunSettings settings = settings_of_run(run);
        check_version(run, settings);
        note_clock(run.events);
        out_.simulated = out_.simulated || settings.simulated;
        const bool of_study = study_.identity || !settings.sha256.empty();
        if (of_study && run.finished) finish_once(place, run.trial);
        const bool excluded = log(place, run.condition, run.trial, run.practice, run.finished, run.seed).excluded;
        if (!run.finished) {
            ++out_.interrupted_trials;
            return;
        }
        if (settings.typed) study_.typed.insert(run.condition);
        if (!settings.there) {
            out_.notes.push_back(beside(run.events, "_settings.json").string() +
                                 ": is not there; nodules that were missed cannot be told apart");
        } else if (study_.protocol) {
            study_.nodules_seen.compare(run.condition, beside(run.events, "_settings.json").string(), settings.nodules,
                                        out_.notes);
        }
        const auto marks = read_marks_left(beside(run.events, "_marks.tsv"), out_.notes);
        if (!marks) out_.notes.push_back(beside(run.events, "_marks.tsv").string() + ": is not there");
        check_counts(run, settings, marks.value_or(std::vector<LoggedMark>{}));
        if (run.practice) {
            ++out_.practice_trials;
        } else if (excluded) {
            ++out_.excluded_trials;
        } else {
            // older logs hold such trials; now they are interrupted and repeated
            if (run.max_force_N == 0.0 && run.tp + run.fp == 0)
                out_.notes.push_back(run.events.string() +
                                     ": was finished without a touch; its nodules count as missed");
            study_.found.add(run, index_, settings, marks.value_or(std::vector<LoggedMark>{}));
        }
    }

    // Reads the settings of a run. Those of an interrupted one may be damaged by the power cut that ended it.
    RunSettings settings_of_run(const RunLog& run) {
        const fs::path file = beside(run.events, "_settings.json");
        if (run.finished) return read_run_settings(file);
        try {
            return read_run_settings(file);
        } catch (const files::InputError& error) {
            out_.notes.push_back(error.what() + std::string(" (of an interrupted trial)"));
            return {};
        }
    }

    void check_version(const RunLog& run, const RunSettings& settings) {
        const std::string file = beside(run.events, "_settings.json").string();
        if (study_.identity && settings.there && settings.sha256.empty()) {
            throw files::bad_input(file, "study", "none: a single run",
                                   "a trial of the protocol in study.json: single runs never share a study's folder");
        }
        if (settings.number && number_ && *settings.number != *number_) {
            throw files::bad_input(file, "study.participant_number", std::to_string(*settings.number),
                                   std::to_string(*number_) + " as in this participant's trials before it");
        }
        if (settings.number) number_ = settings.number;
        if (settings.sha256.empty()) return;
        if (study_.sha256.empty()) {
            study_.sha256 = study_.identity ? study_.identity->sha256 : settings.sha256;
            study_.sha256_in = study_.identity ? "study.json" : file;
        }
        if (settings.sha256 == study_.sha256) return;
        throw files::bad_input(file, "study.sha256", files::shown(settings.sha256.substr(0, 12)),
                               files::shown(study_.sha256.substr(0, 12)) + " as in " + study_.sha256_in +
                                   ": two versions of a protocol in one folder");
    }

    // Notes a run that began before the one with the number before. Times are UTC in ISO 8601, which sorts as text.
    void note_clock(const fs::path& events) {
        const std::string began = began_utc(beside(events, "_performance.json"));
        if (began.empty()) return;
        if (!last_began_.empty() && began < last_began_) {
            out_.notes.push_back(events.string() + ": began at " + began +
                                 " by the computer's clock, before the run before it (" + last_began_ +
                                 "): the clock was set back. Times within trials are of the steady clock and hold");
        }
        last_began_ = began;
    }

    std::string code_;
    int index_;
    Study& study_;
    Observations& out_;
    std::optional<int> number_;  // in the plan, as the settings say
    std::int64_t seed_ = 0;      // of the first trial that has one
    int seeded_trial_ = 1;
    std::vector<Logged> logged_;
    std::vector<std::string> files_;  // of events, as they were added
    std::unordered_map<int, Place> finished_;
    int last_trial_ = 0;
    Place last_place_;
    std::string last_began_;
};

// A tablet counts its own participants: who begins there has that count's place, not that of who was to be replaced.
void note_other_places(const Study& study, Observations& out) {
    for (const Replacement& one : out.replacements) {
        const auto left = study.places.find(one.participant), came = study.places.find(one.replaced_by);
        if (left == study.places.end() || came == study.places.end()) continue;
        const PlannedParticipant plan = plan_participant(*study.protocol, left->second);
        const PlannedParticipant other = plan_participant(*study.protocol, came->second);
        if (plan.group == other.group && plan.order_id == other.order_id) continue;
        out.notes.push_back((study.directory / "replacements.tsv").string() + ": " + one.replaced_by +
                            " has not the group and order of " + one.participant + ", whose place this is (number " +
                            std::to_string(came->second) + " in the plan, and " + std::to_string(left->second) +
                            "): tablets know of no replacement");
    }
}

}  // namespace

Observations read_study(const fs::path& directory) {
    Observations out;
    out.from_logs = true;
    Study study(out);
    study.directory = directory;
    study.identity = read_identity(directory);
    if (study.identity) out.simulated = study.identity->kind.simulated;
    const std::vector<Person> people = read_people(directory, out.notes);  // refuses a code that appears twice
    const std::string left_out_line = out.notes.empty() ? "" : "; " + out.notes.front();
    for (const Person& one : people) study.people.emplace(one.code, one.group);
    out.exclusions = read_exclusions(directory);
    out.replacements = read_replacements(directory);
    study.numbers = numbers_of(people, out.replacements);
    for (const Replacement& one : out.replacements) study.left_out.insert(one.participant);
    for (const Exclusion& one : out.exclusions) {
        if (!one.trial) study.left_out.insert(one.participant);
        if (one.trial) study.left_out_trials.insert({one.participant, *one.trial});
    }
    read_protocol_of(study, out.notes);
    std::set<std::string> codes = subject_codes(directory, out.notes);
    const std::set<std::string> with_folder = codes;
    for (const Person& one : people) codes.insert(one.code);
    std::set<std::pair<std::string, int>> finished;
    for (const std::string& code : codes) {
        const auto files = events_files(directory / ("sub-" + code));
        const bool withdrew = takes_data(directory, code, out.notes);
        if (withdrew) study.left_out.insert(code);
        out.withdrawn_people += withdrew && !files.empty();
        out.people_without_trial += files.empty() && study.people.count(code) > 0;
        if (!files.empty() && !withdrew) out.participants.push_back(code);
        const int index = static_cast<int>(out.participants.size()) - 1;
        if (!files.empty() && study.identity && study.people.count(code) == 0) {
            throw files::bad_input((directory / "participants.tsv").string(), "",
                                   "no line of sub-" + code + ", who has logs",
                                   "a line for each participant" + left_out_line);
        }
        const auto excluded = out.excluded_trials;
        Subject reader(code, index, study, out);
        for (const fs::path& events : files) reader.add(events);
        // who left before the first questions were answered has no place in the plan
        const fs::path subject = directory / ("sub-" + code);
        if (!files.empty() || study.people.count(code) > 0) reader.settle(subject);
        if (withdrew) out.withdrawn_trials += out.excluded_trials - excluded;
        for (const auto& [who, trial] : study.left_out_trials) {
            if (who == code && reader.has_finished(trial)) finished.insert({who, trial});
        }
        if (with_folder.count(code) == 0 || study.left_out.count(code) > 0) continue;
        const std::vector<Rating> given = read_ratings(directory, code, out.notes);
        const Protocol* protocol = study.protocol ? &*study.protocol : nullptr;
        for (const Rating& r : answers_to_questions(protocol, code, given, out.notes)) {
            out.answers.push_back({r.condition, r.item, r.value, files.empty() ? -1 : index, r.chosen});
        }
    }
    note_other_places(study, out);
    std::set<std::string> begun;
    for (const Progress& row : out.progress) begun.insert(row.participant);
    for (Progress& row : out.progress) row.counts = begun.count(row.replaced_by) == 0;
    check_exclusions(directory, study.left_out, study.left_out_trials, codes, finished);
    take_staircases(directory, study.left_out, study.left_out_trials, out);
    const auto uncounted = out.interrupted_trials + out.practice_trials + out.excluded_trials;
    if (out.rows.empty() && out.stiffer.empty() && uncounted == 0) {
        throw files::bad_input(directory.string(), "", "no trial", "sub-XX/beh/..._events.tsv of one trial at least");
    }
    if (!study.identity && !study.sha256.empty() && !fs::exists(directory / "protocol.json")) {
        out.notes.push_back(
            directory.string() +
            ": study.json and protocol.json are not there, though settings name a protocol; the logs cannot be "
            "compared with the plan");
    }
    take_groups(people, out);
    if (study.protocol) {
        follow_protocol(*study.protocol, out);
    } else if (fs::exists(directory / "protocol.json")) {
        follow_protocol(read_protocol(directory / "protocol.json"), out);
    }
    for (ConditionDisplay& one : out.displays) one.typed_in = one.typed_in || study.typed.count(one.condition) > 0;
    return out;
}

}  // namespace palpa::study
