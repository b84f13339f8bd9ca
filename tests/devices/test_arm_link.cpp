// Packets of a force arm, its link against the simulator, and the simulated arm itself.

#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <functional>
#include <random>
#include <thread>

#include "devices/arm_link.h"
#include "devices/simulators/arm_plant.h"
#include "devices/simulators/process.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/scene/allocations.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::devices::simulators;
using namespace palpa::test;

namespace {

ArmFeedbackPacket some_feedback() {
    ArmFeedbackPacket packet;
    packet.sequence = 0x01020304;
    packet.answers = 7;
    packet.host_time_s = 1.5;
    packet.depth_m = 0.01;
    packet.velocity_m_per_s = -0.02;
    return packet;
}

ArmCommand push(double force_N) { return {force_N, 0.0, 0.0, static_cast<double>(ArmMode::force)}; }

// Sends a command per millisecond and reads, until `done` says so, 20 s at most.
void talk_until(ArmLink& link, const std::function<bool(const ArmFeedback&, bool came)>& done, double force_N = 0.5) {
    ArmFeedback feedback;
    const double until_s = steady_s() + 20.0;
    while (steady_s() < until_s) {
        const bool came = link.read(feedback);
        if (done(feedback, came)) return;
        link.send(push(force_N));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    FAIL("nothing happened for 20 s");
}

int port_of(const SimulatorProcess& simulator) { return std::stoi(simulator.port()); }

}  // namespace

TEST_CASE("arm link: packets are as documented, and read back") {
    ArmCommandPacket command;
    command.sequence = 0x01020304;
    command.mode = 1;
    command.host_time_s = 1.0;
    command.force_N = -2.0;
    const auto bytes = encode(command);
    CHECK(std::memcmp(bytes.data(), "PAC1\x01\x00\x01\x00\x04\x03\x02\x01\x00\x00\x00\x00", 16) == 0);
    CHECK(bytes[23] == 0x3f);  // 1.0
    CHECK(bytes[31] == 0xc0);  // -2.0
    ArmCommandPacket back;
    REQUIRE(decode(bytes, back));
    CHECK(back.sequence == command.sequence);
    CHECK(back.force_N == -2.0);
    const auto feedback = encode(some_feedback());
    CHECK(std::memcmp(feedback.data(), "PAF1", 4) == 0);
    ArmFeedbackPacket out;
    REQUIRE(decode(feedback, out));
    CHECK(out.depth_m == 0.01);
    CHECK(out.answers == 7);
    CHECK_FALSE(decode(bytes, out));  // a command is no feedback
}

TEST_CASE("arm link: the CRC is zlib's, which others have too") {
    const auto bytes = encode(ArmCommandPacket{});
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = 0; i < 44; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    }
    std::uint32_t found = 0;
    std::memcpy(&found, bytes.data() + 44, 4);
    CHECK(found == (crc ^ 0xffffffffu));
}

TEST_CASE("arm link: packets cut at every split, with any bit turned over, or followed by more are refused") {
    const auto bytes = encode(some_feedback());
    ArmFeedbackPacket out;
    for (std::size_t n = 0; n < bytes.size(); ++n) {
        CAPTURE(n);
        CHECK_FALSE(decode(std::span(bytes).first(n), out));
        for (int bit = 0; bit < 8; ++bit) {
            auto garbled = bytes;
            garbled[n] = static_cast<std::uint8_t>(garbled[n] ^ (1 << bit));
            CHECK_FALSE(decode(garbled, out));
        }
    }
    std::vector<std::uint8_t> doubled(bytes.begin(), bytes.end());
    doubled.push_back(bytes.back());
    CHECK_FALSE(decode(doubled, out));
    CHECK(out.depth_m == 0.0);  // nothing of it was taken
}

TEST_CASE("arm link: NaN in any field is refused, also under a right CRC") {
    const double bad = std::nan("");
    const auto refused = [](const ArmFeedbackPacket& packet) {
        ArmFeedbackPacket out;
        return !decode(encode(packet), out);
    };
    for (int field = 0; field < 8; ++field) {
        CAPTURE(field);
        ArmFeedbackPacket packet = some_feedback();
        double* fields[] = {&packet.host_time_s, &packet.held_s,  &packet.device_time_s,    &packet.x_m,
                            &packet.y_m,         &packet.depth_m, &packet.velocity_m_per_s, &packet.motor_N};
        *fields[field] = bad;
        CHECK(refused(packet));
        *fields[field] = std::numeric_limits<double>::infinity();
        CHECK(refused(packet));
    }
    ArmFeedbackPacket odd = some_feedback();
    odd.state = 3;
    CHECK(refused(odd));
    ArmCommandPacket command, out;
    command.force_N = bad;
    CHECK_FALSE(decode(encode(command), out));
    command.force_N = 0.0;
    command.mode = 3;
    CHECK_FALSE(decode(encode(command), out));
}

