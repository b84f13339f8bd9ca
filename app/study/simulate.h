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
    bool practice = false;  // runs practice trials too; nobody learns in a simulation
    int jobs = 1;           // participants simulated at the same time
    double rate_Hz = 60.0;  // of the pen
};

struct SimulateResult {
    int trials = 0;         // run by this call
    int already_there = 0;  // finished by an earlier call
    int left_out = 0;       // tests by hand or on devices that are not simulated
    std::int64_t samples = 0;
    double wall_s = 0.0;
    double written_MB = 0.0;  // of sample logs
};

// Simulates a study, or continues where an earlier call with the same protocol and seed was interrupted. Throws
// InputError, and std::runtime_error if a trial cannot be written: the study stops there, and its finished trials are
// on the disk.
SimulateResult simulate_study(const study::Protocol& protocol, const SimulateOptions& options);

}  // namespace palpa::app
