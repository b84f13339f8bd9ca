// Tables of sliding as a map, on a coarse grid.

#include "stiffnessmaps/import/import.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;

PALPA_FUZZ_ENTRY(sliding)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("sliding");
    return fuzz::read_or_refuse([&] {
        ImportOptions options;
        options.form = RecordingForm::sliding;
        options.pitch_m = 5e-3;
        options.surface_z_m = 0.0;
        ImportReport report;
        import_recording({file.with(fuzz::text_of(data, size))}, options, report);
    });
}
