#include "study/import_bundles.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "files/durable.h"
#include "files/folder_lock.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/sha256.h"
#include "files/text.h"
#include "study/bundle.h"
#include "study/dataset.h"
#include "study/names.h"
#include "study/run_log.h"
#include "study/study_folder.h"
#include "study/trial_log.h"
#include "study/withdrawal.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestBundle_bytes = std::size_t{1} << 30;

Bundle read_whole(const fs::path& file) {
    return read_bundle(files::read_text(file, kLargestBundle_bytes), file.string());
}

// True for runs on a tablet outside the study: the bundle has nothing that only a study has, and no settings that name a
// protocol (a run that was interrupted has none at all).
bool is_single_run(const Bundle& bundle) {
    for (const BundleFile& file : bundle.files) {
        const bool of_study = file.kind == LogFileKind::identity || file.kind == LogFileKind::people ||
                              file.name == "protocol.json" || grows(file.name);
        if (of_study) return false;
        const bool settings = file.name.find("_settings.json") != std::string::npos;
        if (settings && files::Json::accept(file.text) && files::Json::parse(file.text).contains("study")) return false;
    }
    return true;
}

// True if `text` holds all of `other`: files of answers grow only at their end.
bool begins_with(const std::string& text, const std::string& other) {
    return text.compare(0, other.size(), other) == 0;
}

bool is_events(const BundleFile& file) { return file.name.find("_events.tsv") != std::string::npos; }

// Returns the trial that a run of palpation finished; 0 if it was interrupted, if it is one of the two intervals of a forced
// choice, which have the same trial, or if its events cannot be read: the analysis will say so, and the tablets' logs are kept
// all the same.
int finished_trial(const std::string& events_text, const std::string& name) {
    if (name.find("_task-interval_") != std::string::npos) return 0;
    std::vector<std::string> notes;
    try {
        const RunLog run = run_in(events_text, name, notes);
        return run.finished ? run.trial : 0;
    } catch (const files::InputError&) {
        return 0;
    }
}

// The rows of a withdrawal, each with its end, and the text without them. A desk may note what a tablet does not know of, and
// the other way round.
struct SplitAnswers {
    std::string others;
    std::vector<std::string> withdrawals;
};

SplitAnswers split_answers(const std::string& text) {
    SplitAnswers out;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        const std::string row = text.substr(at, end - at);
        if (withdrawal_in(row) != Withdrawal::none)
            out.withdrawals.push_back(row);
        else
            out.others += row;
        at = end;
    }
    return out;
}

bool same_study(const StudyIdentity& a, const StudyIdentity& b) {
    return a.name == b.name && a.version == b.version && a.sha256 == b.sha256 && a.kind.simulated == b.kind.simulated &&
           a.kind.seed == b.kind.seed;
}

bool has_subjects(const fs::path& directory) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(directory, none)) {
        if (entry.path().filename().string().rfind("sub-", 0) == 0) return true;
    }
    return false;
}

// The content of all bundles together, and which part of it is new.
class Plan {
  public:
    explicit Plan(const fs::path& directory) : directory_(directory) {
        if (!fs::exists(directory)) return;
        if (!fs::is_directory(directory))
            throw files::bad_input(directory.string(), "", "a file", "a study's folder, or a name that is free");
        std::vector<std::string> notes;
        for (Person& one : read_people(directory, notes)) known_.emplace(one.code, one);
        identity_ = read_identity(directory);
        logs_without_identity_ = !identity_ && has_subjects(directory);
    }

    void add(const BundleFile& file, const std::string& from) {
        if (file.kind == LogFileKind::people) return add_people_of(file, from);
        if (file.kind == LogFileKind::identity) return add_identity(file, from);
        if (grows(file.name)) return add_answers(file, from);
        if (file.name == "protocol.json") protocols_.emplace(file.sha256, from);
        const auto [it, fresh] = first_.emplace(file.name, std::pair(file.sha256, from));
        if (!fresh && it->second.first != file.sha256) {
            throw files::bad_input(from, file.name, "other content than in " + it->second.second,
                                   "the same, or another name");
        }
        if (!fresh) return;
        if (is_there(file, from)) {
            report.already_there.push_back(file.name);
            return;
        }
        new_.insert(file.name);
        const int trial = is_events(file) ? finished_trial(file.text, file.name) : 0;
        if (trial > 0) finished_.push_back({trial, file.name, from});
    }

