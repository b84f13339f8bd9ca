// Who is paired with the desk: trouble is told, never thrown.

#include "desk/pairing.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::desk;

PALPA_FUZZ_ENTRY(sessions)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("sessions");
    std::string trouble;
    const Sessions sessions(file.with(fuzz::text_of(data, size)), {}, trouble);
    sessions.device_of("token", 0.0);
    if (!trouble.empty()) fuzz::check_message(trouble);
    return 0;
}
