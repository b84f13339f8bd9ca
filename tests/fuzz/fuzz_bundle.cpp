// Bundles of a tablet's log, and the names in them.

#include "study/bundle.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::study;

PALPA_FUZZ_ENTRY(bundle)(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes = fuzz::text_of(data, size);
    if (kind_of_log_file(bytes) && (bytes.find("..") != std::string_view::npos || bytes.front() == '/'))
        fuzz::finding("a name that leads elsewhere");
    return fuzz::read_or_refuse([&] { read_bundle(bytes, "a.json"); });
}
