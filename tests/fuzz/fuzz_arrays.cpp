// Arrays of text or NumPy as a map of forces: the kind of file, the shape, the grid, the filled copy, the noise.

#include "stiffnessmaps/import/arrays.h"
#include "stiffnessmaps/import/matrices.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;

PALPA_FUZZ_ENTRY(arrays)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("arrays");
    file.with(fuzz::text_of(data, size));
    return fuzz::read_or_refuse([&] {
        const auto kind = array_kind(file.path());
        if (kind && *kind != ArrayKind::npy && *kind != ArrayKind::text) return;  // targets of their own
        ImportOptions options;
        options.spacing_m = {1e-3, 1e-3};
        options.depths_m = {1e-3, 2e-3, 3e-3};
        ImportReport report;
        import_matrices({file.path()}, options, report);
    });
}
