#pragma once
// What accuracy costs in time: measured pairs of error and cost for every choice that a library offers.

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "files/json.h"

namespace palpa::accuracy {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// One choice. What is not known is NaN ("n/a").
struct AccuracyRow {
    std::string group{};   // what is chosen between
    std::string series{};  // the line of the plot it belongs to
    std::string choice{};
    int nodes = 0;
    int dofs = 0;                     // equations that are solved
    double error_percent = kUnknown;  // signed where it is one number, else root mean square over steps
    double worst_error_percent = kUnknown;
    std::string reference{};                    // what the error is measured against
    double reference_error_percent = kUnknown;  // how uncertain that is
    double offline_s = kUnknown;                // before the first step: least of the repetitions
    int offline_repetitions = 0;
    double per_step_us = kUnknown;  // median
    double per_step_p99_us = kUnknown;
    int steps = 0;                // that were timed
    double memory_MB = kUnknown;  // kept between steps
    std::string note{};
};

template <class Visit>
void visit_fields(const AccuracyRow& row, Visit&& visit) {
    visit("group", row.group);
    visit("series", row.series);
    visit("choice", row.choice);
    visit("nodes", row.nodes);
    visit("dofs", row.dofs);
    visit("error_percent", row.error_percent);
    visit("worst_error_percent", row.worst_error_percent);
    visit("reference", row.reference);
    visit("reference_error_percent", row.reference_error_percent);
    visit("offline_s", row.offline_s);
    visit("offline_repetitions", row.offline_repetitions);
    visit("per_step_us", row.per_step_us);
    visit("per_step_p99_us", row.per_step_p99_us);
    visit("steps", row.steps);
    visit("memory_MB", row.memory_MB);
    visit("note", row.note);
}

// How long to measure.
struct Effort {
    bool quick = false;      // small meshes only
    double offline_s = 1.0;  // repetitions of the offline part stop here; at least one, at most 20
    double steps_s = 1.0;    // steps stop here; at least the few that a percentile needs
};

// One measurement of the list; `expected_s` only shares out the progress bar.
struct Measurement {
    std::string what;
    double expected_s = 1.0;
    std::function<void(std::vector<AccuracyRow>& rows)> run;
};

// A measurement that throws leaves a row that says why. Progress goes to a terminal on stderr, if it is one.
std::vector<AccuracyRow> run_measurements(const std::vector<Measurement>& list);

std::string accuracy_csv(const std::vector<AccuracyRow>& rows);
std::string accuracy_table(const std::vector<AccuracyRow>& rows);

// Processor, threads, load and date: without them a time says nothing.
struct Machine {
    std::string processor;
    unsigned threads = 0;
    double load = kUnknown;  // mean of the last minute
    std::string date;
};
Machine this_machine();

files::Json accuracy_json(const std::vector<AccuracyRow>& rows, const Machine& machine);

// Writes mechanics.gp beside mechanics.csv in `folder` and runs gnuplot on it: mechanics.png, .svg, .pdf.
// Returns what went wrong, in words; empty when the figures are there.
std::string plot_mechanics(const std::filesystem::path& folder, const Machine& machine);

}  // namespace palpa::accuracy
