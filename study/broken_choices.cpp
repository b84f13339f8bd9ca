#include "study/broken_choices.h"

#include <map>

#include "files/input_error.h"
#include "study/run_files.h"
#include "study/run_log.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

// A pair of surfaces of which some were felt to their end.
struct OpenPair {
    BrokenChoice last;
    int interval = 0;
};

// Which of the two surfaces a run is of. Settings that a power cut damaged tell nothing: then it is the one that comes
// after `last`.
int interval_of(const RunLog& run, int last, std::vector<std::string>& notes) {
    std::string file = run.events.string();
    file.replace(file.size() - std::string_view("_events.tsv").size(), std::string::npos, "_settings.json");
    try {
        return read_run_settings(file).interval.value_or(last + 1);
    } catch (const files::InputError& error) {
        notes.push_back(error.what() + std::string(" (of a surface of a forced choice)"));
        return last + 1;
    }
}

}  // namespace

std::vector<BrokenChoice> broken_choices(const fs::path& subject, const std::set<int>& answered,
                                         std::vector<std::string>& notes) {
    std::vector<BrokenChoice> broken;
    std::map<int, OpenPair> open;  // by trial
    for (const fs::path& events : interval_files(subject)) {
        const RunLog run = read_run(events, notes);
        const BrokenChoice here{events, run.trial, run.practice};
        if (run.trial == 0) {
            broken.push_back(here);
            continue;
        }
        OpenPair& pair = open[run.trial];
        const int interval = interval_of(run, pair.interval, notes);
        if (pair.interval > 0 && interval <= pair.interval) broken.push_back(pair.last);
        if (!run.finished) broken.push_back(here);
        pair = run.finished ? OpenPair{here, interval} : OpenPair{};
    }
    for (const auto& [trial, pair] : open) {
        if (pair.interval > 0 && answered.count(trial) == 0) broken.push_back(pair.last);
    }
    return broken;
}

}  // namespace palpa::study
