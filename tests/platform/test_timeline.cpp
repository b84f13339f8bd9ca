#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "platform/timeline.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::test;

namespace {

Sample at(double t_host_s, double t_device_s = kMissing) {
    Sample sample;
    sample.t_host_s = t_host_s;
    sample.t_device_s = t_device_s;
    return sample;
}

}  // namespace

TEST_CASE("hard case 11: time never goes back; backwards and duplicate samples are counted") {
    Timeline timeline;
    CHECK(move_to(at(1.0), timeline));
    CHECK_FALSE(move_to(at(0.5), timeline));
    CHECK(timeline.now_s == 1.0);
    CHECK(move_to(at(1.0), timeline));
    CHECK(move_to(at(100.0), timeline));
    CHECK_FALSE(move_to(at(std::nan("")), timeline));
    CHECK_FALSE(move_to(at(INFINITY), timeline));
    CHECK(timeline.backwards == 3);
    CHECK(timeline.duplicates == 1);
}

TEST_CASE("hard case 11: samples stamped in one go by the host keep the spacing of the device's clock") {
    Timeline timeline;
    double before_s = 0.0;
    for (int i = 0; i < 6000; ++i) {
        const double t_s = 1e-3 * i;
        const double frame_s = std::ceil(t_s * 60.0) / 60.0;  // the host sees them once a frame
        REQUIRE(move_to(at(50.0 + frame_s, 7.0 + t_s), timeline));
        if (i > 1000) CHECK(timeline.now_s - before_s == close_to(1e-3).epsilon(0.11));
        before_s = timeline.now_s;
    }
    CHECK(timeline.now_s == close_to(50.0 + 5.999).epsilon(1e-4));
    CHECK(timeline.clock_jumps == 0);
}

TEST_CASE("hard case 11: a sample a frame behind another source is taken, now; time stands still for it") {
    Timeline timeline;
    CHECK(move_to(at(1.000, 0.990), timeline));
    CHECK(move_to(at(1.004), timeline));  // a held mouse's own tick
    CHECK(move_to(at(1.005, 0.991), timeline));
    CHECK(timeline.now_s == 1.004);
    CHECK(timeline.late == 1);
    CHECK(timeline.backwards == 0);
}

TEST_CASE("hard case 11: after a slow frame a device's samples are behind those of a held button, and are taken, now") {
    Timeline timeline;
    CHECK(move_to(at(10.0, 5.0), timeline));
    CHECK(move_to(at(10.5), timeline));  // stamped by the host
    CHECK(move_to(at(10.55, 5.2), timeline));
    CHECK(timeline.late == 1);
    CHECK(timeline.now_s == 10.5);
    CHECK_FALSE(move_to(at(10.6, 5.1), timeline));  // the device's own clock went back
    CHECK(timeline.backwards == 1);
}

TEST_CASE("hard case 11: a device clock that runs at another rate, is set, or jitters backwards") {
    constexpr std::uint32_t kSeed = 4;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> delay(0.0, 8e-3);
    Timeline timeline;
    for (int i = 0; i < 60000; ++i) {
        const double t_s = 1e-3 * i;
        REQUIRE(move_to(at(t_s + delay(random), 3.0 + t_s * (1.0 + 1e-4)), timeline));  // 100 ppm fast
        if (i > 2000) REQUIRE(std::abs(timeline.now_s - t_s) < 9e-3);
    }
    CHECK(move_to(at(60.001, 9999.0), timeline));  // set forward by hours
    CHECK(timeline.clock_jumps == 1);
    CHECK(timeline.now_s == close_to(60.001));
    CHECK_FALSE(move_to(at(60.002, 9998.8), timeline));
    CHECK(timeline.backwards == 1);
}

TEST_CASE("timeline: events that queued up behind a stall put no time into the future, and a held press goes on") {
    Timeline timeline;
    const auto at = [&](double host_s, double device_s) {
        Sample sample;
        sample.t_host_s = host_s;
        sample.t_device_s = device_s;
        return move_to(sample, timeline);
    };
    for (int k = 0; k < 10; ++k) CHECK(at(10.0 + 0.01 * k, 0.01 * k));
    for (int k = 0; k < 10; ++k) CHECK(at(13.0, 0.2 + 0.1 * k));  // moves of a second, after a stall of three
    CHECK(timeline.now_s <= 13.1 + 1e-9);
    Sample held;  // stamped by the host alone
    held.t_host_s = 13.01;
    CHECK(move_to(held, timeline));
    CHECK(timeline.backwards == 0);
}