TEST_CASE("arm link: a command that is no number goes out as rest, whoever sends it") {
    const double bad = std::nan("");
    for (ArmCommand command :
         {ArmCommand{bad, 0.0, 0.0, 1.0}, ArmCommand{1.0, bad, 0.0, 1.0}, ArmCommand{1.0, 0.0, bad, 1.0},
          ArmCommand{1.0, 0.0, 0.0, bad}, ArmCommand{1.0, 0.0, 0.0, 7.0}}) {
        const ArmCommandPacket packet = packet_of(command, 5, 1.0);
        CHECK(packet.mode == 0);
        CHECK(packet.force_N == 0.0);
        CHECK(packet.depth_m == 0.0);
        CHECK(packet.sequence == 5);
    }
    CHECK(packet_of({1.0, -3.0, 0.0, 1.0}, 1, 1.0).force_N == -2.0);
}

TEST_CASE("arm link: one million random bytes, some behind a right head, are no packet") {
    std::mt19937_64 random(11);
    std::vector<std::uint8_t> bytes(1000);
    int taken = 0;
    for (int i = 0; i < 1000; ++i) {
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
        const std::size_t n = i % 2 == 0 ? kArmFeedback_bytes : random() % bytes.size();
        if (i % 4 == 0) std::memcpy(bytes.data(), "PAF1\x01\x00\x00\x00", 8);
        ArmFeedbackPacket feedback;
        ArmCommandPacket command;
        taken += decode(std::span(bytes).first(n), feedback);
        taken += decode(std::span(bytes).first(n), command);
    }
    CHECK(taken == 0);
}

TEST_CASE("arm link: 1 kHz over loopback, nothing lost, and reading allocates nothing") {
    SimulatorProcess simulator(PALPA_ARM_SIMULATOR, {"--seed", "1"});
    ArmLink link("127.0.0.1", port_of(simulator));
    talk_until(link, [](const ArmFeedback&, bool came) { return came; });
    const std::int64_t before = test::allocations();
    talk_until(link, [&](const ArmFeedback&, bool) { return link.health().feedback.received > 500; });
    CHECK(test::allocations() == before);
    const LinkHealth& health = link.health();
    CHECK(health.feedback.lost == 0);
    CHECK(health.feedback.malformed == 0);
    CHECK(health.round_trip.total >= 500);
    MESSAGE("round trip p50 ", 1e3 * health.round_trip.quantile_s(0.5), " ms, p99 ",
            1e3 * health.round_trip.quantile_s(0.99), " ms");
}

TEST_CASE(
    "arm link: lost, duplicate and reordered feedback is counted across the wrap-around, and time never goes back") {
    SimulatorProcess simulator(PALPA_ARM_SIMULATOR, {"--seed", "3", "--first-sequence", "4294967000", "--lose", "0.05",
                                                     "--duplicate", "0.05", "--reorder", "0.05"});
    ArmLink link("127.0.0.1", port_of(simulator));
    double last_s = 0.0;
    int backwards = 0;
    talk_until(link, [&](const ArmFeedback& feedback, bool came) {
        if (!came) return false;
        backwards += feedback.device_time_s < last_s;
        last_s = feedback.device_time_s;
        return link.health().feedback.received > 800;
    });
    const SensorHealth& health = link.health().feedback;
    CHECK(backwards == 0);
    CHECK(health.lost > 10);
    CHECK(health.duplicate > 10);
    CHECK(health.reordered > 10);
    CHECK(health.lost < 150);
}

TEST_CASE("arm link: an arm that falls silent gives no feedback; when it is back, it goes on") {
    SimulatorProcess simulator(PALPA_ARM_SIMULATOR, {"--silent-from-s", "0.3", "--silent-s", "0.4"});
    ArmLink link("127.0.0.1", port_of(simulator));
    double heard_s = steady_s(), longest_s = 0.0;
    talk_until(link, [&](const ArmFeedback&, bool came) {
        const double now_s = steady_s();
        longest_s = std::max(longest_s, now_s - heard_s);
        if (came) heard_s = now_s;
        return came && longest_s > 0.25;
    });
    CHECK(longest_s > 0.3);
}

TEST_CASE("arm link: nobody at the address is silence, not an error") {
    int port = 0;
    {
        SimulatorProcess simulator(PALPA_ARM_SIMULATOR, {});
        port = port_of(simulator);
    }
    ArmLink link("127.0.0.1", port);
    ArmFeedback feedback;
    for (int i = 0; i < 20; ++i) {
        link.send(push(1.0));
        CHECK_FALSE(link.read(feedback));
    }
}

