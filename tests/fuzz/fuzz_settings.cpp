// The person's settings: trouble is told, never thrown.

#include "app/screens/settings.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::app;

PALPA_FUZZ_ENTRY(settings)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("settings");
    std::string problem;
    load_settings(file.with(fuzz::text_of(data, size)), problem);
    if (!problem.empty()) fuzz::check_message(problem);
    return 0;
}
