#include "study/study_folder.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "files/append_file.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/text.h"
#include "study/dataset.h"
#include "study/exclusions.h"
#include "study/names.h"
#include "study/rows.h"
#include "study/run_log.h"
#include "study/sample_log.h"
#include "study/trial_log.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPeopleHeader =
    "participant_id\tage\tsex\thandedness\tvision\tpalpation_experience\tvr_experience\tgroup\n";

std::string line_of(const Person& p) {
    std::string line = "sub-" + p.code;
    for (const std::string* field :
         {&p.age, &p.sex, &p.handedness, &p.vision, &p.palpation_experience, &p.vr_experience, &p.group}) {
        line += "\t";
        append_field(*field, line);
    }
    return line + "\n";
}

std::string version_text(const std::string& version, const std::string& sha256) {
    return "version " + files::shown(version) + " (sha256 " + sha256.substr(0, 12) + "...)";
}

bool has_logs(const fs::path& directory) {
    for (const auto& entry : fs::directory_iterator(directory)) {
        if (entry.path().filename().string().rfind("sub-", 0) == 0) return true;
    }
    return false;
}

void check_same(const fs::path& file, const StudyIdentity& found, const Protocol& protocol, const StudyKind& kind) {
    if (found.sha256 != protocol.sha256) {
        throw files::bad_input(file.string(), "sha256",
                               files::shown(found.name) + " " + version_text(found.version, found.sha256),
                               files::shown(protocol.name) + " " + version_text(protocol.version, protocol.sha256) +
                                   ": two versions of a protocol never share a folder");
    }
    const auto told = [](const StudyKind& k) {
        return k.simulated ? "simulated participants of seed " + std::to_string(k.seed) : std::string("people");
    };
    if (found.orders_version != kOrdersVersion) {
        throw files::bad_input(file.string(), "orders_version", std::to_string(found.orders_version),
                               std::to_string(kOrdersVersion) + ": this program gives participants other orders than " +
                                   files::shown(found.kind.program) + ", with which this study has to be finished");
    }
    if (found.kind.simulated != kind.simulated || found.kind.seed != kind.seed) {
        throw files::bad_input(file.string(), "simulated", told(found.kind),
                               told(kind) + ": they never share a folder");
    }
    if (found.kind.rate_Hz != kind.rate_Hz) {
        throw files::bad_input(file.string(), "simulation_rate_Hz", files::short_number(found.kind.rate_Hz),
                               files::short_number(kind.rate_Hz) + ": one rate of the simulated pen in a folder");
    }
}

}  // namespace

void open_study(const fs::path& directory, const Protocol& protocol, const StudyKind& kind) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error || !fs::is_directory(directory)) {
        throw std::runtime_error(directory.string() +
                                 ": cannot be made: " + (error ? error.message() : "a file is in the way"));
    }
    const fs::path file = directory / "study.json";
    if (const auto found = read_identity(directory)) return check_same(file, *found, protocol, kind);
    if (has_logs(directory)) {
        throw files::bad_input(directory.string(), "", "logs (sub-...) but no study.json",
                               "an empty folder, or one of this protocol");
    }
    describe_dataset(directory, protocol, kind);
    prepare_log_folder(directory);
    files::write_text_atomically(directory / "protocol.json", protocol.text);
    files::Json json{{"protocol", protocol.name},       {"version", protocol.version},  {"sha256", protocol.sha256},
                     {"simulated", kind.simulated},     {"simulation_seed", kind.seed}, {"program", kind.program},
                     {"orders_version", kOrdersVersion}};
    if (kind.simulated) json["simulation_rate_Hz"] = kind.rate_Hz;
    files::write_text_atomically(file, files::json_text(json));  // last: it makes the folder a study
}

void check_no_study(const fs::path& directory) {
    if (!fs::exists(directory / "study.json")) return;
    throw files::bad_input(directory.string(), "", "the folder of a study (study.json)",
                           "another folder: single runs never share a study's folder");
}

std::optional<StudyIdentity> read_identity(const fs::path& directory) {
    const fs::path file = directory / "study.json";
    if (!fs::exists(file)) return std::nullopt;
    return identity_in(files::read_text(file), file.string());
}

StudyIdentity identity_in(std::string_view study_json, const std::string& file_name) {
    const files::Json root = files::parse_json(study_json, file_name);
    files::JsonReader json(root, file_name);
    json.only({"protocol", "version", "sha256", "simulated", "simulation_seed", "simulation_rate_Hz", "program",
               "orders_version"});
    StudyIdentity out;
    out.name = json.text("protocol");
    out.version = json.text("version");
    out.sha256 = json.text("sha256");
    out.kind.simulated = json.boolean("simulated", false);
    out.kind.seed = static_cast<std::uint64_t>(json.number("simulation_seed", {0.0, 9e15}, 0.0));
    constexpr double kEarlierRate_Hz = 60.0;  // of files without the key
    out.kind.rate_Hz = json.number("simulation_rate_Hz", {0.0, 1e6}, out.kind.simulated ? kEarlierRate_Hz : 0.0);
    out.kind.program = json.text("program", "");
    out.orders_version = json.integer("orders_version", 1, 1000, 1);
    json.finish();
    return out;
}

