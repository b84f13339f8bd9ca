#include "app/web/browser_keeper.h"

#include <emscripten.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>

#include "files/sha256.h"
#include "files/text.h"
#include "study/bundle_run.h"

// clang-format off
EM_JS(void, palpa_trials_put, (const char* name, const char* text, const char* hash, int finished), {
    palpaTrials.put(UTF8ToString(name), UTF8ToString(text), UTF8ToString(hash), finished !== 0);
});
EM_JS(int, palpa_trials_next_run, (), { return palpaTrials.nextRun(); });
EM_JS(int, palpa_trials_ready, (), { return palpaTrials.ready() ? 1 : 0; });
EM_JS(void, palpa_trials_failed, (const char* message), { palpaTrials.tell(UTF8ToString(message)); });
EM_JS(char*, palpa_trials_text, (int which), {
    const text = which === 0 ? palpaTrials.nextProblem() : which === 1 ? palpaTrials.note() : which === 2 ? palpaTrials.participant()
                                                                                            : palpaTrials.settings();
    const size = lengthBytesUTF8(text) + 1;
    const copy = _malloc(size);
    stringToUTF8(text, copy, size);
    return copy;
});
EM_JS(void, palpa_trials_keep_settings, (const char* text), { palpaTrials.keepSettings(UTF8ToString(text)); });
EM_JS(void, palpa_trials_open, (), { palpaTrials.open(); });
// clang-format on

namespace palpa {
namespace {

enum Text { kProblem, kNote, kParticipant, kSettings };

std::string text_of(Text which) {
    const std::unique_ptr<char, decltype(&std::free)> text(palpa_trials_text(which), &std::free);
    return text.get();
}

// What the browser's storage has is not needed in memory too; the empty file keeps the number of the run.
void empty_files(const RunFiles& run) {
    for (const auto& entry : std::filesystem::directory_iterator(run.folder)) {
        if (entry.path().filename().string().rfind(run.stem + "_", 0) != 0) continue;
        if (std::FILE* emptied = std::fopen(entry.path().c_str(), "w")) std::fclose(emptied);
    }
}

}  // namespace

void BrowserKeeper::keep(const RunFiles& run, bool finished) {
    try {
        const std::string text = bundle_text(run);
        palpa_trials_put(run.stem.c_str(), text.c_str(), sha256_hex(text).c_str(), finished ? 1 : 0);
        if (finished) empty_files(run);
    } catch (const std::exception& error) {
        palpa_trials_failed(error.what());
    }
}

std::string participant_here() { return text_of(kParticipant); }
int next_run_here() { return palpa_trials_next_run(); }

bool BrowserKeeper::ready() const { return palpa_trials_ready() != 0; }
std::string BrowserKeeper::problem() { return text_of(kProblem); }
std::string BrowserKeeper::note() const { return text_of(kNote); }

void BrowserKeeper::keep_settings(const std::filesystem::path& file) {
    try {
        palpa_trials_keep_settings(read_text(file).c_str());
    } catch (const std::exception& error) {
        palpa_trials_failed(error.what());
    }
}

void BrowserKeeper::open() { palpa_trials_open(); }

void restore_settings(const std::filesystem::path& file) {
    const std::string text = text_of(kSettings);
    if (text.empty()) return;
    std::filesystem::create_directories(file.parent_path());
    write_text_whole(file, text);
}

}  // namespace palpa
