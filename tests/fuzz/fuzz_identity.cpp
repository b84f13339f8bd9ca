// study.json.

#include "study/study_folder.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::study;

PALPA_FUZZ_ENTRY(identity)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] { identity_in(fuzz::text_of(data, size), "study.json"); });
}
