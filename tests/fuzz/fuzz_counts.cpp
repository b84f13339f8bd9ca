// Tables of counts.

#include "study/observations.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::study;

PALPA_FUZZ_ENTRY(counts)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("counts");
    return fuzz::read_or_refuse([&] { read_counts(file.with(fuzz::text_of(data, size))); });
}
