#include "app/web/browser_keeper.h"

#include <cstdio>
#include <cstdlib>
#include <emscripten.h>
#include <exception>
#include <fstream>
#include <iterator>
#include <memory>

#include "files/sha256.h"
#include "files/text.h"
#include "study/bundle_run.h"

// clang-format off
EM_JS(void, palpa_trials_put, (const char* name, const char* text, const char* hash, const char* how, const char* paths), {
    palpaTrials.put(UTF8ToString(name), UTF8ToString(text), UTF8ToString(hash), UTF8ToString(how),
                    UTF8ToString(paths).split('\n').filter(Boolean));
});
EM_JS(void, palpa_trials_part, (const char* name, const char* path, double offset, const char* text), {
    palpaTrials.putPart(UTF8ToString(name), UTF8ToString(path), offset, UTF8ToString(text));
});
EM_JS(void, palpa_trials_participant, (const char* code), { palpaTrials.setParticipant(UTF8ToString(code)); });
EM_JS(int, palpa_trials_next_run, (), { return palpaTrials.nextRun(); });
EM_JS(int, palpa_trials_ready, (), { return palpaTrials.ready() ? 1 : 0; });
EM_JS(int, palpa_trials_keeps_designs, (), { return palpaTrials.keepsDesigns() ? 1 : 0; });
EM_JS(void, palpa_trials_failed, (const char* message), { palpaTrials.tell(UTF8ToString(message)); });
EM_JS(char*, palpa_trials_text, (int which, const char* code), {
    const text = which === 0 ? palpaTrials.nextProblem() : which === 1 ? palpaTrials.note() : which === 2 ? palpaTrials.participant()
               : which === 3 ? palpaTrials.settings() : which === 4 ? palpaTrials.protocol()
               : which === 5 ? palpaTrials.where(UTF8ToString(code)) : which === 6 ? palpaTrials.nextSolved() : palpaTrials.restore();
    const size = lengthBytesUTF8(text) + 1;
    const copy = _malloc(size);
    stringToUTF8(text, copy, size);
    return copy;
});
EM_JS(void, palpa_trials_keep_settings, (const char* text), { palpaTrials.keepSettings(UTF8ToString(text)); });
EM_JS(void, palpa_trials_keep_design, (const char* path), { palpaTrials.keepDesign(UTF8ToString(path)); });
EM_JS(void, palpa_trials_offer, (const char* path), { palpaTrials.offer(UTF8ToString(path)); });
EM_JS(void, palpa_trials_open, (), { palpaTrials.open(); });
EM_JS(void, palpa_studies_open, (), { palpaPage.openStudies(); });
EM_JS(void, palpa_studies_restore, (), { palpaStudies.restore(); });
// clang-format on

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

enum Text { kProblem, kNote, kParticipant, kSettings, kProtocol, kWhere, kSolved, kBroken };

// `code`: of a participant, for kWhere.
std::string text_of(Text which, const std::string& code = {}) {
    const std::unique_ptr<char, decltype(&std::free)> text(palpa_trials_text(which, code.c_str()), &std::free);
    return text.get();
}

// Empties the files of a run, which need no memory once the browser's storage has them. The empty files keep the number
// of the run taken, and a study's events stay, since they tell which trials are finished.
void empty_files(const study::RunFiles& run) {
    const bool study = !study::study_of(run).empty();
    for (const auto& entry : fs::directory_iterator(run.folder)) {
        if (entry.path().filename().string().rfind(run.stem + "_", 0) != 0) continue;
        if (study && entry.path() == run.file("_events.tsv")) continue;
        if (std::FILE* emptied = std::fopen(entry.path().c_str(), "w")) std::fclose(emptied);
    }
}

void put(const std::string& name, const std::string& bundle, const char* how, const std::vector<fs::path>& study) {
    std::string paths;
    for (const fs::path& path : study) paths += path.string() + "\n";
    palpa_trials_put(name.c_str(), bundle.c_str(), files::sha256_hex(bundle).c_str(), how, paths.c_str());
}

