// palpa study watch DIR: the experimenter's view of a study that runs on another screen or machine. It reads the files
// that the study writes and changes nothing.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>
#include <unistd.h>

#include "app/commands/option_checks.h"
#include "app/commands/study.h"
#include "files/folder_lock.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "study/exclusions.h"
#include "study/read_logs.h"
#include "study/study_folder.h"
#include "study/withdrawal.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

struct WatchArguments {
    std::string directory;
    std::string participant;
    bool once = false;
    bool json = false;
};

// Reads the last state from a file of events: seconds since the trial began, marks not undone, and hits once it has ended.
files::Json last_events(const fs::path& file, std::vector<std::string>& notes) {
    const std::string text = files::read_text(file);
    const std::string_view whole = study::whole_lines(text, file.string(), notes);
    files::Json json{{"file", file.filename().string()}, {"marks", 0}};
    if (whole.empty()) return json;
    const auto lines = files::fields_of(whole.substr(0, whole.size() - 1), '\n');
    const auto names = files::fields_of(lines.front(), '\t');
    const auto field = [&](std::string_view line, std::string_view name) {
        const auto fields = files::fields_of(line, '\t');
        const auto i = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
        return i < fields.size() ? std::string(fields[i]) : std::string("n/a");
    };
    int marks = 0;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const std::string type = field(lines[i], "trial_type");
        if (type == "mark") ++marks;
        if (type == "undo") marks = std::max(0, marks - 1);  // a person may ask for it while there is none
        json["last"] = type;
        if (type != "finish") continue;
        for (const char* name : {"tp", "fn", "fp"}) json[name] = field(lines[i], name);
    }
    json["marks"] = marks;
    return json;
}

// Returns the last complete row of a table of samples that has a position, by column. Rows of commands have no position.
files::Json last_sample(const fs::path& file) {
    constexpr std::uintmax_t kTail_bytes = 65536;  // some seconds
    std::error_code error;
    if (!fs::exists(file, error)) return {};
    const files::InputFile in(file);
    if (in.bytes() == 0) return {};
    std::string head(512, '\0');
    head.resize(in.read_at(0, head.data(), head.size()));
    std::string tail(kTail_bytes, '\0');
    tail.resize(in.read_at(in.bytes() - std::min(in.bytes(), kTail_bytes), tail.data(), tail.size()));
    const auto names = files::fields_of(std::string_view(head).substr(0, head.find('\n')), '\t');
    for (auto end = tail.rfind('\n'); end != std::string::npos && end > 0;) {
        const auto before = tail.rfind('\n', end - 1);
        const std::size_t begin = before == std::string::npos ? 0 : before + 1;
        const auto fields = files::fields_of(std::string_view(tail).substr(begin, end - begin), '\t');
        if (fields.size() != names.size() || fields[0] == names[0]) return {};
        files::Json json;
        for (std::size_t i = 0; i < names.size(); ++i) json[std::string(names[i])] = std::string(fields[i]);
        if (json.value("x_mm", "") != "n/a" && json.value("y_mm", "") != "n/a") return json;
        end = before;
    }
    return {};
}

// Reads the progress of a person as the study wrote it. Throws InputError naming the key that has an unexpected value.
files::Json read_now(const fs::path& file) {
    constexpr int kMost = 1'000'000;
    const files::Json root = files::read_json(file);
    files::JsonReader json(root, file.string());
    json.text("step");
    json.integer("finished", 0, kMost);
    json.integer("of", 0, kMost);
    json.text("stopped", "");
    json.boolean("locked", false);
    json.text("rated", "");
    if (json.has("trial")) {
        json.integer("trial", 1, kMost);
        json.text("condition");
        json.boolean("practice", false);
    }
    if (json.has("present_kPa")) {
        json.numbers("present_kPa", 2, {0.0, 1e9});
        json.integer("interval", 1, 2);
    }
    return root;
}

files::Json state_of(const fs::path& directory, const study::Person& person, std::vector<std::string>& notes) {
    const fs::path subject = directory / ("sub-" + person.code);
    files::Json json{{"participant", person.code}, {"group", person.group}};
    json["finished"] = study::finished_trials(directory, person.code).size();
    const study::Withdrawal withdrawal = study::withdrawal_of(directory, person.code);
    if (withdrawal != study::Withdrawal::none)
        json["withdrawn"] = withdrawal == study::Withdrawal::keeps_data ? "data kept" : "data left out";
    if (const std::string successor = study::replaced_by(directory, person.code); !successor.empty())
        json["replaced_by"] = successor;
    for (const study::Exclusion& one : study::read_exclusions(directory)) {
        if (one.participant == person.code && !one.trial) json["excluded"] = true;
    }
    std::error_code error;
    if (!fs::exists(subject / "now.json", error)) return json;
    try {
        json["now"] = read_now(subject / "now.json");
    } catch (const files::InputError& unreadable) {  // a power cut, or a tool that copies it: the others are shown
        notes.emplace_back(unreadable.what());
        return json;
    }
    // the program held the folder's lock when it wrote this; a step that it does not hold it in any more is over
    if (json["now"].value("locked", false)) json["running"] = files::is_folder_locked(subject);
    if (json["now"].value("step", "") != "trial") return json;
    const bool choice = json["now"].contains("interval");  // its surfaces are runs of their own
    const auto files = choice ? study::interval_files(subject) : study::events_files(subject);
    if (files.empty()) return json;
    json["events"] = last_events(files.back(), notes);
    std::string samples = files.back().string();
    samples.replace(samples.size() - std::string_view("_events.tsv").size(), std::string::npos, "_samples.tsv");
    const files::Json last = last_sample(samples);
    if (!last.is_null()) json["sample"] = last;
    return json;
}

