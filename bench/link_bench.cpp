// A command to the simulated arm and its feedback back over loopback, once per millisecond, against the same bytes that a
// thread of this process sends back without looking at them; the guard and the packets by themselves. Median, 99th
// percentile and worst; `ratio` of the medians.

#include <array>
#include <atomic>
#include <benchmark/benchmark.h>
#include <chrono>
#include <thread>

#include "accuracy/timing.h"
#include "devices/arm_link.h"
#include "devices/limits.h"
#include "devices/simulators/process.h"
#include "devices/simulators/sockets.h"
#include "platform/real_time.h"
#include "platform/udp_port.h"

namespace {

using namespace palpa::devices;

constexpr int kRounds = 5000;
double echo_median_us = 0.0;

void pace(std::chrono::steady_clock::time_point& due) {
    due += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(due);
}

void report(benchmark::State& bench, const TimeHistogram& times) {
    bench.counters["p50_us"] = 1e6 * times.quantile_s(0.5);
    bench.counters["p99_us"] = 1e6 * times.quantile_s(0.99);
    bench.counters["worst_us"] = 1e6 * times.worst_s;
}

// Sends datagrams of a feedback's size back to where they came from.
class Echo {
  public:
    Echo() : fd_(simulators::open_socket(port_)), thread_([this] { run(); }) {}
    ~Echo() {
        done_ = true;
        thread_.join();
        ::close(fd_);
    }
    int port() const { return port_; }

  private:
    void run() {
        palpa::platform::set_real_time(true);
        std::array<std::uint8_t, 256> bytes{};
        while (!done_) {
            timeval most{0, 100000};
            fd_set waiting;
            FD_ZERO(&waiting);
            FD_SET(fd_, &waiting);
            if (::select(fd_ + 1, &waiting, nullptr, nullptr, &most) <= 0) continue;
            sockaddr_in from{};
            socklen_t size = sizeof from;
            if (::recvfrom(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size) <= 0)
                continue;
            ::sendto(fd_, bytes.data(), kArmFeedback_bytes, 0, reinterpret_cast<const sockaddr*>(&from), size);
        }
    }

    int port_ = 0;
    int fd_;
    std::atomic<bool> done_{false};
    std::thread thread_;
};

void bare_echo(benchmark::State& bench) {
    Echo echo;
    palpa::platform::UdpPort port("127.0.0.1", echo.port());
    TimeHistogram times;
    auto due = std::chrono::steady_clock::now();
    for (auto _ : bench) {
        std::array<std::uint8_t, 256> bytes{};
        const double sent_s = steady_s();
        port.send(bytes.data(), kArmCommand_bytes);
        pace(due);
        double arrival_s = 0.0;
        if (port.receive_at_once(bytes.data(), bytes.size(), arrival_s) > 0) times.add(arrival_s - sent_s);
    }
    report(bench, times);
    echo_median_us = 1e6 * times.quantile_s(0.5);
}
BENCHMARK(bare_echo)->Iterations(kRounds);

void arm_round_trip(benchmark::State& bench) {
    simulators::SimulatorProcess simulator(PALPA_ARM_SIMULATOR, {"--seed", "1"});
    ArmLink link("127.0.0.1", std::stoi(simulator.port()));
    ArmFeedback feedback;
    auto due = std::chrono::steady_clock::now();
    for (auto _ : bench) {
        link.send({0.5, 0.0, 0.0, static_cast<double>(ArmMode::force)});
        pace(due);
        link.read(feedback);
    }
    const LinkHealth& health = link.health();
    report(bench, health.round_trip);
    bench.counters["lost"] = static_cast<double>(health.feedback.lost);
    if (echo_median_us > 0.0) bench.counters["ratio"] = 1e6 * health.round_trip.quantile_s(0.5) / echo_median_us;
}
BENCHMARK(arm_round_trip)->Iterations(kRounds);

template <class Step>
void single_steps(benchmark::State& bench, Step&& step) {
    constexpr int kSteps = 100000;
    int k = 0;
    for (auto _ : bench) step(k++);
    const palpa::accuracy::Timing single = palpa::accuracy::time_calls(kSteps, kSteps, 1e9, step);
    bench.counters["p50_us"] = palpa::accuracy::quantile_us(single, 0.5);
    bench.counters["p99_us"] = palpa::accuracy::quantile_us(single, 0.99);
    bench.counters["worst_us"] = palpa::accuracy::quantile_us(single, 1.0);
}

void packets(benchmark::State& bench) {
    ArmFeedbackPacket packet;
    single_steps(bench, [&](int k) {
        packet.sequence = static_cast<std::uint32_t>(k);
        const auto bytes = encode(packet);
        benchmark::DoNotOptimize(decode(bytes, packet));
    });
}
BENCHMARK(packets);

void guard_of_36_pins(benchmark::State& bench) {
    const Limits limits;
    Guard guard;
    std::array<double, 36> heights_m{};
    single_steps(bench, [&](int k) {
        ArmFeedback in;
        begin_tick(limits, 1e-3 * k, true, &in, guard);
        ArmCommand command{1.0, 0.5, 0.0, static_cast<double>(ArmMode::force)};
        guard_arm(limits, command, guard);
        heights_m.fill(1e-3);
        guard_pins(limits, heights_m, guard);
        benchmark::DoNotOptimize(heights_m);
    });
}
BENCHMARK(guard_of_36_pins);

}  // namespace

BENCHMARK_MAIN();
