// Grey TIFF images.

#include "stiffnessmaps/import/arrays.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;

PALPA_FUZZ_ENTRY(tiff)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("tiff");
    return fuzz::read_or_refuse([&] { read_tiff(file.with(fuzz::text_of(data, size))); });
}
