// Sensors against their simulators, over loopback UDP and a pseudo-terminal.

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <functional>
#include <signal.h>
#include <thread>
#include <unistd.h>

#include "devices/load_cell.h"
#include "devices/netft.h"
#include "devices/sensor_reader.h"
#include "devices/simulators/process.h"
#include "tests/close_to.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::test;
using palpa::devices::simulators::SimulatorProcess;

namespace {

struct Sent {
    long long records = 0, lost = 0, duplicate = 0, reordered = 0;
};

Sent parse(const std::string& text) {
    Sent sent;
    REQUIRE(std::sscanf(text.c_str(), "sent %lld lost %lld duplicate %lld reordered %lld", &sent.records, &sent.lost,
                        &sent.duplicate, &sent.reordered) == 4);
    return sent;
}

// Reads until `done` says so, 30 s at most.
std::vector<ForceReading> read_until(SensorReader& reader,
                                     const std::function<bool(const std::vector<ForceReading>&)>& done) {
    std::vector<ForceReading> all;
    const double until_s = steady_s() + 30.0;
    while (steady_s() < until_s && !done(all)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        reader.poll(all);
    }
    return all;
}

SensorReader* open_reader(const SimulatorProcess& simulator, std::unique_ptr<SensorReader>& reader) {
    NetFtOptions options;
    options.host = "127.0.0.1";
    options.port = std::atoi(simulator.port().c_str());
    reader = std::make_unique<SensorReader>(open_netft(options));
    return reader.get();
}

}  // namespace

TEST_CASE(
    "simulators: Ctrl-C at the terminal reaches the program alone, which ends them after its devices are at rest") {
    const SimulatorProcess simulator(PALPA_NETFT_SIMULATOR, {"--rate-Hz", "500"});
    CHECK(::getpgid(simulator.pid()) == simulator.pid());
}

TEST_CASE("Net F/T: 7 kHz with nothing lost, times and forces as sent") {
    // PALPA_LONG_S: for how long (3 s here; 60 s in the long run)
    const char* asked = std::getenv("PALPA_LONG_S");
    const std::string seconds = asked != nullptr ? asked : "3";
    SimulatorProcess simulator(PALPA_NETFT_SIMULATOR,
                               {"--rate-Hz", "7000", "--seconds", seconds, "--first-sequence", "4294960000"});
    std::unique_ptr<SensorReader> reader;
    open_reader(simulator, reader);
    const double until_s = steady_s() + std::atof(seconds.c_str()) + 0.7;
    std::vector<ForceReading> all;
    while (steady_s() < until_s) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        reader->poll(all);
    }
    const Sent sent = parse(simulator.line());
    const SensorHealth health = reader->health();
    MESSAGE("sent ", sent.records, ", received ", health.received, " in ", seconds, " s");
    CHECK(sent.records > 6000 * (std::atoi(seconds.c_str()) - 1));
    CHECK(static_cast<long long>(all.size()) == sent.records);
    CHECK(health.received == sent.records);
    CHECK(health.lost == 0);
    CHECK(health.overflowed == 0);
    CHECK(health.duplicate + health.reordered + health.malformed + health.faults == 0);
    int wrong = 0;
    for (std::size_t i = 1; i < all.size(); ++i) {
        wrong += all[i].t_host_s < all[i - 1].t_host_s;
        wrong +=
            std::abs(all[i].t_device_s - all[i - 1].t_device_s - 1.0 / 7000.0) > 1e-9;  // across the wrap-around too
        wrong += std::abs(all[i].force_N - all[i - 1].force_N) > 1e-3;                  // 3 N, 0.25 Hz: 0.34 mN a step
    }
    CHECK(wrong == 0);
}

TEST_CASE("Net F/T: lost, duplicate and reordered records are counted as the line made them") {
    SimulatorProcess simulator(PALPA_NETFT_SIMULATOR,
                               {"--rate-Hz", "2000", "--seconds", "2", "--lose", "0.02", "--duplicate", "0.03",
                                "--reorder", "0.02", "--noise-N", "0.01", "--seed", "7", "--status", "2147549184"});
    std::unique_ptr<SensorReader> reader;
    open_reader(simulator, reader);
    const auto all =
        read_until(*reader, [&](const auto& so_far) { return !so_far.empty() && !reader->health().alive; });
    const Sent sent = parse(simulator.line());
    const SensorHealth health = reader->health();
    CHECK(sent.lost > 20);
    CHECK(sent.duplicate > 20);
    CHECK(sent.reordered > 20);
    CHECK(std::abs(health.lost - sent.lost) <= 2);  // a loss before the first or after the last record has no witness
    CHECK(health.duplicate == sent.duplicate);
    CHECK(std::abs(health.reordered - sent.reordered) <= 1);
    CHECK(health.faults == health.received);
    CHECK(health.stalls == 1);
    for (std::size_t i = 1; i < all.size(); ++i) REQUIRE(all[i].t_device_s > all[i - 1].t_device_s);
}

