// participants.tsv.

#include "study/study_folder.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::study;

PALPA_FUZZ_ENTRY(people)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        std::vector<std::string> notes;
        people_in(fuzz::text_of(data, size), "participants.tsv", notes);
        for (const std::string& note : notes) fuzz::check_message(note);
    });
}
