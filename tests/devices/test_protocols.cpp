// Frames, sequence numbers and lines, without any device.

#include <atomic>
#include <doctest/doctest.h>
#include <random>
#include <string>
#include <thread>

#include "devices/load_cell.h"
#include "devices/netft.h"
#include "devices/sequence.h"
#include "devices/spsc_ring.h"

using namespace palpa;
using namespace palpa::devices;

TEST_CASE("Net F/T: frames are byte for byte as documented") {
    const auto request = encode_rdt_request(RdtCommand::stream, 0);
    const std::array<std::uint8_t, 8> wanted{0x12, 0x34, 0x00, 0x02, 0, 0, 0, 0};
    CHECK(request == wanted);
    RdtRecord record;
    record.rdt_sequence = 0x01020304;
    record.status = 0x80000000;
    record.counts = {1, -1, -2000000, 0, 2147483647, -2147483647 - 1};
    const auto bytes = encode_rdt_record(record);
    CHECK(bytes[0] == 1);
    CHECK(bytes[3] == 4);
    CHECK(bytes[16] == 0xff);  // Fy = -1
    RdtRecord back;
    CHECK(decode_rdt_record(bytes.data(), bytes.size(), back));
    CHECK(back.counts == record.counts);
    CHECK(back.status == record.status);
    CHECK_FALSE(decode_rdt_record(bytes.data(), 35, back));
    CHECK_FALSE(decode_rdt_record(bytes.data(), 37, back));
}

TEST_CASE("sequence: loss, repetition, lateness and restart, across the wrap-around") {
    SensorHealth health;
    Sequence sequence;
    CHECK(track(0xfffffffe, sequence, health) == Arrival::next);
    CHECK(track(0xffffffff, sequence, health) == Arrival::next);
    CHECK(track(2, sequence, health) == Arrival::next);  // 0 and 1 are missing
    CHECK(health.lost == 2);
    CHECK(track(0, sequence, health) == Arrival::late);
    CHECK(health.lost == 1);
    CHECK(track(0, sequence, health) == Arrival::duplicate);
    CHECK(track(2, sequence, health) == Arrival::duplicate);
    CHECK(health.duplicate == 2);
    CHECK(health.reordered == 1);
    CHECK(track(100, sequence, health) == Arrival::next);
    CHECK(health.lost == 98);
    CHECK(sequence.total == 102);
    CHECK(track(0x40000000, sequence, health) == Arrival::restart);
    CHECK(health.lost == 98);
    CHECK(track(0x40000001, sequence, health) == Arrival::next);
}

TEST_CASE("sequence: after a silence a record that is not ahead is the first of a new count, not a duplicate") {
    SensorHealth health;
    Sequence sequence;
    for (std::uint32_t number = 1; number <= 70000; ++number) track(number, sequence, health);
    CHECK(track(1, sequence, health, true) == Arrival::restart);
    CHECK(track(2, sequence, health) == Arrival::next);
    CHECK(health.duplicate == 0);
    CHECK(health.lost == 0);
    CHECK(sequence.total == 70001);
    CHECK(track(10, sequence, health, true) == Arrival::next);  // the line was cut, the sensor went on
    CHECK(health.lost == 7);
}

TEST_CASE("Net F/T: a record with an error is no force; a monitor condition alone is none") {
    CHECK_FALSE(is_invalid(0));
    CHECK_FALSE(is_invalid(0x00010000));
    CHECK_FALSE(is_invalid(0x80010000));
    CHECK(is_invalid(0x80000000));
    CHECK(is_invalid(0x80020000));
    CHECK(is_invalid(0x80030000));
    CHECK(is_invalid(0xc0000000));
}

TEST_CASE("sequence: what comes late from before the first record was never counted as lost") {
    SensorHealth health;
    Sequence sequence;
    CHECK(track(100, sequence, health) == Arrival::next);
    CHECK(track(99, sequence, health) == Arrival::late);
    CHECK(health.lost == 0);
    CHECK(track(103, sequence, health) == Arrival::next);
    CHECK(health.lost == 2);
    CHECK(track(98, sequence, health) == Arrival::late);
    CHECK(health.lost == 2);
    CHECK(track(102, sequence, health) == Arrival::late);
    CHECK(health.lost == 1);
    CHECK(health.reordered == 3);
}

