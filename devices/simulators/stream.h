#pragma once
// What the simulated sensors have in common: a hand that presses again and again, and a line that is not perfect.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <deque>
#include <numbers>
#include <random>
#include <thread>

#include "devices/force_sensor.h"

namespace palpa::devices::simulators {

struct StreamOptions {
    double rate_Hz = 80.0;
    double seconds = 0.0;     // 0: until it is ended
    double greatest_N = 3.0;  // of each press
    double period_s = 4.0;    // from one press to the next
    int steps = 0;            // a staircase of so many still moments; 0: one wave
    double noise_N = 0.0;
    double lag_s = 0.0;  // of the sensor behind the hand
    double lose = 0.0;   // share of the records
    double duplicate = 0.0;
    double reorder = 0.0;        // swapped with the next
    double silent_from_s = 1e9;  // unplugged then, or at SIGUSR1, and plugged in again
    double silent_s = 0.0;
    std::uint64_t seed = 1;
};

inline void add_stream_options(CLI::App& app, StreamOptions& options) {
    app.add_option("--rate-Hz", options.rate_Hz)->check(CLI::Range(0.1, 1e5))->capture_default_str();
    app.add_option("--seconds", options.seconds, "0: until it is ended")->capture_default_str();
    app.add_option("--greatest-N", options.greatest_N, "of each press")->capture_default_str();
    app.add_option("--period-s", options.period_s, "from one press to the next")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    app.add_option("--steps", options.steps, "a staircase of so many still moments up; 0: one wave")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    app.add_option("--noise-N", options.noise_N)->capture_default_str();
    app.add_option("--lag-s", options.lag_s, "of the sensor behind the hand")->capture_default_str();
    app.add_option("--lose", options.lose, "share of the records")->check(CLI::Range(0.0, 1.0))->capture_default_str();
    app.add_option("--duplicate", options.duplicate)->check(CLI::Range(0.0, 1.0))->capture_default_str();
    app.add_option("--reorder", options.reorder, "swapped with the next")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--silent-from-s", options.silent_from_s, "unplugged then, or at SIGUSR1");
    app.add_option("--silent-s", options.silent_s, "for so long");
    app.add_option("--seed", options.seed)->capture_default_str();
}

// The hand. It presses in step with the steady clock's multiples of the period, so that programs that know nothing of
// each other follow the same hand: a raised cosine, or a staircase from 0.055 N up by equal factors and a lift at the end.
inline double hand_N(const StreamOptions& options, double steady_now_s) {
    const double share = steady_now_s / options.period_s - std::floor(steady_now_s / options.period_s);
    if (options.steps == 0) return options.greatest_N * (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * share));
    constexpr double kPressed = 0.85;
    if (share >= kPressed) return 0.0;
    const double step = std::floor(share / kPressed * options.steps);
    constexpr double kFirst_N = 0.055;
    return kFirst_N * std::pow(options.greatest_N / kFirst_N, step / std::max(options.steps - 1, 1));
}

struct Sent {
    std::int64_t records = 0;  // that the sensor made
    std::int64_t lost = 0;
    std::int64_t duplicate = 0;
    std::int64_t reordered = 0;
};

// Passes records on with the line's faults. Reordered ones are held back until the next has gone.
template <class Record>
struct Line {
    const StreamOptions& options;
    std::mt19937_64 random;
    Sent sent{};
    std::deque<Record> held{};
    explicit Line(const StreamOptions& o) : options(o), random(o.seed) {}

    template <class Send>
    void pass(const Record& record, const Send& send) {
        std::uniform_real_distribution<double> chance;
        ++sent.records;
        if (chance(random) < options.lose) {
            ++sent.lost;
            return;
        }
        if (held.empty() && chance(random) < options.reorder) {
            held.push_back(record);
            return;
        }
        send(record);
        if (chance(random) < options.duplicate) {
            ++sent.duplicate;
            send(record);
        }
        if (held.empty()) return;
        send(held.front());
        held.pop_front();
        ++sent.reordered;
    }
    double noise_N() {
        return options.noise_N > 0.0 ? std::normal_distribution<double>(0.0, options.noise_N)(random) : 0.0;
    }
};

inline volatile std::sig_atomic_t ended = 0, unplug_asked = 0;

// SIGTERM and SIGINT end a simulator, SIGUSR1 unplugs it.
inline void listen_to_signals() {
    std::signal(SIGTERM, [](int) { ended = 1; });
    std::signal(SIGINT, [](int) { ended = 1; });
    std::signal(SIGUSR1, [](int) { unplug_asked = 1; });
}

inline bool silent(StreamOptions& options, double since_start_s) {
    if (unplug_asked != 0) options.silent_from_s = since_start_s;
    unplug_asked = 0;
    return options.silent_s > 0.0 && since_start_s >= options.silent_from_s &&
           since_start_s < options.silent_from_s + options.silent_s;
}

inline void print_sent(const Sent& sent) {
    std::printf("sent %lld lost %lld duplicate %lld reordered %lld\n", static_cast<long long>(sent.records),
                static_cast<long long>(sent.lost), static_cast<long long>(sent.duplicate),
                static_cast<long long>(sent.reordered));
    std::fflush(stdout);
}

}  // namespace palpa::devices::simulators
