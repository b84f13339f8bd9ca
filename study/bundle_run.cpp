#include "study/bundle_run.h"

#include <algorithm>

#include "files/json.h"
#include "files/sha256.h"
#include "files/text.h"
#include "study/bundle.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

void add(const std::string& name, const std::string& text, files::Json& files) {
    files.push_back({{"name", name}, {"sha256", files::sha256_hex(text)}, {"text", text}});
}

// Returns the header of participants.tsv and one participant's line; the other participants on this tablet go into
// bundles of their own.
std::string line_of_person(const std::string& people, const std::string& code) {
    std::string out = people.substr(0, people.find('\n') + 1);
    const std::string wanted = "\nsub-" + code + "\t";
    const auto at = people.find(wanted);
    if (at != std::string::npos) out += people.substr(at + 1, people.find('\n', at + 1) - at);
    return out;
}

void add_study_files(const fs::path& directory, const std::string& code, files::Json& files) {
    for (const fs::path& file : study_files(directory, code)) {
        const std::string name = fs::relative(file, directory).generic_string();
        const std::string text = files::read_text(file);
        add(name, name == "participants.tsv" ? line_of_person(text, code) : text, files);
    }
}

std::vector<fs::path> sorted_files(const fs::path& folder) {
    std::vector<fs::path> out;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

std::string code_of(const RunFiles& run) {
    const std::string subject = run.stem.substr(0, run.stem.find('_'));
    return subject.substr(subject.find('-') + 1);
}

fs::path study_of(const RunFiles& run) {
    const fs::path directory = run.folder.parent_path().parent_path();
    return fs::exists(directory / "study.json") ? directory : fs::path();
}

std::vector<fs::path> study_files(const fs::path& directory, const std::string& code) {
    std::vector<fs::path> out;
    for (const char* name : {"study.json", "protocol.json", "participants.tsv"}) {
        if (fs::exists(directory / name)) out.push_back(directory / name);
    }
    for (const fs::path& file : sorted_files(directory / ("sub-" + code) / "beh")) {
        if (grows(file.filename().string())) out.push_back(file);
    }
    return out;
}

std::string bundle_text(const RunFiles& run) {
    const std::string code = code_of(run);
    files::Json files = files::Json::array();
    for (const fs::path& file : sorted_files(run.folder)) {
        const std::string name = file.filename().string();
        if (name.rfind(run.stem + "_", 0) == 0) add("sub-" + code + "/beh/" + name, files::read_text(file), files);
    }
    if (const fs::path directory = study_of(run); !directory.empty()) add_study_files(directory, code, files);
    return files::json_text({{"palpa_bundle", 1}, {"files", files}});
}

std::string bundle_of_answers(const fs::path& directory, const std::string& code) {
    files::Json files = files::Json::array();
    add_study_files(directory, code, files);
    return files::json_text({{"palpa_bundle", 1}, {"files", files}});
}

}  // namespace palpa::study
