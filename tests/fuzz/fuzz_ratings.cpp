// Answers to a protocol's questions.

#include "study/ratings.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::study;

namespace {

struct RatingsFolder {
    RatingsFolder() { folder.add("sub-01/beh/sub-01_task-ratings_beh.tsv", answers); }
    fuzz::MemoryFile answers{"answers"};
    fuzz::MemoryFolder folder;
};

}  // namespace

PALPA_FUZZ_ENTRY(ratings)(const std::uint8_t* data, std::size_t size) {
    static RatingsFolder folder;
    return fuzz::read_or_refuse([&] {
        folder.answers.with(fuzz::text_of(data, size));
        std::vector<std::string> notes;
        read_ratings(folder.folder.path(), "01", notes);
        for (const std::string& note : notes) fuzz::check_message(note);
    });
}
