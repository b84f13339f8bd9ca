#pragma once
// What accuracy costs in time: the measured error and cost of every choice that a library offers.

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "files/json.h"

namespace palpa::accuracy {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// One choice. NaN ("n/a"): not known.
struct AccuracyRow {
    std::string group{};   // the alternatives it belongs to
    std::string series{};  // its line in the plot
    std::string choice{};
    int nodes = 0;
    int dofs = 0;                     // degrees of freedom: equations that are solved
    double error_percent = kUnknown;  // signed if it is a single number, else root mean square over steps
    double worst_error_percent = kUnknown;
    std::string reference{};                    // what the error is measured against
    double reference_error_percent = kUnknown;  // uncertainty of the reference
    double offline_s = kUnknown;                // preparation before the first step: least of the repetitions
    int offline_repetitions = 0;
    double per_step_us = kUnknown;  // median
    double per_step_p99_us = kUnknown;
    int steps = 0;                // number of steps that were timed
    double memory_MB = kUnknown;  // that is kept between steps
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
    double offline_s = 1.0;  // budget for repetitions of the preparation; at least one, at most 20
    double steps_s = 1.0;    // budget for steps; at least the few that a percentile needs
};

// One measurement of the list; `expected_s` is only used for the progress and the time left.
struct Measurement {
    std::string what;
    double expected_s = 1.0;
    std::function<void(std::vector<AccuracyRow>& rows)> run;
};

// Runs all measurements. One that throws leaves a row that says why. Progress is shown on stderr if it is a terminal.
std::vector<AccuracyRow> run_measurements(const std::vector<Measurement>& list);

std::string accuracy_csv(const std::vector<AccuracyRow>& rows);
std::string accuracy_table(const std::vector<AccuracyRow>& rows);

// Processor, threads, load and date, without which a time has no meaning.
struct Machine {
    std::string processor;
    unsigned threads = 0;
    double load = kUnknown;  // mean over the last minute
    std::string date;
};
Machine this_machine();

files::Json accuracy_json(const std::vector<AccuracyRow>& rows, const Machine& machine);

// Writes NAME.gp beside NAME.csv in `folder`, which begins by setting `machine`, and runs gnuplot on it: NAME.png, .svg, .pdf.
// Returns in words what went wrong; empty on success. Throws std::runtime_error if the script cannot be written.
std::string plot_list(const std::filesystem::path& folder, const std::string& name, const std::string& script,
                      const Machine& machine);

// Writes mechanics.gp beside mechanics.csv in `folder` and runs gnuplot on it: mechanics.png, .svg, .pdf. Returns in
// words what went wrong; empty on success. Throws std::runtime_error if mechanics.gp cannot be written.
std::string plot_mechanics(const std::filesystem::path& folder, const Machine& machine);

}  // namespace palpa::accuracy