void keep_run(const study::RunFiles& run, const char* how) {
    try {
        std::vector<fs::path> study;
        if (const fs::path directory = study::study_of(run); !directory.empty()) {
            study = study::study_files(directory, study::code_of(run));
            if (fs::exists(run.file("_events.tsv"))) study.push_back(run.file("_events.tsv"));
        }
        put(run.stem, study::bundle_text(run), how, study);
    } catch (const std::exception& error) {
        palpa_trials_failed(error.what());
    }
}

// Returns the content of the file from byte `from` on.
std::string rest_of(const fs::path& file, std::size_t from) {
    std::ifstream in(file, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(from));
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// Whether the last row of a run that is over says that it was interrupted.
bool ended_early(const study::RunFiles& run) {
    const fs::path events = run.file("_events.tsv");
    if (!fs::exists(events)) return false;
    const std::string text = files::read_text(events);
    const auto last = text.size() < 2 ? std::string::npos : text.rfind('\n', text.size() - 2);
    return last != std::string::npos && text.find("\tinterrupted\t", last) != std::string::npos;
}

}  // namespace

void BrowserKeeper::keep(const study::RunFiles& run, bool finished) {
    keep_run(run, !finished ? "going-on" : ended_early(run) ? "ended-early" : "finished");
    if (!finished) return;
    empty_files(run);
    parts_.clear();
}

void BrowserKeeper::keep_part(const study::RunFiles& run) {
    for (const auto& entry : fs::directory_iterator(run.folder)) {
        if (entry.path().filename().string().rfind(run.stem + "_", 0) != 0) continue;
        std::size_t& kept = parts_[entry.path().string()];
        const std::string text = rest_of(entry.path(), kept);
        if (text.empty()) continue;
        palpa_trials_part(run.stem.c_str(), entry.path().c_str(), static_cast<double>(kept), text.c_str());
        kept += text.size();
    }
}

void BrowserKeeper::keep_answers(const fs::path& directory, const std::string& code) {
    try {
        char run[16];
        std::snprintf(run, sizeof run, "%02d", palpa_trials_next_run());
        put("sub-" + code + "_task-answers_run-" + run, study::bundle_of_answers(directory, code), "finished",
            study::study_files(directory, code));
    } catch (const std::exception& error) {
        palpa_trials_failed(error.what());
    }
}

void BrowserKeeper::participant(const std::string& code) { palpa_trials_participant(code.c_str()); }

std::string protocol_here() { return text_of(kProtocol); }
std::string participant_here() { return text_of(kParticipant); }
int next_run_here() { return palpa_trials_next_run(); }

bool BrowserKeeper::ready() const { return palpa_trials_ready() != 0; }
std::string BrowserKeeper::problem() { return text_of(kProblem); }
std::string BrowserKeeper::solved() { return text_of(kSolved); }
std::string BrowserKeeper::note() const { return text_of(kNote); }
std::string BrowserKeeper::where(const std::string& code) const { return text_of(kWhere, code); }

void BrowserKeeper::keep_settings(const std::filesystem::path& file) {
    try {
        palpa_trials_keep_settings(files::read_text(file).c_str());
    } catch (const std::exception& error) {
        palpa_trials_failed(error.what());
    }
}

void BrowserKeeper::keep_design(const fs::path& file) { palpa_trials_keep_design(file.c_str()); }
bool BrowserKeeper::keeps_designs() const { return palpa_trials_keeps_designs() != 0; }
void BrowserKeeper::offer(const fs::path& file) { palpa_trials_offer(file.c_str()); }
void BrowserKeeper::open() { palpa_trials_open(); }
void BrowserKeeper::open_studies() { palpa_studies_open(); }

void restore_studies() {
    const std::string broken = text_of(kBroken);
    for (const std::string_view line : files::fields_of(broken, '\n')) {
        const fs::path run(line);
        if (!run.empty()) keep_run({run.parent_path(), run.filename().string()}, "broken-off");
    }
    palpa_studies_restore();
}

void restore_settings(const std::filesystem::path& file) {
    const std::string text = text_of(kSettings);
    if (text.empty()) return;
    std::filesystem::create_directories(file.parent_path());
    files::write_text_whole(file, text);
}

}  // namespace palpa::app
