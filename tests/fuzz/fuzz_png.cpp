// Grey PNG images.

#include "stiffnessmaps/import/arrays.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;

PALPA_FUZZ_ENTRY(png)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("png");
    return fuzz::read_or_refuse([&] { read_png(file.with(fuzz::text_of(data, size))); });
}
