// Calibration profiles; a curve that was taken can be evaluated and inverted.

#include "calibration/profile_file.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::calibration;

PALPA_FUZZ_ENTRY(profile)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("profile");
    return fuzz::read_or_refuse([&] {
        const Profile profile = read_profile(file.with(fuzz::text_of(data, size)));
        json_text(profile_json(profile, Json::object()));
    });
}
