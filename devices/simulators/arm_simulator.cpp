// Simulates a force arm on loopback UDP (devices/arm_link.h), the hand that holds it (PRESS.tsv) and the force sensor
// between them, which speaks RDT on a port of its own. Prints "port N" and "sensor N" first, and at its end what it sent.
// The arm is parked, and the hand keeps off, until the first command that is more than rest.

#include <CLI/CLI.hpp>
#include <optional>
#include <poll.h>

#include "devices/simulators/arm_plant.h"
#include "devices/simulators/sockets.h"
#include "devices/simulators/stream.h"
#include "platform/real_time.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::devices::simulators;

namespace {

struct ArmSimulator {
    ArmPlant plant;
    int link = -1;
    int sensor = -1;
    std::optional<sockaddr_in> sensor_owner;
    RdtRecord record;
    double counts_per_N = 1e6;
    double began_s = 0.0;
    double sensor_due_s = 0.0;
    std::FILE* truth = nullptr;
};

void send_to(int fd, const sockaddr_in& to, std::span<const std::uint8_t> bytes) {
    ::sendto(fd, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

// Answers each command at once.
template <class Answer>
void take_commands(ArmSimulator& sim, const Answer& give) {
    std::uint8_t bytes[256];
    sockaddr_in from{};
    socklen_t size = sizeof from;
    while (true) {
        const ssize_t n = ::recvfrom(sim.link, bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size);
        if (n < 0) return;
        const auto reply = answer(std::span(bytes, static_cast<std::size_t>(n)), sim.plant);
        if (reply) give(*reply, from);
    }
}

void take_requests(ArmSimulator& sim) {
    std::uint8_t bytes[64];
    sockaddr_in from{};
    socklen_t size = sizeof from;
    while (true) {
        const ssize_t n = ::recvfrom(sim.sensor, bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size);
        if (n < 0) return;
        RdtCommand what{};
        std::uint32_t records = 0;
        if (!decode_rdt_request(bytes, static_cast<std::size_t>(n), what, records)) continue;
        if (what == RdtCommand::stream) sim.sensor_owner = from;
        if (what == RdtCommand::stop) sim.sensor_owner.reset();
    }
}

void send_sensor(double now_s, ArmSimulator& sim) {
    constexpr double kPeriod_s = 1e-3;
    for (; sim.sensor_due_s <= now_s; sim.sensor_due_s += kPeriod_s) {
        ++sim.record.rdt_sequence;
        ++sim.record.ft_sequence;
        const double force_N = sensor_N(sim.plant);
        if (sim.truth != nullptr)
            std::fprintf(sim.truth, "%.6f\t%.6f\t%.6f\t%.6f\n", sim.sensor_due_s, 1e3 * sim.plant.depth_m,
                         sim.plant.hand_N, sim.plant.motor_N);
        if (!sim.sensor_owner) continue;
        sim.record.counts[2] = static_cast<std::int32_t>(std::lround(-sim.counts_per_N * force_N));
        send_to(sim.sensor, *sim.sensor_owner, encode_rdt_record(sim.record));
    }
}

}  // namespace

int main(int argc, char** argv) {
    StreamOptions options;
    std::string press, truth;
    int port = 0, sensor_port = 0;
    std::uint32_t first = 1;
    ArmSimulator sim;
    CLI::App app("A simulated force arm with hand and force sensor on loopback UDP");
    app.add_option("--press", press,
                   "PRESS.tsv that the hand follows; without it there is no hand, and the arm's brake holds");
    app.add_option("--seed", options.seed, "of the arm's parameters, each within 20 %; 0: none of them is changed");
    app.add_option("--port", port, "0: any that is free")->check(CLI::Range(0, 65535));
    app.add_option("--sensor-port", sensor_port, "0: any that is free")->check(CLI::Range(0, 65535));
    app.add_option("--counts-per-N", sim.counts_per_N)->check(CLI::Range(1e-6, 1e12))->capture_default_str();
    app.add_option("--first-sequence", first, "to see it wrap around");
    app.add_option("--lose", options.lose, "share of the answers")->check(CLI::Range(0.0, 1.0));
    app.add_option("--duplicate", options.duplicate)->check(CLI::Range(0.0, 1.0));
    app.add_option("--reorder", options.reorder, "swapped with the next")->check(CLI::Range(0.0, 1.0));
    app.add_option("--silent-from-s", options.silent_from_s,
                   "after the first command that is more than rest, the link is cut");
    app.add_option("--silent-s", options.silent_s, "for so long");
    app.add_option("--truth", truth, "table of time (steady clock), depth, hand's and motor's force, once per ms");
    CLI11_PARSE(app, argc, argv);
    try {
        sim.plant = make_arm_plant(arm_parameters(options.seed),
                                   press.empty() ? std::vector<PressRow>() : read_press(press), options.seed);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "arm_simulator: %s\n", error.what());
        return 2;
    }
    sim.plant.sent = first - 1;
    sim.link = open_socket(port);
    sim.sensor = open_socket(sensor_port);
    if (!truth.empty()) sim.truth = std::fopen(truth.c_str(), "w");
    if (sim.link < 0 || sim.sensor < 0 || (!truth.empty() && sim.truth == nullptr)) {
        std::perror("arm_simulator");
        return 1;
    }
    if (sim.truth != nullptr) std::fprintf(sim.truth, "t_host_s\tdepth_mm\thand_N\tmotor_N\n");
    listen_to_signals();  // before the line of its port: who has read that may end it
    std::printf("port %d\nsensor %d\n", port, sensor_port);
    std::fflush(stdout);
    platform::set_real_time(true);

    struct Reply {
        std::array<std::uint8_t, kArmFeedback_bytes> bytes;
        sockaddr_in to;
    };
    Line<Reply> line(options);
    sim.began_s = sim.sensor_due_s = steady_s();
    while (ended == 0) {
        pollfd waiting[2]{{sim.link, POLLIN, 0}, {sim.sensor, POLLIN, 0}};
        timespec most{0, 1000000};
        ::ppoll(waiting, 2, &most, nullptr);
        const double now_s = steady_s();
        advance(now_s - sim.began_s - sim.plant.time_s, sim.plant);
        const bool cut =
            silent(options, sim.plant.hand_began_s < 0.0 ? 0.0 : sim.plant.time_s - sim.plant.hand_began_s);
        take_commands(sim, [&](const auto& bytes, const sockaddr_in& from) {
            if (!cut) line.pass({bytes, from}, [&](const Reply& reply) { send_to(sim.link, reply.to, reply.bytes); });
        });
        take_requests(sim);
        send_sensor(now_s, sim);
    }
    print_sent(line.sent);
    if (sim.truth == nullptr) return 0;
    const bool failed = std::ferror(sim.truth) != 0;
    if (std::fclose(sim.truth) == 0 && !failed) return 0;
    std::fprintf(stderr, "arm_simulator: %s could not be written to its end\n", truth.c_str());
    return 1;
}
