// The log of forced choices.

#include "study/read_logs.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::study;

namespace {

struct ChoicesFolder {
    ChoicesFolder() { folder.add("sub-01_task-softer_run-01_events.tsv", events); }
    fuzz::MemoryFile events{"events"};
    fuzz::MemoryFolder folder;
};

}  // namespace

PALPA_FUZZ_ENTRY(choices)(const std::uint8_t* data, std::size_t size) {
    static ChoicesFolder folder;
    return fuzz::read_or_refuse([&] {
        folder.events.with(fuzz::text_of(data, size));
        std::vector<std::string> notes;
        read_run(folder.folder.path() / "sub-01_task-softer_run-01_events.tsv", notes);
    });
}
