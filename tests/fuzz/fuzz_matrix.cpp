// Rows of numbers without a header.

#include "stiffnessmaps/import/arrays.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;

PALPA_FUZZ_ENTRY(matrix)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        const NpyArray array = parse_number_matrix(fuzz::text_of(data, size), "a.csv");
        if (array.shape.at(0) * array.shape.at(1) != array.values.size())
            fuzz::finding("a shape that is not the numbers'");
    });
}
