#pragma once
// Many simulated studies, for their power: in threads, resumable, and in parts on a cluster.
//
//     DIR/power_run.json            what is simulated; all parts and later calls must agree with it
//     DIR/runs/run-00001-<12>.tsv   the findings of one study, for each effect, noise and number of participants; <12> are the
//                                   first digits of the hash of power_run.json
//
// Study r has the seed derived_seed(seed, kStudies, r), so any process makes the same one.

#include <filesystem>
#include <string>
#include <vector>

#include "app/study/power_studies.h"

namespace palpa::app {

struct PowerOptions {
    std::vector<int> participants;
    std::vector<double> effects{0.0, 1.0};
    std::vector<double> noises{1.0};
    std::string reference;  // id of a condition; empty: reference_of() chooses
    int runs = 100;
    int jobs = 1;  // threads
    int part = 1, parts = 1;
    bool merge = false;
    std::uint64_t seed = 1;
    double rate_Hz = 60.0;
    double alpha = 0.05;
    study::ReportOptions report;
    std::filesystem::path output;  // empty: nothing is kept
    bool quiet = false;            // no progress on standard error
};

struct PowerOutcome {
    int computed = 0;       // studies by this call
    int already_there = 0;  // by earlier calls
    bool complete = false;  // all studies are there, and summarised
    std::string reference;  // id of the condition
    std::vector<study::PowerResult> results;
};

// Throws InputError for a folder of another power run, for a piece of one, and for `merge` while studies are missing.
PowerOutcome measure_power(const study::Protocol& protocol, const PowerOptions& options);

// The parameters of the simulated people, in words, for reports.
std::string simulated_people_text();

}  // namespace palpa::app
