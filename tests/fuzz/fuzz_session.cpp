// The points of a recording session that is gone on with.

#include "calibration/record_session.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::calibration;

PALPA_FUZZ_ENTRY(session)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("session");
    return fuzz::read_or_refuse([&] { rows_of(read_session(file.with(fuzz::text_of(data, size)))); });
}
