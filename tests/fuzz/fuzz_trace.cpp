// Traces: the table, then the JSON file beside it.

#include "platform/trace.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::platform;

namespace {

struct TraceFolder {
    TraceFolder() {
        folder.add("trace.tsv", table);
        folder.add("trace.json", sidecar);
    }
    fuzz::MemoryFile table{"trace.tsv"};
    fuzz::MemoryFile sidecar{"trace.json"};
    fuzz::MemoryFolder folder;
};

}  // namespace

PALPA_FUZZ_ENTRY(trace)(const std::uint8_t* data, std::size_t size) {
    static TraceFolder folder;
    const auto parts = fuzz::parts_of(fuzz::text_of(data, size), 2);
    folder.table.with(parts[0]);
    folder.sidecar.with(parts[1]);
    return fuzz::read_or_refuse([&] { read_trace(folder.folder.path() / "trace.tsv"); });
}
