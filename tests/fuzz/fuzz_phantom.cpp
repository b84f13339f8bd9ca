// Phantoms.

#include "stiffnessmaps/phantom.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;

PALPA_FUZZ_ENTRY(phantom)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("phantom");
    return fuzz::read_or_refuse([&] { map_of_phantom(read_phantom(file.with(fuzz::text_of(data, size)))); });
}
