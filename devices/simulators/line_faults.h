#pragma once
// What a bad line does to the bytes that pass over it.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace palpa::devices::simulators {

struct LineFaults {  // shares of the bytes
    double lose = 0.0;
    double twice = 0.0;
    double garble = 0.0;
};

inline void add_line_options(CLI::App& app, LineFaults& faults) {
    const auto share = CLI::Range(0.0, 1.0);
    app.add_option("--lose", faults.lose, "share of the bytes")->check(share);
    app.add_option("--double", faults.twice)->check(share);
    app.add_option("--garble", faults.garble)->check(share);
}

inline std::vector<std::uint8_t> through(const LineFaults& faults, std::span<const std::uint8_t> bytes,
                                         std::mt19937_64& random) {
    std::uniform_real_distribution<double> chance;
    std::vector<std::uint8_t> out;
    for (std::uint8_t byte : bytes) {
        if (chance(random) < faults.lose) continue;
        if (chance(random) < faults.garble) byte = static_cast<std::uint8_t>(random());
        out.push_back(byte);
        if (chance(random) < faults.twice) out.push_back(byte);
    }
    return out;
}

}  // namespace palpa::devices::simulators
