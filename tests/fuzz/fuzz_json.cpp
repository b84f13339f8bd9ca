// Any JSON file: parsed, told in a message, written again.

#include "files/json.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::files;

PALPA_FUZZ_ENTRY(json)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        const Json json = parse_json(fuzz::text_of(data, size), "a.json");
        described(json);
        if (parse_json(json_text(json), "again.json").type() != json.type())
            fuzz::finding("another value when written and read again");
    });
}