    bool is_new(const BundleFile& file, const std::string& from) const {
        const auto it = first_.find(file.name);
        if (new_.count(file.name) == 0) return false;
        if (it->second.first != file.sha256)
            throw files::bad_input(from, file.name, "content that changed while it was read", "the file left alone");
        return true;
    }

    // To be called once all bundles are added: a protocol that is not the one of study.json would keep the whole study
    // from its analysis.
    void check_protocol() const {
        for (const auto& [sha256, from] : protocols_) {
            if (!identity_ || identity_->sha256 == sha256) continue;
            throw files::bad_input(from, "protocol.json", "sha256 " + files::shown(sha256.substr(0, 12)),
                                   files::shown(identity_->sha256.substr(0, 12)) + " as in study.json");
        }
    }

    // To be called once all bundles are added: two tablets on which one participant did the same trial, each in its own
    // way, would keep the whole study from its analysis.
    void check_trials() const {
        if (!is_study()) return;
        std::map<std::pair<std::string, int>, std::string> done;  // by participant's folder and trial
        std::set<std::string> read;
        for (const Finished& one : finished_) {
            const std::string subject = one.name.substr(0, one.name.find('/'));
            if (read.insert(subject).second) {
                for (const fs::path& events : events_files(directory_ / subject)) {
                    const int trial = finished_trial(files::read_text(events), events.string());
                    if (trial > 0) done.emplace(std::pair(subject, trial), events.string());
                }
            }
            const auto [it, fresh] = done.emplace(std::pair(subject, one.trial), one.from + ": " + one.name);
            if (fresh) continue;
            throw files::bad_input(one.from, one.name,
                                   "trial " + std::to_string(one.trial) + " of " + subject + " finished a second time",
                                   "each trial of a participant once: it is in " + it->second + " too");
        }
    }

    bool is_study() const { return identity_.has_value(); }
    StudyKind kind() const { return identity_ ? identity_->kind : StudyKind{}; }

    // The longest version of a file that grows, if it is longer than the folder's.
    struct Answers {
        std::string text;
        std::string from;
        bool there = false;  // the folder has an earlier version
    };
    std::map<std::string, Answers> answers;

    // To be called once all bundles are added: keeps only the answers that are new to the folder. Throws InputError if
    // the folder's answers differ from them.
    void settle_answers() {
        for (auto it = answers.begin(); it != answers.end();) {
            const std::string& name = it->first;
            Answers& most = it->second;
            const fs::path path = directory_ / name;
            most.there = is_taken(name, most.from);
            const std::string there = most.there ? files::read_text(path) : "";
            const SplitAnswers own = split_answers(there), sent = split_answers(most.text);
            const bool goes_on = begins_with(most.text, there);
            if (!begins_with(sent.others, own.others) && !begins_with(own.others, sent.others)) {
                throw files::bad_input(most.from, name, "other answers than in " + path.string(),
                                       "the same ones, or more of them: nothing is overwritten");
            }
            std::string added = sent.others.substr(std::min(sent.others.size(), own.others.size()));
            for (const std::string& row : sent.withdrawals) {
                // who took the data back anywhere took them back
                const auto& noted = own.withdrawals;
                const bool known = std::find(noted.begin(), noted.end(), row) != noted.end();
                if (!known && (noted.empty() || withdrawal_in(row) == Withdrawal::takes_data)) added += row;
            }
            const bool more = !most.there || (goes_on ? most.text.size() > there.size() : !added.empty());
            if (more && !goes_on) most.text = there + added;
            if (!more) report.already_there.push_back(name);
            it = more ? std::next(it) : answers.erase(it);
        }
    }

    BundleReport report;
    std::vector<Person> people;                // that the folder does not have yet
    std::optional<std::string> identity_text;  // of a study.json that the folder does not have yet

