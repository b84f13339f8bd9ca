#include <bit>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "session/device_loop.h"
#include "tests/scene/allocations.h"
#include "tests/session/spring_device.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::session;
using namespace palpa::test;

namespace {

PenContact pressed(double time_s) {
    return {time_s, 0.06, 0.05, 2e-3 * std::sin(7.0 * time_s), 1.0 + std::cos(5.0 * time_s), 0.1, 1.0};
}

std::vector<double> replayed_N(const std::vector<DeviceRow>& rows) {
    std::vector<double> out;
    DeviceMemory<SpringDevice> memory;
    replay_device<SpringDevice>({}, rows, memory,
                                [&](const SpringDevice::Command& command, double) { out.push_back(command.force_N); });
    return out;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
               return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
           });
}

}  // namespace

TEST_CASE(
    "device loop: a second of a spring, live in its thread, replays from its file to the same commands, bit for bit") {
    const TemporaryFolder folder;
    const auto file = device_rows_of(folder / "t.tsv", "spring");
    const auto fields = field_names<SpringDevice::Feedback>();
    DeviceLoop<SpringDevice> loop{{}};
    SpringPort port;
    port.sent_N.reserve(100000);
    {
        DeviceRowWriter writer(file, fields);
        DeviceThread<SpringDevice, SpringPort> thread(1000.0, port, loop);
        int handed_over = 0;
        for (int i = 0; i < 100 || handed_over < 2; ++i) {  // the pen's samples, and a frame that writes
            loop.pen.put(pressed(0.01 * i));
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            for (DeviceRow row; loop.recorded.take(row);) {
                writer.write(row);
                handed_over += row.kind == DeviceRowKind::hand_over ? 1 : 0;
            }
        }
        thread.stop();
        write_recorded(loop.recorded, writer);
        CHECK(writer.sync());
    }
    CHECK(loop.report.lost_rows == 0);
    CHECK(loop.report.refused_commands == 0);
    CHECK(loop.report.rows > 0);
    CHECK(loop.report.hand_overs > 1);
    CHECK(port.sent_N.size() == static_cast<std::size_t>(loop.report.rows));
    const std::vector<DeviceRow> rows = read_device_rows(file, fields);
    CHECK(static_cast<std::int64_t>(rows.size()) == loop.report.rows + loop.report.hand_overs);
    CHECK(same_bits(replayed_N(rows), port.sent_N));

    // the hand-overs matter: without them the commands are others
    std::vector<DeviceRow> without = rows;
    std::erase_if(without, [](const DeviceRow& row) { return row.kind == DeviceRowKind::hand_over; });
    CHECK_FALSE(same_bits(replayed_N(without), port.sent_N));
}

TEST_CASE("device loop: a period allocates nothing, with hand-overs and with a full ring") {
    DeviceLoop<SpringDevice> loop{{}};
    SpringPort port;
    port.sent_N.reserve(100000);
    const std::int64_t before = allocations();
    for (int i = 0; i < 20000; ++i) {
        if (i % 8 == 0) loop.pen.put(pressed(1e-3 * i));
        run_period<SpringDevice>(1e-3 * i, port, loop);
    }
    CHECK(allocations() == before);
    CHECK(loop.report.rows == 20000);
    CHECK(loop.report.hand_overs == 2500);
}

TEST_CASE("device loop: once the ring was full nothing more is recorded, and what is recorded replays") {
    DeviceLoop<SpringDevice> loop{{}};
    SpringPort port;
    port.sent_N.reserve(100000);
    std::vector<DeviceRow> rows;
    const auto collect = [&] {
        for (DeviceRow row; loop.recorded.take(row);) rows.push_back(row);
    };
    for (int i = 0; i < 9000; ++i) run_period<SpringDevice>(1e-3 * i, port, loop);
    collect();
    for (int i = 9000; i < 9100; ++i) run_period<SpringDevice>(1e-3 * i, port, loop);
    collect();
    CHECK(rows.size() == 8192);
    CHECK(loop.report.lost_rows == 9100 - 8192);
    port.sent_N.resize(8192);
    CHECK(same_bits(replayed_N(rows), port.sent_N));
}

TEST_CASE("device loop: what is not a number is neither run, nor sent, nor recorded; silence is counted") {
    DeviceLoop<SpringDevice> loop{{}};
    SpringPort port;
    port.sent_N.reserve(100);
    run_period<SpringDevice>(0.0, port, loop);
    port.silent = true;
    run_period<SpringDevice>(1e-3, port, loop);
    port.silent = false;
    port.position_m = std::numeric_limits<double>::quiet_NaN();
    run_period<SpringDevice>(2e-3, port, loop);
    port.position_m = 0.0;
    PenContact broken = pressed(0.0);
    broken.depth_m = std::numeric_limits<double>::infinity();
    loop.pen.put(broken);
    run_period<SpringDevice>(3e-3, port, loop);
    CHECK(loop.report.silent == 1);
    CHECK(loop.report.not_numbers == 2);
    CHECK(loop.report.hand_overs == 0);
    CHECK(port.sent_N.size() == 2);
    loop.plan.stiffness_N_per_m = 1e308;  // the command overflows
    port.position_m = 1e3;
    run_period<SpringDevice>(4e-3, port, loop);
    CHECK(loop.report.refused_commands == 1);
    CHECK(port.sent_N.size() == 2);
}