TEST_CASE("arm port: the sensor's zero is taken while nobody presses, then it feels the hand") {
    const test::TemporaryFolder folder;
    files::write_text_whole(folder / "press.tsv",
                            "t_s\tx_mm\ty_mm\tforce_N\n0\t50\t40\t0\n0.2\t50\t40\t3\n100\t50\t40\t3\n");
    SimulatorProcess simulator(PALPA_ARM_SIMULATOR, {"--press", (folder / "press.tsv").string(), "--seed", "0"});
    ArmDevice device;
    device.port = port_of(simulator);
    device.sensor = NetFtOptions{};
    device.sensor->host = "127.0.0.1";
    device.sensor->port = std::stoi(simulator.line().substr(7));
    ArmPort port(device);
    ArmFeedback feedback;
    double felt_N = 0.0;
    const double until_s = steady_s() + 20.0;
    while (steady_s() < until_s && felt_N < 2.5) {
        port.read(feedback);
        // it rests until the sensor has its zero; then the motor holds against the hand and the weight
        const bool zeroed = feedback.has_sensor == 1.0;
        port.send(zeroed ? push(3.0 + 0.8 * 9.80665) : ArmCommand{});
        if (zeroed) felt_N = feedback.sensor_N;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(felt_N == close_to(3.0).epsilon(0.2));
    CHECK(feedback.x_m == close_to(0.05));
}

TEST_CASE("simulated arm: without a command for 100 ms its motor rests, whoever was killed") {
    ArmPlant plant = make_arm_plant(arm_parameters(0), {}, 1);
    command(push(5.0), plant);
    advance(0.05, plant);
    CHECK(plant.motor_N == 5.0);
    advance(0.06, plant);
    CHECK(plant.motor_N == 0.0);
    CHECK(feedback_packet(plant).state == 1);
    command(push(5.0), plant);
    advance(0.001, plant);
    CHECK(plant.motor_N == 5.0);
    CHECK(feedback_packet(plant).state == 0);
}

TEST_CASE("simulated arm: where nobody holds it its brake does, but for where it is led") {
    ArmPlant plant = make_arm_plant(arm_parameters(0), {}, 1);
    for (int k = 0; k < 20; ++k) {
        command(push(1.0), plant);
        advance(0.05, plant);
    }
    CHECK(plant.depth_m == 0.0);
    ArmCommand lead;
    lead.mode = static_cast<double>(ArmMode::position);
    lead.depth_m = 5e-3;
    for (int k = 0; k < 20; ++k) {
        command(lead, plant);
        advance(0.05, plant);
    }
    CHECK(plant.depth_m == close_to(5e-3).epsilon(0.15));
}

TEST_CASE("simulated arm: it sticks below its static friction, and slides above it as the friction's law says") {
    ArmPlantParameters arm = arm_parameters(0);
    arm.weight_kg = 0.0;
    arm.ripple_N = 0.0;
    PressRow row, later;
    row.force_N = 0.0;
    later.t_s = 2.0;
    later.force_N = 2.4;  // risen to slowly: a sudden force would swing over the static friction
    arm.hand_N_s_per_m = 0.0;
    ArmPlant stuck = make_arm_plant(arm, {row, later}, 1);
    for (int i = 0; i < 4000; ++i) {
        command(push(0.0), stuck);
        advance(0.001, stuck);
    }
    CHECK(stuck.depth_m < 0.1e-3);
    row.force_N = 2.9;  // 2 N and 3 N s/m: 0.3 m/s in the end
    arm.deepest_m = 100.0;
    ArmPlant slides = make_arm_plant(arm, {row}, 1);
    for (int i = 0; i < 5000; ++i) {
        command(push(0.0), slides);
        advance(0.001, slides);
    }
    CHECK(slides.velocity_m_per_s == close_to(0.3).epsilon(0.01));
}

TEST_CASE("simulated arm: seeds scatter every parameter by at most a fifth; the same seed is the same arm") {
    const ArmPlantParameters usual = arm_parameters(0);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        const ArmPlantParameters arm = arm_parameters(seed);
        CHECK(arm.coulomb_N != usual.coulomb_N);
        for (const auto& [value, of] : {std::pair{arm.mass_kg, usual.mass_kg},
                                        {arm.coulomb_N, usual.coulomb_N},
                                        {arm.ripple_N, usual.ripple_N},
                                        {arm.weight_kg, usual.weight_kg},
                                        {arm.ripple_wavelength_m, usual.ripple_wavelength_m}})
            CHECK(std::abs(value / of - 1.0) <= 0.2);
        CHECK(arm.static_N >= arm.coulomb_N);
        CHECK(arm_parameters(seed).mass_kg == arm.mass_kg);
    }
}
