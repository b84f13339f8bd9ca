#pragma once
// A study with simulated participants: each trial runs through the same loop and the same logs as a person's.

#include <cstdint>
#include <filesystem>

#include "app/study/study_scenes.h"
#include "study/protocol.h"

namespace palpa::app {

struct SimulateOptions {
    int participants = 1;
    std::uint64_t seed = 1;
    std::filesystem::path output;
    bool samples = true;    // false: events, marks and settings only
    bool practice = false;  // nobody learns in a simulation
    int jobs = 1;           // participants at a time
    double rate_Hz = 60.0;  // of the pen
};

struct SimulateResult {
    int trials = 0;         // run now
    int already_there = 0;  // finished by an earlier call
    int left_out = 0;       // conditions by hand or on devices that nobody simulates
    std::int64_t samples = 0;
    double wall_s = 0.0;
    double written_MB = 0.0;  // of samples
};

// Goes on where an earlier call of the same protocol and seed was interrupted. Throws InputError, or
// std::runtime_error when a trial cannot be written: the study stops there, and its finished trials are on the disk.
SimulateResult simulate_study(const study::Protocol& protocol, const SimulateOptions& options);

}  // namespace palpa::app