TEST_CASE("Net F/T: a sensor that falls silent is asked again, and goes on") {
    SimulatorProcess simulator(PALPA_NETFT_SIMULATOR, {"--rate-Hz", "500", "--silent-s", "1.2"});
    std::unique_ptr<SensorReader> reader;
    open_reader(simulator, reader);
    read_until(*reader, [](const auto& so_far) { return so_far.size() > 10; });
    ::kill(simulator.pid(), SIGUSR1);  // silent
    read_until(*reader, [&](const auto&) { return !reader->health().alive; });
    read_until(*reader, [&](const auto&) { return reader->health().alive; });
    const SensorHealth health = reader->health();
    CHECK(health.stalls == 1);
    CHECK(health.reconnects >= 1);
    CHECK(health.alive);
}

TEST_CASE("Net F/T: a sensor that was switched off and on counts anew, and its readings are taken at once") {
    const std::vector<std::string> arguments{"--rate-Hz", "2000", "--first-sequence", "100000"};
    auto simulator = std::make_unique<SimulatorProcess>(PALPA_NETFT_SIMULATOR, arguments);
    std::unique_ptr<SensorReader> reader;
    open_reader(*simulator, reader);
    read_until(*reader, [](const auto& so_far) { return so_far.size() > 100; });
    const std::string port = simulator->port();
    simulator.reset();
    read_until(*reader, [&](const auto&) { return !reader->health().alive; });
    simulator = std::make_unique<SimulatorProcess>(PALPA_NETFT_SIMULATOR,
                                                   std::vector<std::string>{"--rate-Hz", "2000", "--port", port});
    const auto after = read_until(*reader, [](const auto& so_far) { return so_far.size() > 100; });
    CHECK(after.size() > 100);
    CHECK(reader->health().duplicate == 0);
}

TEST_CASE("Net F/T: forces that the sensor calls invalid are counted and not handed on") {
    SimulatorProcess simulator(PALPA_NETFT_SIMULATOR,
                               {"--rate-Hz", "500", "--seconds", "1", "--status", "2147614720"});  // 0x80020000
    std::unique_ptr<SensorReader> reader;
    open_reader(simulator, reader);
    bool began = false;
    const auto all = read_until(*reader, [&](const auto&) {
        began = began || reader->health().alive;
        return began && !reader->health().alive;
    });
    CHECK(all.empty());
    CHECK(reader->health().invalid > 100);
    CHECK(reader->health().received == 0);
}

TEST_CASE("load cell: lines, clock wrap-around, loss, repetition, garbled lines") {
    const TemporaryFolder folder;
    SimulatorProcess simulator(PALPA_LOAD_CELL_SIMULATOR,
                               {"--rate-Hz", "200", "--seconds", "3", "--first-us", "4293967295", "--lose", "0.03",
                                "--duplicate", "0.03", "--reorder", "0.02", "--garble", "0.06", "--seed", "3"});
    LoadCellOptions options;
    options.path = simulator.port();
    options.N_per_count = 1.0 / 40000.0;
    SensorReader reader(open_load_cell(options));
    const auto all = read_until(reader, [&](const auto& so_far) { return !so_far.empty() && !reader.health().alive; });
    const Sent sent = parse(simulator.line());
    const SensorHealth health = reader.health();
    CAPTURE(sent.records);
    CHECK(sent.records >= 590);
    CHECK(health.malformed > 20);
    CHECK(health.duplicate > 5);
    CHECK(health.reordered > 2);
    CHECK(std::abs(health.lost - sent.lost) <= 8);  // a garbled line, a gap in the clock too, is not lost as well
    CHECK(health.received + sent.lost + sent.reordered + health.malformed >= sent.records - 8);
    for (std::size_t i = 1; i < all.size(); ++i) REQUIRE(all[i].t_device_s > all[i - 1].t_device_s);
    CHECK(all.back().t_device_s == close_to(3.0).epsilon(0.03));
    CHECK(all.front().raw >= 84000);
}

TEST_CASE("load cell: unplugged and plugged in again, it goes on by itself") {
    const TemporaryFolder folder;
    const std::string link = (folder / "cell").string();
    SimulatorProcess simulator(PALPA_LOAD_CELL_SIMULATOR, {"--rate-Hz", "100", "--silent-s", "1", "--link", link});
    LoadCellOptions options;
    options.path = simulator.port();
    options.N_per_count = 1.0 / 40000.0;
    SensorReader reader(open_load_cell(options));
    read_until(reader, [](const auto& so_far) { return so_far.size() > 50; });
    ::kill(simulator.pid(), SIGUSR1);  // unplugged
    read_until(reader, [&](const auto&) { return !reader.health().alive; });
    const auto after = read_until(reader, [](const auto& so_far) { return so_far.size() > 10; });
    CHECK(reader.health().reconnects == 1);
    CHECK(reader.health().stalls == 1);
    CHECK(after.size() > 10);
    CHECK_THROWS_WITH_AS(open_load_cell({(folder / "none").string(), 115200, 1.0}),
                         doctest::Contains("none: cannot be opened"), std::runtime_error);
    CHECK_THROWS_WITH_AS(open_load_cell({"/dev/null", 115200, 1.0}), doctest::Contains("is not a serial port"),
                         std::runtime_error);
}
