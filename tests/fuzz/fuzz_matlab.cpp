// MATLAB files of version 5, by matio in a process of its own, as the program reads them.

#include "stiffnessmaps/import/arrays.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;

PALPA_FUZZ_ENTRY(matlab)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("matlab");
    return fuzz::read_or_refuse([&] { read_array(file.with(fuzz::text_of(data, size)), std::string()); });
}
