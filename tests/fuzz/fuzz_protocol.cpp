// Protocols of studies, and the order of trials that they plan.

#include "study/order.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::study;

PALPA_FUZZ_ENTRY(protocol)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("protocol");
    return fuzz::read_or_refuse([&] { plan_participant(read_protocol(file.with(fuzz::text_of(data, size))), 1); });
}
