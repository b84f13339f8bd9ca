// The driver of a shape display against simulated boards on a pseudo-terminal.

#include <cmath>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <functional>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "devices/force_sensor.h"
#include "devices/limits.h"
#include "devices/pin_line.h"
#include "devices/pins.h"
#include "devices/simulators/process.h"
#include "files/text.h"
#include "platform/serial_port.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::devices;
using palpa::devices::simulators::SimulatorProcess;
using palpa::test::TemporaryFolder;

namespace {

const std::string kDriverPins = std::string(PALPA_SOURCE_DIR) + "/assets/devices/pins-6x6.json";

PinDevice device_at(const SimulatorProcess& simulator) {
    PinDevice device = read_pin_device(kDriverPins);
    device.port = simulator.port();
    return device;
}

void driver_nap(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Waits up to 40 s.
bool wait_for(const std::function<bool()>& done) {
    for (const double until_s = steady_s() + 40.0; steady_s() < until_s; driver_nap(0.005)) {
        if (done()) return true;
    }
    return false;
}

// Sends the same heights once per millisecond for a time.
void send_for(PinDriver& driver, double height_m, double seconds) {
    const std::vector<double> heights_m(driver.device().pins.size(), height_m);
    for (const double until_s = steady_s() + seconds; steady_s() < until_s; driver_nap(0.001)) driver.send(heights_m);
}

// The newest true heights, mm; the first is the time.
std::vector<double> true_heights(const std::filesystem::path& file) {
    std::string text = files::read_text(file);
    text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n'));
    std::vector<double> out;
    for (const std::string_view field : files::fields_of(std::string_view(text).substr(text.rfind('\n') + 1), '\t')) {
        double value = 0.0;
        REQUIRE(files::parse_number(field, value));
        out.push_back(value);
    }
    return out;
}

// On a busy computer the line may fall silent for so long that a board's timeout fires.
bool no_error_but_timeout(const PinDriver& driver) {
    const PinHealth health = driver.health();
    return ((health.board[0].errors | health.board[1].errors) & ~kMaestroTimeout) == 0;
}

double highest_mm(const std::filesystem::path& file) {
    const std::vector<double> row = true_heights(file);
    REQUIRE(row.size() == 37);
    return *std::max_element(row.begin() + 1, row.end());
}

}  // namespace

TEST_CASE(
    "pins: the driver proves the boards, then the pins go where they are told; a servo that never arrives stays") {
    const TemporaryFolder folder;
    const auto truth = folder / "heights.tsv";
    SimulatorProcess simulator(PALPA_MAESTRO_SIMULATOR, {kDriverPins, "--heights", truth.string(), "--stuck", "7"});
    PinDriver driver(device_at(simulator));
    REQUIRE(wait_for([&] { return driver.state() == PinState::driving; }));
    const PinHealth proved = driver.health();
    CHECK(proved.board[0].timeout);
    CHECK(proved.board[1].timeout);
    CHECK(proved.board[0].crc);
    CHECK(wait_for([&] {
        send_for(driver, 1.5e-3, 0.1);
        const std::vector<double> row = true_heights(truth);
        std::size_t there = 0;
        for (std::size_t i = 1; i < row.size(); ++i) there += std::abs(row[i] - (i == 8 ? 0.0 : 1.5)) < 0.02;
        return there == 36;
    }));
    CHECK(driver.health().frames > 5);
    CHECK(no_error_but_timeout(driver));
}

TEST_CASE("pins: if nobody sends for 100 ms they rest, while the boards stay awake") {
    const TemporaryFolder folder;
    const auto truth = folder / "heights.tsv";
    SimulatorProcess simulator(PALPA_MAESTRO_SIMULATOR, {kDriverPins, "--heights", truth.string()});
    PinDriver driver(device_at(simulator));
    REQUIRE(wait_for([&] { return driver.state() == PinState::driving; }));
    const auto go_up = [&] {
        return wait_for([&] {
            send_for(driver, 2e-3, 0.1);
            return highest_mm(truth) > 1.9;
        });
    };
    CHECK(go_up());
    CHECK(wait_for([&] { return highest_mm(truth) < 0.05; }));
    CHECK(driver.health().resting);
    CHECK(driver.state() == PinState::driving);  // it still talks to the boards
    CHECK(no_error_but_timeout(driver));
    CHECK(go_up());
}

TEST_CASE("pins: boards without a timeout, or without CRC, are not driven") {
    for (const bool timeout : {true, false}) {
        CAPTURE(timeout);
        const TemporaryFolder folder;
        const auto truth = folder / "heights.tsv";
        std::vector<std::string> arguments{kDriverPins, "--heights", truth.string()};
        if (timeout) arguments.insert(arguments.end(), {"--timeout-ms", "0"});
        if (!timeout) arguments.push_back("--no-crc");
        SimulatorProcess simulator(PALPA_MAESTRO_SIMULATOR, arguments);
        PinDriver driver(device_at(simulator));
        REQUIRE(wait_for([&] { return driver.state() != PinState::proving; }));
        CHECK(driver.state() == (timeout ? PinState::no_timeout : PinState::no_crc));
        send_for(driver, 2e-3, 1.0);
        CHECK(driver.state() != PinState::driving);
        CHECK(highest_mm(truth) < 0.05);
        CHECK(driver.health().frames == 0);
    }
}

TEST_CASE("pins: a noisy line does not make a board one that checks no CRC") {
    for (int seed = 1; seed <= 6; ++seed) {
        CAPTURE(seed);
        SimulatorProcess simulator(PALPA_MAESTRO_SIMULATOR,
                                   {kDriverPins, "--garble", "0.03", "--seed", std::to_string(seed)});
        PinDriver driver(device_at(simulator));
        REQUIRE(wait_for([&] { return driver.state() != PinState::proving; }));
        CHECK(driver.state() != PinState::no_crc);
    }
}

TEST_CASE("pins: a device file without CRC drives boards without CRC") {
    SimulatorProcess simulator(PALPA_MAESTRO_SIMULATOR, {kDriverPins, "--no-crc"});
    PinDevice device = device_at(simulator);
    for (PinBoard& board : device.boards) board.address.crc = false;
    PinDriver driver(device);
    CHECK(wait_for([&] { return driver.state() == PinState::driving; }));
}

TEST_CASE("pins: a port that is unplugged and plugged in again is proved again and goes on") {
    const TemporaryFolder folder;
    const std::string link = (folder / "pins").string();
    SimulatorProcess simulator(PALPA_MAESTRO_SIMULATOR, {kDriverPins, "--link", link, "--silent-s", "1"});
    PinDriver driver(device_at(simulator));
    REQUIRE(wait_for([&] { return driver.state() == PinState::driving; }));
    ::kill(simulator.pid(), SIGUSR1);  // unplugged
    REQUIRE(wait_for([&] { return driver.state() == PinState::gone; }));
    CHECK(wait_for([&] { return driver.state() == PinState::driving; }));
    CHECK(driver.health().reconnects >= 1);
    CHECK(driver.health().board[0].timeout);
    PinDevice none = driver.device();
    none.port = (folder / "none").string();
    CHECK_THROWS_WITH_AS(PinDriver{none}, doctest::Contains("cannot be opened"), std::runtime_error);
}

TEST_CASE("pins: boards that hang stay a fault, also while they are proved again") {
    SimulatorProcess simulator(PALPA_MAESTRO_SIMULATOR, {kDriverPins});
    PinDriver driver(device_at(simulator));
    REQUIRE(wait_for([&] { return driver.state() == PinState::driving; }));
    ::kill(simulator.pid(), SIGSTOP);
    REQUIRE(wait_for([&] { return fault_of(driver.state()) != Fault::none; }));
    for (const double until_s = steady_s() + 2.0; steady_s() < until_s; driver_nap(0.001))
        REQUIRE(fault_of(driver.state()) != Fault::none);  // reopened several times
    ::kill(simulator.pid(), SIGCONT);
    CHECK(wait_for([&] { return driver.state() == PinState::driving; }));
}

TEST_CASE("pins: a line that loses, doubles and garbles bytes is counted, and no pin leaves its stroke") {
    const TemporaryFolder folder;
    const auto truth = folder / "heights.tsv";
    SimulatorProcess simulator(PALPA_MAESTRO_SIMULATOR, {kDriverPins, "--heights", truth.string(), "--lose", "0.001",
                                                         "--double", "0.001", "--garble", "0.001", "--seed", "5"});
    PinDriver driver(device_at(simulator));
    REQUIRE(wait_for([&] {
        send_for(driver, 1e-3, 0.05);
        const PinHealth health = driver.health();
        return health.frames > 100 && health.board[0].error_replies + health.board[1].error_replies > 3;
    }));
    const std::string text = files::read_text(truth);
    std::size_t rows = 0;
    for (const std::string_view line : files::fields_of(std::string_view(text).substr(0, text.rfind('\n')), '\n')) {
        if (rows++ == 0) continue;
        const auto fields = files::fields_of(line, '\t');
        for (std::size_t i = 1; i < fields.size(); ++i) {
            double height_mm = -1.0;
            REQUIRE(files::parse_number(fields[i], height_mm));
            REQUIRE(height_mm >= -1e-9);
            REQUIRE(height_mm <= 2.0 + 1e-9);
        }
    }
}

TEST_CASE("pins: nobody on the line is no answer, and nothing is driven") {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
    REQUIRE(master >= 0);
    REQUIRE(::grantpt(master) == 0);
    REQUIRE(::unlockpt(master) == 0);
    PinDevice device = read_pin_device(kDriverPins);
    device.port = ::ptsname(master);
    const int slave = ::open(device.port.c_str(), O_RDWR | O_NOCTTY);
    {
        PinDriver driver(device);
        CHECK(wait_for([&] { return driver.state() == PinState::no_answer; }));
    }
    ::close(slave);
    ::close(master);
}

TEST_CASE("serial port: one that is open is not opened again, by this program or another, until it is let go") {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
    REQUIRE(master >= 0);
    REQUIRE(::grantpt(master) == 0);
    REQUIRE(::unlockpt(master) == 0);
    const std::string port = ::ptsname(master);
    {
        const platform::SerialPort first(port, 115200);
        CHECK_THROWS_WITH_AS(platform::SerialPort(port, 115200), (port + ": is used by another program").c_str(),
                             std::runtime_error);
    }
    CHECK_NOTHROW(platform::SerialPort(port, 115200));
    ::close(master);
}

TEST_CASE("pins: after SIGKILL of the program the boards let the pins rest by their own timeout") {
    const TemporaryFolder folder;
    const auto truth = folder / "heights.tsv";
    SimulatorProcess simulator(PALPA_MAESTRO_SIMULATOR, {kDriverPins, "--heights", truth.string()});
    const PinDevice device = device_at(simulator);
    const pid_t child = ::fork();
    if (child == 0) {
        PinDriver driver(device);
        const std::vector<double> heights_m(device.pins.size(), 2e-3);
        for (;; driver_nap(0.001)) driver.send(heights_m);
    }
    const bool up = wait_for([&] {
        const std::string text = files::read_text(truth);
        return text.find('\n') != text.rfind('\n') && highest_mm(truth) > 1.9;
    });
    ::kill(child, SIGKILL);
    const double killed_s = steady_s();
    ::waitpid(child, nullptr, 0);
    REQUIRE(up);
    REQUIRE(wait_for([&] { return highest_mm(truth) < 0.05; }));
    MESSAGE("at rest ", steady_s() - killed_s, " s after the kill (timeout 0.1 s, 2 mm at 30 mm/s)");
}
