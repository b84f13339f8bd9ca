// The guard as a process, with simulated wires on pseudo-terminals.

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <functional>
#include <limits>
#include <signal.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "devices/force_sensor.h"
#include "devices/guard_process.h"
#include "devices/shape_guard.h"
#include "devices/simulators/process.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/devices/wires.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::test;
using palpa::devices::simulators::SimulatorProcess;

namespace {

void guard_nap(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

bool soon(const std::function<bool()>& done) {
    for (const double until_s = steady_s() + 20.0; steady_s() < until_s; guard_nap(0.003)) {
        if (done()) return true;
    }
    return false;
}

struct TruthRow {
    double host_s = 0.0;
    std::vector<double> value;
    bool relaxed = false;
};

std::vector<TruthRow> truth_rows(std::string text) {
    text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n'));
    std::vector<TruthRow> rows;
    if (text.empty()) return rows;
    for (const std::string_view line : files::fields_of(text, '\n')) {
        TruthRow row;
        double number = 0.0;
        for (const std::string_view field : files::fields_of(line, '\t')) {
            REQUIRE(files::parse_number(field, number));
            row.value.push_back(number);
        }
        row.host_s = row.value.front();
        row.relaxed = row.value.back() == 1.0;
        row.value.erase(row.value.begin());
        row.value.pop_back();
        rows.push_back(row);
    }
    return rows;
}

// The rows at the file's end: it grows by 500 rows a second, and the loops below look at it every few milliseconds.
std::vector<TruthRow> last_truth_rows(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    constexpr std::streamoff kEnd_bytes = 2048;
    const std::streamoff size = in.tellg();
    in.seekg(std::max<std::streamoff>(size - kEnd_bytes, 0));
    std::string text(std::istreambuf_iterator<char>(in), {});
    if (size > kEnd_bytes) text.erase(0, text.find('\n') + 1);
    return truth_rows(text);
}

// The simulated wires of a rig, and the rig with their ports.
struct Wires {
    explicit Wires(const std::string& kind, std::vector<std::string> more = {}) {
        files::write_text_atomically(folder / "rig.json", rig_text(kind));
        std::vector<std::string> arguments{(folder / "rig.json").string(), "--truth", truth().string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        simulator = std::make_unique<SimulatorProcess>(PALPA_RIG_SIMULATOR, arguments);
        rig = rig_from(rig_text(kind));
        for (const std::string_view port : files::fields_of(simulator->port(), ' ')) set_port(port, rig);
    }
    std::filesystem::path truth() const { return folder / "truth.tsv"; }
    bool relaxed() const {
        const auto rows = last_truth_rows(truth());
        return !rows.empty() && rows.back().relaxed;
    }
    // When everything was first relaxed after `from_s`; that moment, or infinity.
    double relaxed_after(double from_s) const {
        for (const TruthRow& row : truth_rows(files::read_text(truth()))) {
            if (row.host_s >= from_s && row.relaxed) return row.host_s - from_s;
        }
        return std::numeric_limits<double>::infinity();
    }
    // Ends the simulator; whether a target ever left its range.
    std::string out_of_range() {
        ::kill(simulator->pid(), SIGTERM);
        return simulator->line();
    }

    TemporaryFolder folder;
    std::unique_ptr<SimulatorProcess> simulator;
    ActuatorRig rig;
};

// Halfway into every range, from rest away.
std::vector<double> halfway(const ActuatorRig& rig) {
    std::vector<double> values;
    for (const RigChannel& channel : rig.channels) {
        const double far = std::abs(channel.upper - channel.relaxed) > std::abs(channel.lower - channel.relaxed)
                               ? channel.upper
                               : channel.lower;
        values.push_back(channel.relaxed + 0.4 * (far - channel.relaxed));
    }
    return values;
}

// Sends every 5 ms until `done`. A busy computer may hold this loop up for 100 ms; that is what release() is for.
bool send_until(GuardProcess& guard, std::span<const double> values,
                const std::function<bool(const RigReport&)>& done) {
    RigReport report;
    return soon([&] {
        guard.send(values);
        guard_nap(0.004);
        guard.poll(report);
        if (report.fault == Fault::loop_silent) guard.release();
        return done(report);
    });
}

// The actuators do what they are told, to a hundredth of their ranges.
bool arrived(const Wires& wires, std::span<const double> values) {
    const auto rows = last_truth_rows(wires.truth());
    if (rows.empty()) return false;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const RigChannel& channel = wires.rig.channels[i];
        if (std::abs(rows.back().value[i] - values[i]) > 0.01 * (channel.upper - channel.lower)) return false;
    }
    return true;
}

GuardProcess& driven(GuardProcess& guard, const Wires& wires) {
    guard.wait_until_ready(15.0);
    const std::vector<double> values = halfway(wires.rig);
    REQUIRE(
        send_until(guard, values, [&](const RigReport& report) { return report.driven && arrived(wires, values); }));
    return guard;
}

}  // namespace

TEST_CASE("guard: the actuators of every protocol go where they are told, and the displacement comes back") {
    for (const char* kind : {"framed", "regulator", "maestro", "sketch"}) {
        CAPTURE(kind);
        Wires wires(kind, std::string(kind) == "framed" ? std::vector<std::string>{"--sensor-udp"}
                                                        : std::vector<std::string>{});
        GuardProcess guard(wires.rig, PALPA_GUARD);
        driven(guard, wires);
        RigReport report;
        CHECK(send_until(guard, halfway(wires.rig), [&](const RigReport& now) {
            report = now;
            return now.displacement_count > 20 && now.displacement_m > 0.001 && now.driven &&
                   arrived(wires, halfway(wires.rig));
        }));
        CHECK(report.displacement_m < 0.0061);
        CHECK(report.fault == Fault::none);
        CHECK(report.line[0].errors == 0);
        CHECK(report.sent[0] == close_to(halfway(wires.rig)[0]));
        if (std::string(kind) == "regulator") {
            for (std::size_t i = 0; i < 3; ++i)
                CHECK(report.measured[i] == close_to(halfway(wires.rig)[i]).epsilon(0.05));
        }
        CHECK(wires.out_of_range() == "out_of_range 0");
    }
}

TEST_CASE("guard: relaxed 100 ms after the loop falls silent, and latched until a person releases it") {
    for (const char* kind : {"framed", "regulator"}) {
        CAPTURE(kind);
        Wires wires(kind);
        GuardProcess guard(wires.rig, PALPA_GUARD);
        driven(guard, wires);
        RigReport report;
        CHECK(soon([&] { return guard.poll(report), report.fault == Fault::loop_silent && report.relaxed; }));
        CHECK(soon([&] { return wires.relaxed(); }));
        const auto values = halfway(wires.rig);
        for (int i = 0; i < 20; ++i) guard.send(values), guard_nap(0.005);
        CHECK(wires.relaxed());
        guard.release();
        CHECK(send_until(guard, values, [&](const RigReport& now) { return now.driven && arrived(wires, values); }));
        CHECK(wires.out_of_range() == "out_of_range 0");
    }
}

TEST_CASE("guard: NaN, another number of values, F12: everything relaxes and stays so") {
    Wires wires("regulator");
    GuardProcess guard(wires.rig, PALPA_GUARD);
    const auto values = halfway(wires.rig);
    for (int way = 0; way < 3; ++way) {
        CAPTURE(way);
        guard.release();
        driven(guard, wires);
        std::vector<double> bad = values;
        bad[1] = std::numeric_limits<double>::quiet_NaN();
        if (way == 0) guard.send(bad);
        if (way == 1) guard.send(std::span(values).first(2));
        if (way == 2) guard.stop();
        CHECK(send_until(guard, values, [&](const RigReport& now) { return now.fault != Fault::none && now.relaxed; }));
        CHECK(soon([&] { return wires.relaxed(); }));  // the simulator's file comes after its reply
        RigReport report;
        int sent = 0;
        CHECK(send_until(guard, values, [&](const RigReport& now) { return report = now, ++sent > 20; }));
        CHECK(wires.relaxed());
        CHECK(report.fault == (way == 2 ? Fault::stopped : Fault::not_a_number));
    }
    CHECK(wires.out_of_range() == "out_of_range 0");
}

TEST_CASE(
    "guard: what cannot be driven is said: a port that is not there, devices without watchdogs, a silent sensor") {
    ActuatorRig rig = rig_from(rig_text("framed"));
    set_port("board=/nowhere/at/all", rig);
    CHECK_THROWS_WITH_AS(GuardProcess(rig, PALPA_GUARD), doctest::Contains("/nowhere/at/all: cannot be opened"),
                         std::runtime_error);
    CHECK_THROWS_WITH_AS(GuardProcess(rig, "/nowhere/palpa_guard"), doctest::Contains("/nowhere/palpa_guard"),
                         std::runtime_error);
    for (const char* kind : {"framed", "regulator", "maestro"}) {
        CAPTURE(kind);
        Wires wires(kind, {"--no-watchdogs"});
        GuardProcess guard(wires.rig, PALPA_GUARD);
        CHECK_THROWS_WITH(guard.wait_until_ready(2.5), doctest::Contains("would hold its force"));
        const auto values = halfway(wires.rig);
        for (int i = 0; i < 40; ++i) guard.send(values), guard_nap(0.005);
        CHECK(wires.relaxed());
    }
    Wires wires("framed");
    set_port("sensor=udp:127.0.0.1:9", wires.rig);
    GuardProcess guard(wires.rig, PALPA_GUARD);
    CHECK_THROWS_WITH(guard.wait_until_ready(1.0), doctest::Contains("sensor"));
}

TEST_CASE("guard: unplugged it relaxes and says so; plugged in again it goes on once a person releases it") {
    const TemporaryFolder links;
    for (const char* kind : {"framed", "regulator"}) {
        CAPTURE(kind);
        Wires wires(kind, {"--links", links.path().string(), "--silent-s", "1"});
        GuardProcess guard(wires.rig, PALPA_GUARD);
        driven(guard, wires);
        const auto values = halfway(wires.rig);
        ::kill(wires.simulator->pid(), SIGUSR1);  // unplugged
        CHECK(send_until(guard, values, [](const RigReport& now) { return now.fault == Fault::silence; }));
        CHECK(send_until(guard, values, [](const RigReport& now) { return now.ready; }));  // plugged in again
        CHECK(soon([&] { return wires.relaxed(); }));
        RigReport report;
        CHECK(send_until(guard, values, [&](const RigReport& now) { return report = now, true; }));
        CHECK(report.line[0].reconnects >= 1);
        guard.release();
        CHECK(send_until(guard, values, [&](const RigReport& now) { return now.driven && arrived(wires, values); }));
        CHECK(wires.out_of_range() == "out_of_range 0");
    }
}

TEST_CASE("guard: a bad line and garbage lead to no target out of range") {
    for (const char* kind : {"framed", "regulator"}) {
        CAPTURE(kind);
        Wires wires(kind, {"--lose", "0.003", "--double", "0.003", "--garble", "0.003", "--seed", "5"});
        GuardProcess guard(wires.rig, PALPA_GUARD);
        const auto values = halfway(wires.rig);
        int rounds = 0;
        CHECK(send_until(guard, values, [&](const RigReport& now) {
            if (now.fault != Fault::none) guard.release();
            return ++rounds > 400 && now.line[0].replies > 100;
        }));
        CHECK(wires.out_of_range() == "out_of_range 0");
    }
    Wires wires("framed", {"--garbage-s", "1"});
    GuardProcess guard(wires.rig, PALPA_GUARD);
    driven(guard, wires);
    ::kill(wires.simulator->pid(), SIGUSR2);
    CHECK(send_until(guard, halfway(wires.rig), [](const RigReport& now) { return now.fault != Fault::none; }));
    CHECK(soon([&] { return wires.relaxed(); }));
    CHECK(wires.out_of_range() == "out_of_range 0");
}

TEST_CASE("guard: SIGKILL of the program relaxes everything, also a pressure controller, which has no watchdog") {
    // the long version: PALPA_KILLS=100
    const char* wanted = std::getenv("PALPA_KILLS");
    const int kills = wanted != nullptr ? std::atoi(wanted) : 3;
    std::vector<double> after_ms;
    for (int i = 0; i < kills; ++i) {
        CAPTURE(i);
        Wires wires(i % 3 == 2 ? "framed" : "regulator");
        const std::vector<double> values = halfway(wires.rig);
        const pid_t program = ::fork();
        REQUIRE(program >= 0);
        if (program == 0) {
            try {
                GuardProcess guard(wires.rig, PALPA_GUARD);
                guard.wait_until_ready(10.0);
                RigReport report;
                for (;;) {
                    guard.send(values);
                    guard_nap(0.005);
                    guard.poll(report);
                    if (report.fault == Fault::loop_silent) guard.release();  // a busy computer
                }
            } catch (const std::exception&) {
            }
            ::_exit(1);
        }
        CHECK(soon([&] { return arrived(wires, values); }));
        const double killed_s = steady_s();
        ::kill(program, SIGKILL);
        ::waitpid(program, nullptr, 0);
        CHECK(soon([&] { return wires.relaxed(); }));
        after_ms.push_back(1e3 * wires.relaxed_after(killed_s));
        CHECK(wires.out_of_range() == "out_of_range 0");
    }
    std::sort(after_ms.begin(), after_ms.end());
    MESSAGE(kills << " kills, relaxed after " << after_ms.front() << " to " << after_ms.back() << " ms, median "
                  << after_ms[after_ms.size() / 2] << " ms");
}

TEST_CASE("guard: if the guard is killed, the program hears of it, and devices with watchdogs relax by themselves") {
    Wires wires("framed");
    GuardProcess guard(wires.rig, PALPA_GUARD);
    driven(guard, wires);
    ::kill(guard.pid(), SIGKILL);
    CHECK(send_until(guard, halfway(wires.rig), [](const RigReport& now) { return now.fault == Fault::guard_gone; }));
    CHECK(soon([&] { return wires.relaxed(); }));
}

namespace {

// The simulated arm and boards, and what the guard is told of them.
struct ShapeWires {
    ShapeWires()
        : arm(PALPA_ARM_SIMULATOR, {"--truth", (folder / "arm.tsv").string()}),
          boards(PALPA_MAESTRO_SIMULATOR, {pins_file(), "--heights", (folder / "heights.tsv").string()}) {}
    static std::string pins_file() { return std::string(PALPA_SOURCE_DIR) + "/assets/devices/pins-6x6.json"; }
    ShapeRig rig() const {
        ShapeRig rig;
        rig.arm = ArmDevice{};
        rig.arm->port = std::stoi(arm.port());
        rig.pins = read_pin_device(pins_file());
        rig.pins->port = boards.port();
        rig.force_limit_N = 2.5;
        return rig;
    }
    double highest_mm() const {
        const std::string text = files::read_text(folder / "heights.tsv");
        const std::size_t end = text.rfind('\n'), begin = end == 0 ? 0 : text.rfind('\n', end - 1) + 1;
        double highest = 0.0, number = 0.0;
        const auto fields = files::fields_of(std::string_view(text).substr(begin, end - begin), '\t');
        for (std::size_t i = 1; i < fields.size(); ++i) {
            if (files::parse_number(fields[i], number)) highest = std::max(highest, number);
        }
        return highest;
    }