  private:
    void add_answers(const BundleFile& file, const std::string& from) {
        const auto [it, fresh] = answers.emplace(file.name, Answers{file.text, from, false});
        Answers& most = it->second;
        if (fresh || begins_with(most.text, file.text)) return;
        if (!begins_with(file.text, most.text)) {
            throw files::bad_input(from, file.name, "other answers than in " + most.from,
                                   "the same ones, or more of them");
        }
        most = {file.text, from, false};
    }

    // True if there is a file of that name; throws if there is something else.
    bool is_taken(const std::string& name, const std::string& from) const {
        fs::path path = directory_;
        for (const fs::path& part : fs::path(name)) {
            path /= part;
            const auto status = fs::symlink_status(path);
            if (fs::is_symlink(status))
                throw files::bad_input(from, name, "a link in the way: " + path.string(), "folders and files");
            if (!fs::exists(status)) return false;
            const bool last = path == directory_ / name;
            if (last ? !fs::is_regular_file(status) : !fs::is_directory(status)) {
                throw files::bad_input(from, name, path.string() + " in the way",
                                       last ? "a file, or nothing" : "a folder, or nothing");
            }
        }
        return true;
    }

    bool is_there(const BundleFile& file, const std::string& from) const {
        if (!is_taken(file.name, from)) return false;
        const fs::path path = directory_ / file.name;
        if (files::sha256_hex(files::read_text(path)) == file.sha256) return true;
        throw files::bad_input(from, file.name, "other content than in " + path.string(),
                               "the same, or a name that is free: nothing is overwritten");
    }

    void add_people_of(const BundleFile& file, const std::string& from) {
        refuse_link(file, from);
        std::vector<std::string> notes;
        for (const Person& one : people_in(file.text, from + ": " + file.name, notes)) {
            if (!is_code(one.code)) {
                throw files::bad_input(from, file.name, files::shown("sub-" + one.code),
                                       "a code of " + std::string(kCodeRule));
            }
            const auto [it, fresh] = known_.emplace(one.code, one);
            if (fresh) {
                people.push_back(one);
            } else if (!(it->second == one)) {
                throw files::bad_input(from, file.name, "sub-" + one.code + " described otherwise than in the study",
                                       "the same participant, or another code");
            }
        }
        if (!notes.empty())
            throw files::bad_input(from, file.name, "a line that is no participant",
                                   "lines with 8 fields: " + notes.front());
    }

    void add_identity(const BundleFile& file, const std::string& from) {
        refuse_link(file, from);
        const StudyIdentity its = identity_in(file.text, from + ": " + file.name);
        if (logs_without_identity_) {
            throw files::bad_input(from, file.name, "a study",
                                   "logs of single runs, as in " + directory_.string() + ", which has no study.json");
        }
        if (identity_ && !same_study(*identity_, its)) {
            throw files::bad_input(from, file.name,
                                   files::shown(its.name) + " version " + files::shown(its.version) + ", sha256 " +
                                       files::shown(its.sha256.substr(0, 12)),
                                   files::shown(identity_->name) + " version " + files::shown(identity_->version) +
                                       ", sha256 " + files::shown(identity_->sha256.substr(0, 12)) +
                                       ": two studies never share a folder");
        }
        if (identity_) return;
        identity_ = its;
        identity_text = file.text;
    }

    void refuse_link(const BundleFile& file, const std::string& from) const {
        if (fs::is_symlink(fs::symlink_status(directory_ / file.name))) {
            throw files::bad_input(from, file.name, "a link in the way", "a file");
        }
    }

    struct Finished {  // a trial that is new to the folder
        int trial;
        std::string name;
        std::string from;
    };

    fs::path directory_;
    std::vector<Finished> finished_;
    std::map<std::string, std::pair<std::string, std::string>> first_;  // name to hash and the bundle it came from
    std::set<std::string> new_;
    std::map<std::string, std::string> protocols_;  // hash to the bundle that it came from
    std::map<std::string, Person> known_;
    std::optional<StudyIdentity> identity_;
    bool logs_without_identity_ = false;
};

