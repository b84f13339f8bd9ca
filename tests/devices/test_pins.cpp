// Device files of shape displays and arms, pulses, calibration.

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

#include "devices/arm.h"
#include "devices/pin_calibration.h"
#include "devices/pins.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::test;
using palpa::test::contains;
using palpa::test::TemporaryFolder;

namespace {

const std::string kPins = std::string(PALPA_SOURCE_DIR) + "/assets/devices/pins-6x6.json";
const std::string kArm = std::string(PALPA_SOURCE_DIR) + "/assets/devices/arm.json";

// What is said about a file in which one text was replaced by another.
template <class Read>
std::string said_about(const std::string& file, const std::string& from, const std::string& to, Read&& read) {
    const TemporaryFolder folder;
    std::string text = files::read_text(file);
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    files::write_text_whole(folder / "device.json", text);
    return test::message_of([&] { read(folder / "device.json"); });
}

std::string pins_with(const std::string& from, const std::string& to) {
    return said_about(kPins, from, to, [](const auto& path) { read_pin_device(path); });
}

std::string arm_with(const std::string& from, const std::string& to) {
    return said_about(kArm, from, to, [](const auto& path) { read_arm_device(path); });
}

}  // namespace

TEST_CASE("pins: the shipped device has 36 pins on two boards") {
    const PinDevice device = read_pin_device(kPins);
    CHECK(device.pins.size() == 36);
    REQUIRE(device.boards.size() == 2);
    CHECK(device.boards[0].count == 18);
    CHECK(device.boards[1].address.device == 13);
    CHECK(device.boards[1].address.chained);
    CHECK(device.stroke_m == close_to(2e-3));
    CHECK(device.pins[35].board == 1);
    CHECK(device.pins[35].channel == 17);
}

TEST_CASE("pins: a wrong device file is refused with key, what was found and what was expected") {
    CHECK(contains(pins_with("\"channel\": 1}", "\"channel\": 0}"),
                   "a channel of board 12 that no other pin has"));  // two pins on one channel
    CHECK(contains(pins_with("\"channel\": 17}", "\"channel\": 18}"), "channel"));
    CHECK(contains(pins_with("\"rows\": 6", "\"rows\": 5"), "36 pins"));
    CHECK(contains(pins_with("\"zero_us\": 1300", "\"zero_us\": 1700"), "2100 us"));
    CHECK(contains(pins_with("\"device\": 13", "\"device\": 12"), "no other board has"));
    CHECK(contains(pins_with("\"pololu\"", "\"compact\""), "one board"));
    CHECK(contains(pins_with("\"baud\": 115200", "\"baud\": 9600"), "frame_ms"));
    CHECK(contains(pins_with("\"direction\": 1", "\"direction\": 0"), "direction"));
    CHECK(contains(pins_with("\"stroke_mm\"", "\"stroke_cm\""), "stroke_cm"));
    CHECK(contains(pins_with("\"kind\": \"pins\"", "\"kind\": \"arm\""), "kind"));
    CHECK(contains(pins_with("\"pulse_us\": [992, 2000]", "\"pulse_us\": [2000, 992]"), "pulse_us"));
    CHECK(contains(pins_with("\"channels\": 18}, {", "\"channels\": 12}, {"), "channel"));
    CHECK(
        contains(pins_with("{\"board\": 12, \"channel\": 5}", "{\"board\": 13, \"channel\": 5}"), "no other pin has"));
    CHECK(contains(pins_with("\"channels\": 18}],", "\"channels\": 24}],") +
                       pins_with("\"channel\": 9}", "\"channel\": 9, \"zero_us\": 900}"),
                   "900 us"));
}

TEST_CASE("pins: gaps between a board's channels are refused, since one command sets them all") {
    const std::string said =
        said_about(kPins, "\"boards\": [{\"device\": 12, \"channels\": 18}",
                   "\"boards\": [{\"device\": 12, \"channels\": 24}", [](const auto& path) {
                       std::string text = files::read_text(path);
                       const std::string last = "{\"board\": 12, \"channel\": 17}";
                       text.replace(text.find(last), last.size(), "{\"board\": 12, \"channel\": 20}");
                       files::write_text_whole(path, text);
                       read_pin_device(path);
                   });
    CHECK(contains(said, "gaps between the channels of board 12"));
}