TEST_CASE("load cell: only whole and sensible lines are taken") {
    SensorHealth health;
    LineParser parser;
    LoadCellLine out;
    std::vector<LoadCellLine> taken;
    const auto give = [&](const std::string& text) {
        for (const char c : text) {
            if (feed(static_cast<std::uint8_t>(c), parser, health, out)) taken.push_back(out);
        }
    };
    give("45,99\n");  // the end of a line that began before the port was opened
    CHECK(taken.empty());
    CHECK(health.malformed == 0);
    give("1000,-8388608\r\n2000,8388607\n4294967295,0\n");
    REQUIRE(taken.size() == 3);
    CHECK(taken[0].raw == -8388608);
    CHECK(taken[2].t_us == 4294967295u);
    for (const char* bad : {"\n", "abc\n", "1,2,3\n", "1;2\n", ",5\n", "5,\n", "1,8388608\n", "4294967296,1\n",
                            "1,2.5\n", "-1,2\n", "1, 2\n"}) {
        const auto before = health.malformed;
        give(bad);
        CAPTURE(bad);
        CHECK(health.malformed == before + 1);
    }
    give(std::string(1000, '7') + "\n3000,5\n");  // no newline for long: skipped to the next
    CHECK(taken.size() == 4);
    std::mt19937_64 random(1);
    for (int i = 0; i < 20000; ++i) feed(static_cast<std::uint8_t>(random()), parser, health, out);
    CHECK(parser.line.size() <= 32);
}

TEST_CASE("load cell: the clock tells loss, repetition, lateness and a reset board") {
    SensorHealth health;
    LoadCellClock clock;
    std::uint32_t t_us = 4294867295u;  // wraps around after 0.1 s
    for (int i = 0; i < 40; ++i) CHECK(take_time(t_us += 12500, clock, health));
    CHECK(health.lost == 0);
    CHECK(clock.total_us == 39 * 12500);
    CHECK_FALSE(take_time(t_us, clock, health));
    CHECK(health.duplicate == 1);
    CHECK(take_time(t_us += 4 * 12500, clock, health));
    CHECK(health.lost == 3);
    CHECK_FALSE(take_time(t_us - 12500, clock, health));
    CHECK(health.lost == 2);
    CHECK(health.reordered == 1);
    LoadCellClock later;
    later.started = true;
    later.last_us = 900000000u;
    CHECK(take_time(5, later, health));
    CHECK(health.lost == 2);
}

TEST_CASE(
    "load cell: a reading that is stamped late loses nothing, and readings that are gone are counted all the same") {
    SensorHealth health;
    LoadCellClock clock;
    std::uint32_t t_us = 0;
    for (int i = 0; i < 40; ++i) take_time(t_us += 12500, clock, health);
    for (const std::uint32_t late_us : {3000u, 9000u, 12430u}) {
        take_time(t_us + 12500 + late_us, clock, health);
        t_us += 12500;
        for (int i = 0; i < 100; ++i) take_time(t_us += 12500, clock, health);
        CHECK(health.lost == 0);
    }
    for (int i = 0; i < 50; ++i) take_time(t_us += i % 2 == 0 ? 25000u : 12500u, clock, health);
    CHECK(health.lost == 25);
    for (int i = 0; i < 50; ++i) take_time(t_us += 12500, clock, health);
    CHECK(health.lost == 25);
    LoadCellClock faster;  // a board whose first step was a gap
    t_us = 0;
    take_time(t_us, faster, health);
    take_time(t_us += 50000, faster, health);
    for (int i = 0; i < 40; ++i) take_time(t_us += 12500, faster, health);
    take_time(t_us += 25000, faster, health);
    CHECK(health.lost == 26);
}

TEST_CASE("ring: every value arrives once and in order, and a full ring says so") {
    auto ring = std::make_unique<SpscRing<int, 64>>();
    constexpr int kCount = 200000;
    std::thread writer([&] {
        for (int i = 0; i < kCount;) {
            if (ring->push(i))
                ++i;
            else
                std::this_thread::yield();
        }
    });
    int next = 0;
    int wrong = 0;
    while (next < kCount) {
        int value = -1;
        if (!ring->pop(value)) {
            std::this_thread::yield();
            continue;
        }
        wrong += value != next;
        ++next;
    }
    writer.join();
    CHECK(wrong == 0);
    for (int i = 0; i < 64; ++i) CHECK(ring->push(i));
    CHECK_FALSE(ring->push(64));
}
