// A study's folder as it is analysed: study.json, participants.tsv, and of one trial events, marks, settings, performance.

#include <array>
#include <deque>

#include "study/read_logs.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::study;

namespace {

constexpr std::array<const char*, 6> kNames{"study.json",
                                            "participants.tsv",
                                            "sub-01/beh/sub-01_task-palpation_run-01_events.tsv",
                                            "sub-01/beh/sub-01_task-palpation_run-01_marks.tsv",
                                            "sub-01/beh/sub-01_task-palpation_run-01_settings.json",
                                            "sub-01/beh/sub-01_task-palpation_run-01_performance.json"};

struct LogsFolder {
    LogsFolder() {
        for (const char* name : kNames) folder.add(name, files.emplace_back(name));
    }
    std::deque<fuzz::MemoryFile> files;
    fuzz::MemoryFolder folder;
};

}  // namespace

PALPA_FUZZ_ENTRY(logs)(const std::uint8_t* data, std::size_t size) {
    static LogsFolder folder;
    const auto parts = fuzz::parts_of(fuzz::text_of(data, size), kNames.size());
    for (std::size_t i = 0; i < kNames.size(); ++i) folder.files[i].with(parts[i]);
    return fuzz::read_or_refuse([&] { read_study(folder.folder.path()); });
}
