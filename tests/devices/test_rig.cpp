// The wires of a device file.

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "devices/rig.h"
#include "files/input_error.h"
#include "tests/close_to.h"
#include "tests/devices/wires.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::test;

namespace {

// What reading the rig complains of, with `from` replaced by `to` in its text.
std::string complaint(const std::string& kind, const std::string& from, const std::string& to) {
    std::string text = rig_text(kind);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    return message_of([&] { rig_from(text); });
}

bool says(const std::string& message, std::initializer_list<const char*> parts) {
    for (const char* part : parts) {
        if (!contains(message, part)) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("rig: what is read is written, and read again alike") {
    for (const char* kind : {"framed", "regulator", "maestro", "sketch"}) {
        CAPTURE(kind);
        const ActuatorRig rig = rig_from(rig_text(kind));
        const ActuatorRig back = rig_from(rig_json(rig).dump());
        REQUIRE(back.channels.size() == rig.channels.size());
        for (std::size_t i = 0; i < rig.channels.size(); ++i) {
            const RigChannel &a = rig.channels[i], &b = back.channels[i];
            CHECK(a.name == b.name);
            CHECK(a.port == b.port);
            CHECK(a.id == b.id);
            CHECK(a.drive == b.drive);
            const auto numbers = [](const RigChannel& c) {
                return std::array{c.zero_counts,
                                  c.counts_per_unit,
                                  c.lower,
                                  c.upper,
                                  c.relaxed,
                                  c.rate_per_s,
                                  1e3 * c.force_N_per_unit,
                                  c.current_limit_counts};
            };
            for (std::size_t k = 0; k < numbers(a).size(); ++k)
                CHECK(numbers(a)[k] == close_to(numbers(b)[k]).epsilon(1e-12));
        }
        CHECK(rig_json(back)["ports"] == rig_json(rig)["ports"]);
    }
    const ActuatorRig rig = rig_from(rig_text("regulator"));
    CHECK(rig.channels[1].lower == close_to(0.02));
    CHECK(rig.channels[1].counts_per_unit == close_to(-40000.0));
    CHECK(rig.channels[2].upper == close_to(5000.0));
    CHECK(rig.channels[2].force_N_per_unit == close_to(1443e-6));
    CHECK(rig.channels[2].id == 2);
    CHECK(rig.sensor.front().m_per_count == close_to(1e-6));
}

TEST_CASE("rig: bad wires are refused with file, key, what was found and what was expected") {
    CHECK(
        says(complaint("framed", "\"id\": 2", "\"id\": 0"), {"rig.json", "actuators[1].id", "0", "no other actuator"}));
    CHECK(says(complaint("framed", "\"port\": \"board\"", "\"port\": \"bord\""), {"actuators[0].port", "'bord'"}));
    CHECK(says(complaint("framed", "[0, 5.5]", "[5.5, 0]"), {"actuators[0].range_N", "the lower end first"}));
    CHECK(says(complaint("framed", "\"counts_per_N\": 10000", "\"counts_per_N\": 1e6"), {"counts_per_N", "5.5e+06"}));
    CHECK(says(complaint("framed", "\"counts_per_N\": 10000", "\"counts_per_N\": 0"), {"counts_per_N", "found 0"}));
    CHECK(says(complaint("framed", "\"drive\": \"force\"", "\"drive\": \"torque\""), {"actuators[0].drive", "force"}));
    CHECK(says(complaint("framed", "\"rate_N_per_s\": 200", "\"rate_N_per_s\": 0"), {"rate_N_per_s", "> 0"}));
    CHECK(says(complaint("framed", "\"name\": \"right\"", "\"name\": \"left\""), {"actuators[1].name", "'left'"}));
    CHECK(says(complaint("framed", "\"name\": \"board\"", "\"name\": \"sensor\""), {"ports[0].name", "'sensor'"}));
    CHECK(says(complaint("framed", "\"protocol\": \"framed\"", "\"protocol\": \"modbus\""),
               {"ports[0].protocol", "alicat"}));
    CHECK(says(complaint("framed", "\"total_force_N\": 9", "\"total_force_N\": 0"), {"total_force_N"}));
    CHECK(says(complaint("framed", "\"id\": 2", "\"idd\": 2"), {"idd"}));
    CHECK(says(complaint("framed", "\"counts_per_mm\": 1000", "\"counts_per_mm\": 0"), {"sensor.counts_per_mm"}));
    CHECK(says(complaint("regulator", "\"unit\": \"C\"", "\"unit\": \"c\""), {"actuators[2].unit", "A to Z"}));
    CHECK(says(complaint("regulator", "\"current_limit_counts\": 400", "\"current_limit_counts\": 0"),
               {"current_limit_counts"}));
    CHECK(says(complaint("regulator", "\"relaxed_mm\": 58, ", ""), {"relaxed_mm"}));
    CHECK(
        says(complaint("maestro", "\"drive\": \"length\"", "\"drive\": \"force\""), {"actuators[0].drive", "maestro"}));
    CHECK(says(complaint("maestro", "\"relaxed_mm\": 14", "\"relaxed_mm\": 13"), {"relaxes elsewhere"}));
}

TEST_CASE("rig: ports of the command line replace those of the file") {
    ActuatorRig rig = rig_from(rig_text("regulator"));
    set_port("motors=/dev/pts/7", rig);
    set_port("sensor=udp:127.0.0.1:4021", rig);
    CHECK(rig.ports[0].path == "/dev/pts/7");
    CHECK(rig.sensor.front().place.host == "127.0.0.1");
    CHECK(rig.sensor.front().place.port == 4021);
    set_port("sensor=/dev/pts/8", rig);
    CHECK(rig.sensor.front().place.host.empty());
    CHECK(rig.sensor.front().place.path == "/dev/pts/8");
    for (const char* bad : {"motor=/dev/pts/7", "motors", "motors=", "=x", "", "sensor=udp:here", "sensor=udp:here:0",
                            "sensor=udp::12", "sensor=udp:here:70000", "sensor=udp:here:1x"}) {
        CAPTURE(bad);
        CHECK_THROWS_WITH_AS(set_port(bad, rig), doctest::Contains("motors=PATH, air=PATH, sensor=PATH"),
                             files::InputError);
    }
}

TEST_CASE("rig: whatever is wanted, counts stay within range, and no number is rest") {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                     kEndless = std::numeric_limits<double>::infinity();
    for (const char* kind : {"framed", "regulator", "maestro", "sketch"}) {
        const ActuatorRig rig = rig_from(rig_text(kind));
        for (const RigChannel& channel : rig.channels) {
            CAPTURE(channel.name);
            const RigPort& port = rig.ports[channel.port];
            for (const double value : {kNone, kEndless, -kEndless, 1e300, -1e300, 0.0, channel.lower, channel.upper}) {
                const double back = value_of(channel, counts_of(port, channel, value));
                CHECK(back >= channel.lower - 1e-9);
                CHECK(back <= channel.upper + 1e-9);
                if (!std::isfinite(value)) CHECK(back == close_to(channel.relaxed));
            }
        }
    }
}

TEST_CASE("rig: the servos of a Maestro as pins: pulses at both ends and at rest are those of the channels") {
    const ActuatorRig rig = rig_from(rig_text("maestro"));
    const PinDevice pins = pins_of(rig, 0);
    REQUIRE(pins.pins.size() == 2);
    CHECK(pins.boards[0].first == 3);
    CHECK(pins.boards[0].count == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        const RigChannel& channel = rig.channels[i];
        for (const double value : {channel.lower, channel.upper, channel.relaxed}) {
            const double us = channel.zero_counts + channel.counts_per_unit * value;
            CHECK(quarter_us_of(pins, pins.pins[i], value - channel.lower) == std::lround(4.0 * us));
        }
        CHECK(pins.rest_m == close_to(channel.relaxed - channel.lower));
    }
}