// The files that this import has written. The destructor removes them unless keep() was called.
class NewFiles {
  public:
    explicit NewFiles(const fs::path& directory) : directory_(directory) {}
    ~NewFiles() {
        std::error_code ignored;
        for (auto path = paths_.rbegin(); path != paths_.rend(); ++path) fs::remove(*path, ignored);
    }
    NewFiles(const NewFiles&) = delete;
    NewFiles& operator=(const NewFiles&) = delete;

    void write(const std::string& name, const std::string& text) {
        const fs::path path = directory_ / name;
        fs::create_directories(path.parent_path());
        if (!files::write_new_text(path, text))
            throw files::bad_input(path.string(), "", "a file that was not there before",
                                   "the folder left alone meanwhile");
        paths_.push_back(path);
        folders_.insert(path.parent_path());
        folders_.insert(path.parent_path().parent_path());
        folders_.insert(directory_);
    }

    void keep() {
        for (const fs::path& folder : folders_) files::sync_folder(folder.empty() ? fs::path(".") : folder);
        paths_.clear();
    }

  private:
    fs::path directory_;
    std::vector<fs::path> paths_;
    std::set<fs::path> folders_;
};

// A protocol that cannot be read is refused by the analysis, with its key; the tablets' logs are kept all the same.
void describe_study(const fs::path& directory, const Plan& plan) {
    if (!plan.is_study() || !fs::exists(directory / "protocol.json")) return;
    try {
        describe_dataset(directory, read_protocol(directory / "protocol.json"), plan.kind());
    } catch (const files::InputError&) {
    }
}

}  // namespace

BundleReport import_bundles(const std::vector<fs::path>& bundles, const fs::path& directory) {
    Plan plan(directory);
    std::optional<files::FolderLock> lock;
    if (fs::exists(directory)) lock.emplace(directory, kOtherWriter);
    // each bundle is read twice, so that only one is in memory at a time
    std::vector<fs::path> taken, singles;
    for (const fs::path& path : bundles) {
        const Bundle bundle = read_whole(path);
        const bool single = is_single_run(bundle);
        (single ? singles : taken).push_back(path);
        if (single) continue;
        for (const BundleFile& file : bundle.files) plan.add(file, path.string());
    }
    for (const fs::path& path : singles) {
        if (plan.is_study()) {
            plan.report.passed_over.push_back(path.string());
            continue;
        }
        for (const BundleFile& file : read_whole(path).files) plan.add(file, path.string());
        taken.push_back(path);
    }
    plan.check_protocol();
    plan.check_trials();
    plan.settle_answers();
    fs::create_directories(directory);
    if (!lock) lock.emplace(directory, kOtherWriter);
    NewFiles written(directory);
    // first of all, so that after a kill the folder is known for the study's and the same command goes on
    if (plan.identity_text) {
        written.write("study.json", *plan.identity_text);
        plan.report.written.push_back("study.json");
    }
    for (const fs::path& path : taken) {
        Bundle bundle = read_whole(path);
        // the events are written last, since a trial counts as done once they end with `finish`
        std::stable_sort(bundle.files.begin(), bundle.files.end(),
                         [](const BundleFile& a, const BundleFile& b) { return is_events(a) < is_events(b); });
        for (const BundleFile& file : bundle.files) {
            const auto& done = plan.report.written;
            const bool later =
                file.kind == LogFileKind::people || file.kind == LogFileKind::identity || grows(file.name);
            if (later || !plan.is_new(file, path.string())) continue;
            if (std::find(done.begin(), done.end(), file.name) != done.end()) continue;  // alike in two bundles
            written.write(file.name, file.text);
            plan.report.written.push_back(file.name);
        }
    }
    for (const auto& [name, most] : plan.answers) {
        if (most.there) continue;
        written.write(name, most.text);
        plan.report.written.push_back(name);
    }
    written.keep();
    describe_study(directory, plan);
    prepare_log_folder(directory);
    for (const auto& [name, most] : plan.answers) {
        if (!most.there) continue;
        files::write_text_atomically(directory / name, most.text);  // begins with what was there
        plan.report.grown.push_back(name);
    }
    add_people(directory, plan.people);
    plan.report.people_added = static_cast<int>(plan.people.size());
    return plan.report;
}

}  // namespace palpa::study