std::string spelled_alike(const std::vector<Person>& people, const std::string& code) {
    std::string alike;
    for (const Person& one : people) {
        if (one.code == code) return "";
        if (without_spelling(one.code) == without_spelling(code)) alike = one.code;
    }
    return alike;
}

std::vector<Person> read_people(const fs::path& directory, std::vector<std::string>& notes) {
    const fs::path file = directory / "participants.tsv";
    if (!fs::exists(file)) return {};
    return people_in(files::read_text(file), file.string(), notes);
}

std::vector<Person> people_in(std::string_view participants_tsv, const std::string& file_name,
                              std::vector<std::string>& notes) {
    std::vector<Person> people;
    std::string_view rest = whole_lines(participants_tsv, file_name, notes);
    std::map<std::string, int> first_line;
    for (int line = 1; !rest.empty(); ++line) {
        const auto end = rest.find('\n');
        std::string_view row = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        if (!row.empty() && row.back() == '\r') row.remove_suffix(1);
        if (line == 1 || row.empty()) continue;
        const auto fields = files::fields_of(row, '\t');
        if (fields.size() != 8 || fields[0].substr(0, 4) != "sub-") {
            notes.push_back(file_name + ": line " + std::to_string(line) + " is left out: " + files::shown(row) +
                            " is not a participant with 8 fields");
            continue;
        }
        const auto field = [&](std::size_t i) { return std::string(fields[i]); };
        people.push_back({field(0).substr(4), field(1), field(2), field(3), field(4), field(5), field(6), field(7)});
        const auto [it, fresh] = first_line.emplace(people.back().code, line);
        if (!fresh) {
            throw files::bad_input(file_name, "line " + std::to_string(line) + ", participant_id",
                                   files::shown(fields[0]),
                                   "it once: line " + std::to_string(it->second) + " has the same code");
        }
    }
    return people;
}

void add_people(const fs::path& directory, const std::vector<Person>& people) {
    std::vector<std::string> notes;
    std::set<std::string> known;
    for (const Person& one : read_people(directory, notes)) known.insert(one.code);
    const fs::path file = directory / "participants.tsv";
    std::string lines;
    if (!fs::exists(file) || fs::file_size(file) == 0) lines = kPeopleHeader;
    for (const Person& one : people) {
        if (known.insert(one.code).second) lines += line_of(one);
    }
    if (!lines.empty()) files::append_synced(file, lines);
}

std::set<int> finished_trials(const fs::path& directory, const std::string& code) {
    std::set<int> finished;
    for (const fs::path& file : events_files(directory / ("sub-" + code))) {
        std::vector<std::string> notes;
        const RunLog run = read_run(file, notes);
        if (run.finished) finished.insert(run.trial);
        for (const RunLog::Choice& choice : run.choices) finished.insert(choice.trial);
    }
    return finished;
}

std::optional<PlannedTrial> next_trial(const PlannedParticipant& plan, const std::set<int>& finished) {
    for (const PlannedTrial& trial : plan.trials) {
        if (finished.count(trial.trial) == 0) return trial;
    }
    return std::nullopt;
}

StudyProgress progress_of(const fs::path& directory, const Protocol& protocol, const std::string& code) {
    std::vector<std::string> notes;
    const std::vector<Person> people = read_people(directory, notes);
    StudyProgress out;
    out.known = std::any_of(people.begin(), people.end(), [&](const Person& one) { return one.code == code; });
    out.plan = plan_participant(protocol, numbers_of(people, read_replacements(directory)).number(code));
    out.finished = finished_trials(directory, code);
    out.next = next_trial(out.plan, out.finished);
    return out;
}

std::string instructions_for(const Protocol& protocol, const PlannedTrial& trial) {
    const Condition& condition = protocol.conditions[trial.condition];
    std::string text = protocol.instructions;
    if (!condition.instructions.empty()) text += (text.empty() ? "" : "\n\n") + condition.instructions;
    const bool pairs = compares(task_of(protocol, trial.condition));
    if (trial.practice && pairs) text += "\n\nThis is practice: after each answer you are told whether it was right.";
    const bool by_hand = condition.modality == Modality::hand;
    if (trial.practice && !pairs && !by_hand) text += "\n\nThis is practice: you see where the harder places are.";
    const double limit_s = trial.practice ? protocol.practice_limit_s : protocol.time_limit_s;
    if (limit_s > 0.0 && (!pairs || !condition.scene.empty()))
        text += "\n\nYou have " + files::short_number(limit_s) + (pairs ? " seconds for each surface." : " seconds.");
    return text;
}

}  // namespace palpa::study
