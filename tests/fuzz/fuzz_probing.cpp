// Tables of probing as a map.

#include "stiffnessmaps/import/import.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;

PALPA_FUZZ_ENTRY(probing)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("probing");
    return fuzz::read_or_refuse([&] {
        ImportOptions options;
        options.form = RecordingForm::probing;
        ImportReport report;
        import_recording({file.with(fuzz::text_of(data, size))}, options, report);
    });
}