files::Json look(const WatchArguments& arguments) {
    if (!study::read_identity(arguments.directory)) {
        throw files::bad_input(arguments.directory, "", "no study.json",
                               "the folder of a study (--log of palpa study run)");
    }
    std::vector<std::string> notes;
    files::Json json{{"people", files::Json::array()}};
    // a person who is answering the questions is not in participants.tsv yet
    std::vector<study::Person> people = study::read_people(arguments.directory, notes);
    for (const auto& entry : fs::directory_iterator(arguments.directory)) {
        const std::string name = entry.path().filename().string();
        if (name.rfind("sub-", 0) != 0) continue;
        const auto same = [&](const study::Person& p) { return "sub-" + p.code == name; };
        if (std::none_of(people.begin(), people.end(), same)) people.push_back({name.substr(4)});
    }
    for (const study::Person& person : people) {
        if (!arguments.participant.empty() && person.code != arguments.participant) continue;
        json["people"].push_back(state_of(arguments.directory, person, notes));
    }
    if (!arguments.participant.empty() && json["people"].empty()) {
        throw files::bad_input("--participant", "", files::shown(arguments.participant),
                               "a code that is in " + arguments.directory);
    }
    json["notes"] = notes;
    return json;
}

// The log has numbers to the last bit; the experimenter reads four digits.
std::string short_text(const std::string& field) {
    double value = 0.0;
    if (!files::parse_number(field, value)) return field;
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

void print(const files::Json& state) {
    const std::string code = state["participant"].get<std::string>();
    std::printf("%-10s %-10s ", code.c_str(), state["group"].get<std::string>().c_str());
    std::string left = state.contains("withdrawn") ? ", withdrew, " + state["withdrawn"].get<std::string>() : "";
    if (state.contains("replaced_by")) left += ", replaced by " + state["replaced_by"].get<std::string>();
    if (state.contains("excluded")) left += ", left out of the analysis";
    if (!state.contains("now")) {
        const int finished = state["finished"].get<int>();
        std::printf("%d trial%s%s\n", finished, finished == 1 ? "" : "s", left.c_str());
        return;
    }
    const files::Json& now = state["now"];
    std::printf("%s of %s  %s", now["finished"].dump().c_str(), now["of"].dump().c_str(),
                now["step"].get<std::string>().c_str());
    if (now.contains("rated")) std::printf(", %s", now["rated"].get<std::string>().c_str());
    if (now.contains("trial")) {
        std::printf(", trial %s%s, %s", now["trial"].dump().c_str(), now.value("practice", false) ? " (practice)" : "",
                    now["condition"].get<std::string>().c_str());
    }
    std::printf("%s\n", left.c_str());
    if (now.contains("present_kPa")) {
        std::printf("    first %s kPa, second %s kPa; now interval %s\n", now["present_kPa"][0].dump().c_str(),
                    now["present_kPa"][1].dump().c_str(), now["interval"].dump().c_str());
    }
    const bool over = now["step"] == "done" || now["step"] == "stopped";
    if (!over && !state.value("running", true)) {
        std::printf("    ! nobody is at this step now: the study was closed, or went on with somebody else\n");
    }
    if (now.contains("stopped")) std::printf("    ! %s\n", now["stopped"].get<std::string>().c_str());
    if (state.contains("events")) {
        const int marks = state["events"]["marks"].get<int>();
        std::printf("    %d mark%s", marks, marks == 1 ? "" : "s");
    }
    if (state.contains("sample")) {
        const files::Json& s = state["sample"];
        const auto text = [&](const char* name) { return short_text(s.value(name, "n/a")); };
        std::printf(", %s at (%s, %s) mm, pressure %s, %s N, %s mm deep", text("tool").c_str(), text("x_mm").c_str(),
                    text("y_mm").c_str(), text("pressure").c_str(), text("force_N").c_str(), text("depth_mm").c_str());
    } else if (state.contains("events")) {
        std::printf(", the tissue was not touched in the last seconds");
    }
    if (state.contains("events")) std::printf("\n");
}

void watch(const WatchArguments& arguments) {
    const bool again = !arguments.once && !arguments.json && isatty(STDOUT_FILENO) != 0;
    while (true) {
        const files::Json json = look(arguments);
        if (arguments.json) {
            std::fputs(files::json_text(json).c_str(), stdout);
            return;
        }
        if (again) std::fputs("\033[H\033[J", stdout);  // from the top of the screen
        for (const files::Json& state : json["people"]) print(state);
        for (const files::Json& note : json["notes"]) std::printf("  %s\n", note.get<std::string>().c_str());
        std::fflush(stdout);
        if (!again) return;
        std::this_thread::sleep_for(std::chrono::seconds(1));
    }
}

}  // namespace

void add_study_watch(CLI::App& study) {
    auto arguments = std::make_shared<WatchArguments>();
    CLI::App* command = study.add_subcommand(
        "watch", "Show the experimenter a running study: participants, their progress, what to present");
    command->add_option("DIR", arguments->directory, "the study's folder")->required();
    command->add_option("--participant", arguments->participant, "show only this participant")
        ->transform(code_of_participant());
    command->add_flag("--once", arguments->once, "print once (always so if the output is not a terminal)");
    command->add_flag("--json", arguments->json, "print one JSON object on standard output, once");
    command->callback([arguments] { watch(*arguments); });
}

}  // namespace palpa::app
