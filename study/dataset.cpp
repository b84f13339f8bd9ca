#include "study/dataset.h"

#include "files/json.h"
#include "files/text.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

// `program` is a name and a version, such as "palpa 1.0".
files::Json generated_by(const std::string& program) {
    const std::size_t space = program.find(' ');
    files::Json one{{"Name", program.substr(0, space)}};
    if (space != std::string::npos) one["Version"] = program.substr(space + 1);
    return files::Json::array({one});
}

files::Json description_json(const Protocol& protocol, const StudyKind& kind) {
    const bool simulated = kind.simulated;
    const DatasetAbout& about = protocol.about;
    files::Json json{{"Name", simulated ? protocol.name + " (simulated participants)" : protocol.name},
                     {"BIDSVersion", "1.8.0"},
                     {"DatasetType", "raw"}};
    if (!about.license.empty()) json["License"] = about.license;
    if (!about.authors.empty()) json["Authors"] = about.authors;
    if (about.authors.empty() && simulated)
        json["Authors"] = {"No person took part", "Hands and eyes were simulated by palpa study simulate"};
    if (!about.funding.empty()) json["Funding"] = about.funding;
    if (!about.ethics_approvals.empty()) json["EthicsApprovals"] = about.ethics_approvals;
    if (!kind.program.empty()) json["GeneratedBy"] = generated_by(kind.program);
    return json;
}

files::Json column_text(const char* text) { return {{"Description", text}}; }

files::Json people_columns() {
    return {
        {"participant_id", column_text("sub- and the code of the participant, as the folder of the logs")},
        {"age", {{"Description", "as answered; n/a: not asked or not answered"}, {"Units", "year"}}},
        {"sex", column_text("as answered; n/a: not asked or not answered")},
        {"handedness", column_text("as answered; n/a: not asked or not answered")},
        {"vision", column_text("as answered; n/a: not asked or not answered")},
        {"palpation_experience", column_text("as answered; n/a: not asked or not answered")},
        {"vr_experience", column_text("experience with virtual reality, as answered; n/a: not asked or not answered")},
        {"group", column_text("id of the group in protocol.json")}};
}

files::Json exclusion_columns() {
    return {{"participant", column_text("code without sub-")},
            {"trial", column_text("number of the finished trial that is left out; all: all of this participant's")},
            {"reason", column_text("of the experimenter, in words")}};
}

files::Json replacement_columns() {
    return {{"participant", column_text("code without sub-, of the participant who dropped out and is left out")},
            {"replaced_by", column_text("code without sub-, of the participant with the same group and orders; n/a: "
                                        "frees the place from who has not come")},
            {"reason", column_text("of the experimenter, in words")}};
}

void write_if_missing(const std::filesystem::path& file, const std::string& text) {
    if (!std::filesystem::exists(file)) files::write_text_atomically(file, text);
}

std::string named_list(const char* title, const std::vector<std::string>& items) {
    std::string out = items.empty() ? "" : "\n" + std::string(title) + ":\n\n";
    for (const std::string& item : items) out += "- " + item + "\n";
    return out;
}

}  // namespace

std::string readme_text(const Protocol& protocol, const StudyKind& kind) {
    const bool simulated = kind.simulated;
    std::string out = "# " + markdown_cell(protocol.name) + "\n\n";
    if (simulated) {
        out +=
            "SIMULATED: no person took part. Hands and eyes were simulated by `palpa study simulate`, whose numbers "
            "are "
            "fitted to no person's data.\n\n";
    }
    out += "Palpation of tissue on a screen, or choices of the softer of two surfaces, recorded by " +
           (kind.program.empty() ? std::string("palpa") : kind.program) +
           ". The layout is that of BIDS 1.8.0, behavioural data without imaging.\n\n"
           "Protocol: version " +
           protocol.version + ", seed " + std::to_string(protocol.seed) + ", SHA-256 " + protocol.sha256 +
           ". The file `protocol.json` is a copy of it, without the scenes that it names. Orders and views of all "
           "participants "
           "follow from protocol and scenes (`palpa study order PROTOCOL.json --participants N`, where these are).\n\n"
           "Conditions:\n\n";
    for (const Condition& one : protocol.conditions) {
        out += "- " + one.id + (one.title.empty() ? "" : " (" + one.title + ")") + ": " + name_of(one.modality) +
               (one.scene.empty() ? ", without a scene" : ", scene " + one.scene) + "\n";
    }
    out +=
        "\n| file | content |\n| --- | --- |\n"
        "| participants.tsv | one line for each participant; participants.json explains the columns |\n"
        "| sub-XX/beh/..._events.tsv | what happened when, one run for each trial; a trial counts if its last row is "
        "`finish` |\n"
        "| ..._marks.tsv | the marks at the end of the trial, their confidence and what they found |\n"
        "| ..._samples.tsv | every sample of the pen or finger, with force and avatar |\n"
        "| ..._settings.json | scene, map, nodules, calibration, and hashes of the files |\n"
        "| ..._performance.json | how the program kept time |\n"
        "| ..._task-softer_..._events.tsv | forced choices |\n"
        "| ..._task-ratings_beh.tsv | answers to the protocol's questions |\n"
        "| exclusions.tsv, replacements.tsv | decisions of the experimenter, if there are any |\n\n"
        "`task-..._....json` at the top explain the columns of all runs. Tables have a header, tabs, and n/a for what "
        "is "
        "missing. `palpa study analyse` reads this folder; `.bidsignore` lists what is not in BIDS.\n";
    out += named_list("Authors", protocol.about.authors);
    if (protocol.about.authors.empty() && !simulated)
        out += "\nAuthors: not stated. Put them into `dataset_description.json`.\n";
    if (!protocol.about.license.empty()) out += "\nLicense: " + protocol.about.license + "\n";
    if (!protocol.about.registration.empty()) out += "\nRegistration: " + protocol.about.registration + "\n";
    out += named_list("Ethics approvals", protocol.about.ethics_approvals);
    out += named_list("Funding", protocol.about.funding);
    return out;
}

void describe_dataset(const std::filesystem::path& directory, const Protocol& protocol, const StudyKind& kind) {
    write_if_missing(directory / "dataset_description.json", files::json_text(description_json(protocol, kind)));
    write_if_missing(directory / "README", readme_text(protocol, kind));
    write_if_missing(directory / "participants.json", files::json_text(people_columns()));
    write_if_missing(directory / "exclusions.json", files::json_text(exclusion_columns()));
    write_if_missing(directory / "replacements.json", files::json_text(replacement_columns()));
}

}  // namespace palpa::study