    TemporaryFolder folder;
    SimulatorProcess arm;
    SimulatorProcess boards;
};

// Sends once a millisecond what raises the pins and presses with the arm.
bool press_until(ShapeGuard& guard, const std::function<bool(const ShapeReport&)>& done) {
    const std::vector<double> heights_m(36, 1.5e-3);
    return soon([&] {
        for (int i = 0; i < 20; ++i) {
            guard.send({1.0, 0.0, 0.0, static_cast<double>(ArmMode::force)}, heights_m);
            guard_nap(0.001);
            guard.poll();
        }
        if (guard.newest().fault == Fault::loop_silent) guard.release();
        return done(guard.newest());
    });
}

}  // namespace

TEST_CASE("guard: arm and pins behind it go where they are told, and rest for good when the loop falls silent") {
    ShapeWires wires;
    ShapeGuard guard(wires.rig(), PALPA_GUARD);
    CHECK(soon([&] { return guard.poll(), guard.newest().ready; }));
    CHECK(
        press_until(guard, [&](const ShapeReport& now) { return wires.highest_mm() > 1.4 && now.arm_readings > 100; }));
    CHECK(guard.newest().fault == Fault::none);
    CHECK(guard.link().sent > 100);
    CHECK(guard.link().round_trip.total > 100);
    CHECK(soon([&] { return guard.poll(), guard.newest().fault == Fault::loop_silent; }));
    CHECK(soon([&] { return wires.highest_mm() < 0.05; }));
    guard.stop();
    guard.release();
    CHECK(press_until(guard, [&](const ShapeReport&) { return wires.highest_mm() > 1.4; }));
    guard.stop();
    CHECK(press_until(
        guard, [&](const ShapeReport& now) { return now.fault == Fault::stopped && wires.highest_mm() < 0.05; }));
}

TEST_CASE("guard: one that stands still is a fault while it does, and lets everything rest for good when it goes on") {
    const std::vector<double> heights_m(36, 1.5e-3);
    {
        ShapeWires wires;
        ShapeGuard guard(wires.rig(), PALPA_GUARD);
        CHECK(soon([&] { return guard.poll(), guard.newest().ready; }));
        CHECK(press_until(guard, [&](const ShapeReport&) { return wires.highest_mm() > 1.4; }));
        const auto sent_until = [&](Fault wanted) {
            return soon([&] {
                guard.send({1.0, 0.0, 0.0, static_cast<double>(ArmMode::force)}, heights_m);
                guard.poll();
                return guard.newest().fault == wanted;
            });
        };
        ::kill(guard.pid(), SIGSTOP);
        CHECK(sent_until(Fault::guard_silent));
        CHECK(guard.newest().count[static_cast<std::size_t>(Fault::guard_silent)] >= 1);
        ::kill(guard.pid(), SIGCONT);
        CHECK(sent_until(Fault::loop_silent));  // what had queued meanwhile is not new
        CHECK(soon([&] { return wires.highest_mm() < 0.05; }));
        guard.release();
        CHECK(press_until(guard, [&](const ShapeReport&) { return wires.highest_mm() > 1.4; }));
    }
    Wires wires("framed");
    GuardProcess guard(wires.rig, PALPA_GUARD);
    driven(guard, wires);
    ::kill(guard.pid(), SIGSTOP);
    RigReport report;
    for (int i = 0; i < 100; ++i) guard.send(halfway(wires.rig)), guard.poll(report), guard_nap(0.003);
    CHECK(report.fault == Fault::guard_silent);
    ::kill(guard.pid(), SIGCONT);
    CHECK(soon([&] {
        guard.send(halfway(wires.rig));
        guard.poll(report);
        return report.fault == Fault::loop_silent && report.relaxed;
    }));
}

TEST_CASE("guard: an arm that follows a force sensor rests while that sensor says nothing") {
    for (const ArmImpedance impedance : {ArmImpedance::high, ArmImpedance::low}) {
        SimulatorProcess arm(PALPA_ARM_SIMULATOR, {}), sensor(PALPA_NETFT_SIMULATOR, {});
        ShapeRig rig;
        rig.arm = ArmDevice{};
        rig.arm->port = std::stoi(arm.port());
        rig.arm->impedance = impedance;
        rig.arm->sensor = NetFtOptions{};
        rig.arm->sensor->host = "127.0.0.1";
        rig.arm->sensor->port = std::stoi(sensor.port());
        ShapeGuard guard(rig, PALPA_GUARD);
        REQUIRE(soon([&] { return guard.poll(), guard.newest().ready; }));
        const bool follows = impedance == ArmImpedance::high;
        const Fault expected = follows ? Fault::silence : Fault::none;
        const auto stays_until = [&](const std::function<bool()>& done) {
            return soon([&] {
                guard.send({0.5, 0.0, 0.0, static_cast<double>(ArmMode::force)}, {});
                guard.poll();
                return done();
            });
        };
        ::kill(sensor.pid(), SIGSTOP);
        CHECK(stays_until([&] { return guard.newest().arm.has_sensor < 0.5 && guard.newest().fault == expected; }));
        ::kill(sensor.pid(), SIGCONT);
        CHECK(stays_until([&] { return guard.newest().arm.has_sensor > 0.5 && guard.newest().fault == Fault::none; }));
    }
}

TEST_CASE("guard: SIGKILL of the program that drives pins brings them to rest") {
    ShapeWires wires;
    const pid_t program = ::fork();
    REQUIRE(program >= 0);
    if (program == 0) {
        ShapeGuard guard(wires.rig(), PALPA_GUARD);
        for (;;) press_until(guard, [](const ShapeReport&) { return false; });
    }
    CHECK(soon([&] { return wires.highest_mm() > 1.4; }));
    ::kill(program, SIGKILL);
    ::waitpid(program, nullptr, 0);
    CHECK(soon([&] { return wires.highest_mm() < 0.05; }));
}