TEST_CASE("pins: a written device file reads back") {
    const TemporaryFolder folder;
    PinDevice device = read_pin_device(kPins);
    device.pins[7].zero_us = 1312.5;
    device.pins[7].us_per_mm = 187.25;
    device.pins[8] = {0, device.pins[8].channel, 1700.0, 200.0, -1.0};
    write_pin_device(device, folder / "out.json");
    const PinDevice back = read_pin_device(folder / "out.json");
    for (std::size_t i = 0; i < 36; ++i) {
        CHECK(back.pins[i].zero_us == device.pins[i].zero_us);
        CHECK(back.pins[i].us_per_mm == device.pins[i].us_per_mm);
        CHECK(back.pins[i].direction == device.pins[i].direction);
        CHECK(back.pins[i].board == device.pins[i].board);
        CHECK(back.pins[i].channel == device.pins[i].channel);
    }
    CHECK(back.port == device.port);
    CHECK(back.timeout_s == device.timeout_s);
}

TEST_CASE("pins: heights become pulses within the stroke, and what is no number rests") {
    PinDevice device = read_pin_device(kPins);
    const PinServo pin = device.pins[0];
    CHECK(quarter_us_of(device, pin, 0.0) == 5200);
    CHECK(quarter_us_of(device, pin, 2e-3) == 6800);
    CHECK(quarter_us_of(device, pin, 1.0) == 6800);
    CHECK(quarter_us_of(device, pin, -1.0) == 5200);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        CHECK(quarter_us_of(device, pin, bad) == 5200);
    CHECK(height_m_of(pin, 6000.0) == close_to(1e-3));
    const PinServo down{0, 0, 1700.0, 200.0, -1.0};
    CHECK(quarter_us_of(device, down, 2e-3) == 5200);
    CHECK(height_m_of(down, 5200.0) == close_to(2e-3));
}

TEST_CASE("pins: a frame holds one packet for each board; a board of six channels gets one for each pin") {
    PinDevice device = read_pin_device(kPins);
    const std::vector<double> heights_m(36, 1e-3);
    PinFrame frame;
    pin_frame(device, heights_m, frame);
    CHECK(frame.size == 2 * (6 + 2 * 18));
    CHECK(frame.bytes[0] == 0xaa);
    CHECK(frame.bytes[2] == 0x1f);
    CHECK(crc7(frame.view().first(41)) == frame.bytes[41]);
    device.rows = device.columns = 2;
    device.pins.resize(4);
    device.boards.resize(1);
    device.boards[0].channels = 6;
    device.boards[0].count = 4;
    pin_frame(device, std::span(heights_m).first(4), frame);
    CHECK(frame.size == 4 * 7);
}

TEST_CASE("pins: a calibration finds zeros, gains and directions, and says which pin is stuck") {
    const PinDevice device = read_pin_device(kPins);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> off(-0.1, 0.1);
    PinDevice truth = device;
    for (PinServo& pin : truth.pins) {
        pin.zero_us += 400.0 * off(random);
        pin.us_per_mm *= 1.0 + off(random);
    }
    PinMeasurements measured;
    for (const double wanted_m : {0.1e-3, 1e-3, 1.9e-3}) {
        std::vector<double> heights_m;
        for (std::size_t i = 0; i < 36; ++i)
            heights_m.push_back(height_m_of(truth.pins[i], quarter_us_of(device, device.pins[i], wanted_m)));
        measured.wanted_m.push_back(wanted_m);
        measured.height_m.push_back(heights_m);
    }
    const PinCalibration found = calibrate(device, measured);
    for (std::size_t i = 0; i < 36; ++i) {
        CHECK(found.device.pins[i].zero_us == close_to(truth.pins[i].zero_us).epsilon(1e-9));
        CHECK(found.device.pins[i].us_per_mm == close_to(truth.pins[i].us_per_mm).epsilon(1e-9));
    }
    CHECK(found.before_m > 0.05e-3);
    CHECK(found.after_m < 1e-9);
    for (std::vector<double>& heights_m : measured.height_m) heights_m[8] = 1e-3;
    CHECK_THROWS_WITH_AS(calibrate(device, measured), doctest::Contains("row 2, column 3"), std::runtime_error);
}

TEST_CASE("arm: the shipped device file, and wrong ones") {
    const ArmDevice arm = read_arm_device(kArm);
    CHECK(arm.lowest_m == close_to(-0.01));
    CHECK(arm.deepest_m == close_to(0.05));
    REQUIRE(arm.sensor);
    CHECK(arm.sensor->axis == 2);
    CHECK(arm.compensation.empty());
    CHECK(contains(arm_with("\"range_mm\": [-10, 50]", "\"range_mm\": [10, 50]"), "range_mm"));
    CHECK(contains(arm_with("\"impedance\": \"low\"", "\"impedance\": \"medium\""), "impedance"));
    CHECK(contains(arm_with("\"silence_ms\": 100", "\"silence_ms\": 0"), "silence_ms"));
    CHECK(contains(arm_with("\"axis\": \"z\"", "\"axis\": \"w\""), "axis"));
    CHECK(contains(arm_with("\"force_N\": 15", "\"force_n\": 15"), "force_n"));
}
