#include <cmath>
#include <doctest/doctest.h>

#include "calibration/profile.h"
#include "calibration/profile_file.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::calibration;
using namespace palpa::test;

namespace {

Profile shipped(const char* name) { return read_profile(std::string(PALPA_SOURCE_DIR "/assets/profiles/") + name); }

}  // namespace

TEST_CASE("profile: the paper's three curves at both ends of their range") {
    struct Row {
        const char* file;
        double lowest_N;
        double highest_N;
    };
    // a exp(b level), computed by hand from the printed coefficients
    for (const Row& row : {Row{"bamboo.json", 0.0827, 4.46906},
                           {"s-pen.json", 0.1008, 6.77632},
                           {"xoom-finger.json", 0.0772, 1.66768}}) {
        CAPTURE(row.file);
        const Profile profile = shipped(row.file);
        std::int64_t clamped = 0;
        CHECK(force_N(profile, profile.level_lowest, clamped) == close_to(row.lowest_N).epsilon(1e-5));
        CHECK(force_N(profile, profile.level_highest, clamped) == close_to(row.highest_N).epsilon(1e-4));
        CHECK(clamped == 0);
    }
}

TEST_CASE("hard case 4: levels beyond the range are clamped and counted, the inverse too") {
    const Profile profile = shipped("s-pen.json");
    std::int64_t clamped = 0;
    const double highest_N = force_N(profile, 1.0, clamped);
    CHECK(force_N(profile, 1.3, clamped) == highest_N);
    CHECK(force_N(profile, -0.2, clamped) == 0.1008);
    CHECK(clamped == 2);
    for (int i = 0; i <= 1000; ++i) {
        const double level = 1e-3 * i;
        CHECK(std::abs(level_at_force(profile, force_N(profile, level, clamped)) - level) < 1e-12);
    }
    CHECK(level_at_force(profile, 0.0) == 0.0);
    CHECK(level_at_force(profile, 0.05) == 0.0);
    CHECK(level_at_force(profile, -1.0) == 0.0);
    CHECK(level_at_force(profile, 100.0) == 1.0);
    CHECK(level_at_force(profile, std::nan("")) == 0.0);
}

TEST_CASE("profile: each reads its own field of a sample") {
    Sample sample;
    sample.pressure = 0.5;
    sample.pressure_raw = 512;
    sample.width_px = 100;
    sample.height_px = 80;
    CHECK(level_of(shipped("s-pen.json"), sample) == 0.5);
    CHECK(level_of(shipped("bamboo.json"), sample) == 512);
    CHECK(level_of(shipped("xoom-finger.json"), sample) == close_to(3.14159265 / 4 * 8000 / 8000));
    sample.width_px = kMissing;
    CHECK(std::isnan(level_of(shipped("xoom-finger.json"), sample)));
}

TEST_CASE("profile: a level that is written into a sample reads back, whatever the field") {
    for (const char* file : {"bamboo.json", "s-pen.json", "xoom-finger.json"}) {
        CAPTURE(file);
        const Profile profile = shipped(file);
        const double whole = std::round(profile.level_lowest + 0.4 * (profile.level_highest - profile.level_lowest));
        const double level = profile.level == LevelField::pressure_raw ? whole : 0.4;
        Sample sample;
        set_level(profile, level, sample);
        CHECK(level_of(profile, sample) == close_to(level).epsilon(1e-12));
        CHECK(sample.pressure ==
              close_to((level - profile.level_lowest) / (profile.level_highest - profile.level_lowest)));
    }
}
