// NumPy arrays.

#include "files/npy.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::files;

PALPA_FUZZ_ENTRY(npy)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        const NpyArray array = parse_npy(fuzz::text_of(data, size), "a.npy");
        std::size_t n = 1;
        for (const std::size_t d : array.shape) n *= d;
        if (n != array.values.size()) fuzz::finding("a shape that is not the numbers'");
    });
}
